// The frames of a run: unpacking, and where everything is between two of them. Pure functions.

export interface PlaybackBody {
  name: string;
  kind: 'dynamic' | 'fixed' | 'kinematic';
  position: number[];
  /** w, x, y, z */
  orientation: number[];
}

export interface PlaybackShape {
  name: string;
  body: number;
  kind: string;
  sizes: number[];
  surface: number | null;
  /** In the body's frame. */
  position: number[];
  orientation: number[];
}

export interface PlaybackSurface {
  vertices: number[];
  triangles: number[];
}

/** Anchors in the frames of their bodies. */
export interface PlaybackJoint {
  name: string;
  kind: string;
  body_a: number;
  body_b: number;
  anchor_a: number[];
  anchor_b: number[];
}

/** As report.json packs it: docs/report-schema.md. */
export interface PackedTrack {
  engine: string;
  time: number[];
  poses: { middle: number[]; step: number[]; data: string };
  contacts: {
    count: number[]; count_whole: number[]; point_middle: number[]; point_step: number[];
    force_step: number; bodies: string; data: string;
  };
}

export interface Playback {
  gravity: number[];
  bodies: PlaybackBody[];
  shapes: PlaybackShape[];
  joints?: PlaybackJoint[];
  surfaces: PlaybackSurface[];
  tracks: PackedTrack[];
}

const kPose = 7;
const kContact = 6;

/** One run, unpacked. */
export interface Track {
  engine: string;
  time: readonly number[];
  /** How many bodies can move: those that are not fixed. */
  bodies: number;
  /** frames x bodies x 7: x, y, z, then the quaternion w, x, y, z */
  poses: Float32Array;
  /** Where the contacts of a frame begin; one more than there are frames. */
  firstContact: readonly number[];
  /** How many contacts the engine had in each frame; at least as many as are drawn. */
  found: readonly number[];
  /** contacts x 6: point, and the force on the body that it is shown for */
  contacts: Float32Array;
}

/** Whose pose is in the tracks: the number of each body there, -1 if it is fixed. */
export function movingNumbers(bodies: readonly PlaybackBody[]): number[] {
  let next = 0;
  return bodies.map((body) => (body.kind === 'fixed' ? -1 : next++));
}

function integers(base64: string): DataView {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new DataView(bytes.buffer);
}

function expectLength(what: string, view: DataView, count: number): void {
  if (view.byteLength !== 2 * count) {
    throw new Error(`${what}: ${view.byteLength} bytes, expected ${2 * count}`);
  }
}

function unpackedPoses({ middle, step, data }: PackedTrack['poses'], frames: number, bodies: number): Float32Array {
  const view = integers(data);
  expectLength('poses', view, frames * bodies * kPose);
  const poses = new Float32Array(frames * bodies * kPose);
  for (let at = 0; at < poses.length; ++at) {
    const part = at % kPose;
    const value = view.getInt16(2 * at, true);
    const axis = 3 * (Math.floor(at / kPose) % bodies) + part;
    poses[at] = part < 3 ? (middle[axis] ?? 0) + (step[axis] ?? 0) * value : value / 32767;
  }
  return poses;
}

/**
 * Is the force shown on B, as -f? On the moving body of two; of two moving ones on the one that it
 * pushes up, so that arrows in a stack point one way.
 */
function isShownOnB(a: number, b: number, moving: readonly number[], upwards: number): boolean {
  const movesA = (moving[a] ?? -1) >= 0;
  const movesB = (moving[b] ?? -1) >= 0;
  return movesA && movesB ? upwards < 0 : !movesA && movesB;
}

function unpackedContacts(packed: PackedTrack['contacts'], count: number, playback: Playback): Float32Array {
  const view = integers(packed.data);
  expectLength('contacts', view, count * kContact);
  const pairs = integers(packed.bodies);
  expectLength("contacts' bodies", pairs, 2 * count);
  const moving = movingNumbers(playback.bodies);
  const contacts = new Float32Array(count * kContact);
  for (let contact = 0; contact < count; ++contact) {
    const at = contact * kContact;
    let upwards = 0;
    for (let axis = 0; axis < 3; ++axis) {
      contacts[at + axis] = (packed.point_middle[axis] ?? 0)
        + (packed.point_step[axis] ?? 0) * view.getInt16(2 * (at + axis), true);
      const force = packed.force_step * view.getInt16(2 * (at + 3 + axis), true);
      contacts[at + 3 + axis] = force;
      upwards -= force * (playback.gravity[axis] ?? 0);
    }
    const a = pairs.getUint16(4 * contact, true);
    const b = pairs.getUint16(4 * contact + 2, true);
    if (!isShownOnB(a, b, moving, upwards)) continue;
    for (let axis = 3; axis < 6; ++axis) contacts[at + axis] = -(contacts[at + axis] ?? 0);
  }
  return contacts;
}

/** @throws Error if the packed numbers are not as many as frames, bodies and contacts ask for. */
export function unpack(track: PackedTrack, playback: Playback): Track {
  const frames = track.time.length;
  const bodies = playback.bodies.filter((body) => body.kind !== 'fixed').length;
  const firstContact = [0];
  for (let k = 0; k < frames; ++k) firstContact.push((firstContact[k] ?? 0) + (track.contacts.count[k] ?? 0));
  return {
    engine: track.engine, time: track.time, bodies,
    poses: unpackedPoses(track.poses, frames, bodies), firstContact,
    found: track.contacts.count_whole,
    contacts: unpackedContacts(track.contacts, firstContact[frames] ?? 0, playback),
  };
}

/** The first frame at or after a time; the last one beyond the end. O(log frames). */
export function frameAtOrAfter(time: readonly number[], t: number): number {
  let low = 0;
  let high = time.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((time[middle] ?? 0) >= t) high = middle;
    else low = middle + 1;
  }
  return Math.max(0, low);
}

/** The frame nearest to a time. */
export function nearestFrame(time: readonly number[], t: number): number {
  const after = frameAtOrAfter(time, t);
  const before = Math.max(0, after - 1);
  return t - (time[before] ?? 0) < (time[after] ?? 0) - t ? before : after;
}

/**
 * Poses of all bodies at a time, into `out` (bodies x 7): between two frames positions on the line,
 * turns on the shorter arc (normalised). Before the first and after the last frame those. Allocates
 * nothing.
 */
export function posesAt(track: Track, t: number, out: Float32Array): void {
  const size = track.bodies * kPose;
  const after = frameAtOrAfter(track.time, t);
  const before = Math.max(0, after - 1);
  const t0 = track.time[before] ?? 0;
  const t1 = track.time[after] ?? 0;
  const part = t1 > t0 ? Math.min(1, Math.max(0, (t - t0) / (t1 - t0))) : 1;
  const { poses } = track;
  for (let body = 0; body < track.bodies; ++body) {
    const a = before * size + body * kPose;
    const b = after * size + body * kPose;
    const o = body * kPose;
    let cosine = 0;
    for (let i = 3; i < kPose; ++i) cosine += (poses[a + i] ?? 0) * (poses[b + i] ?? 0);
    const sign = cosine < 0 ? -1 : 1;
    let norm = 0;
    for (let i = 0; i < kPose; ++i) {
      const from = (i < 3 ? 1 : sign) * (poses[a + i] ?? 0);
      const value = from + part * ((poses[b + i] ?? 0) - from);
      out[o + i] = value;
      if (i >= 3) norm += value * value;
    }
    const scale = norm > 0 ? 1 / Math.sqrt(norm) : 1;
    for (let i = 3; i < kPose; ++i) out[o + i] = (out[o + i] ?? 0) * scale;
  }
}

/** First and past-the-last contact of what acted up to a time, since the frame before. */
export function contactsAt(track: Track, t: number): [number, number] {
  const frame = frameAtOrAfter(track.time, t);
  return [track.firstContact[frame] ?? 0, track.firstContact[frame + 1] ?? 0];
}

/** The force that most contacts stay below: of the forces above 0 the 90 % quantile, N; 0 for none. */
export function typicalForce(tracks: readonly Track[]): number {
  const sizes: number[] = [];
  for (const { contacts } of tracks) {
    for (let at = 0; at < contacts.length; at += kContact) {
      const size = Math.hypot(contacts[at + 3] ?? 0, contacts[at + 4] ?? 0, contacts[at + 5] ?? 0);
      if (size > 0) sizes.push(size);
    }
  }
  sizes.sort((a, b) => a - b);
  return sizes[Math.floor(0.9 * (sizes.length - 1))] ?? 0;
}

/** 1, 2 or 5 times a power of ten, at most the value (> 0). */
export function niceBelow(value: number): number {
  const decade = 10 ** Math.floor(Math.log10(value));
  const lead = value / decade;
  return decade * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
}

export interface Bounds {
  low: [number, number, number];
  high: [number, number, number];
}

/** A straight piece from a point of one body to a point of another, or of the same. */
export interface Rod {
  bodies: [number, number];
  points: [number[], number[]];
}

/** What shows the joints: from the centre of each body that moves to its anchor, and between the
 * anchors that are apart. */
export function rodsOf(playback: Playback): Rod[] {
  const rods: Rod[] = [];
  for (const joint of playback.joints ?? []) {
    for (const [body, anchor] of [[joint.body_a, joint.anchor_a], [joint.body_b, joint.anchor_b]] as const) {
      const holder = playback.bodies[body];
      if (holder !== undefined && holder.kind !== 'fixed' && Math.hypot(...anchor) > 0) {
        rods.push({ bodies: [body, body], points: [[0, 0, 0], anchor] });
      }
    }
    if (joint.kind === 'distance' || joint.kind === 'slider') {
      rods.push({ bodies: [joint.body_a, joint.body_b], points: [joint.anchor_a, joint.anchor_b] });
    }
  }
  return rods;
}

/** How far a shape reaches from its body's origin, or a bound of it; a half-space counts as nothing. */
export function reach(shape: PlaybackShape, surfaces: readonly PlaybackSurface[]): number {
  const offset = Math.hypot(...shape.position);
  const [a = 0, b = 0, c = 0] = shape.sizes;
  switch (shape.kind) {
    case 'sphere': return offset + a;
    case 'box': return offset + Math.hypot(a, b, c);
    case 'ellipsoid': return offset + Math.max(a, b, c);
    case 'capsule': return offset + a + b;
    case 'cylinder': case 'cone': return offset + Math.hypot(a, b);
    case 'hull': case 'mesh': {
      const v = surfaces[shape.surface ?? -1]?.vertices ?? [];
      let most = 0;
      for (let i = 0; i + 2 < v.length; i += 3) {
        most = Math.max(most, Math.hypot(v[i] ?? 0, v[i + 1] ?? 0, v[i + 2] ?? 0));
      }
      return offset + most;
    }
    default: return 0;
  }
}

/** The box around the moving bodies over a whole track; null if nothing moves. */
export function boundsOf(track: Track, playback: Playback): Bounds | null {
  if (track.bodies === 0 || track.poses.length === 0) return null;
  const moving = movingNumbers(playback.bodies);
  const reaches = new Float64Array(track.bodies);
  for (const shape of playback.shapes) {
    const body = moving[shape.body] ?? -1;
    if (body >= 0) reaches[body] = Math.max(reaches[body] ?? 0, reach(shape, playback.surfaces));
  }
  const bounds: Bounds = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
  for (let at = 0; at < track.poses.length; at += kPose) {
    const far = reaches[(at / kPose) % track.bodies] ?? 0;
    for (const axis of [0, 1, 2] as const) {
      const x = track.poses[at + axis] ?? 0;
      bounds.low[axis] = Math.min(bounds.low[axis], x - far);
      bounds.high[axis] = Math.max(bounds.high[axis], x + far);
    }
  }
  return bounds;
}
