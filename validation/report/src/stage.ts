// Both runs of a scene in 3D: one camera, one canvas cut into as many parts as there are runs.
// Bodies with the same geometry are drawn in one call (instances), so a thousand cost little.

import * as THREE from 'three';
import { kForceColour, stageColours } from './palette';
import {
  boundsOf, contactsAt, movingNumbers, niceBelow, posesAt, reach, rodsOf, typicalForce,
} from './playback';
import type { Playback, PlaybackShape, PlaybackSurface, Rod, Track } from './playback';

const kMany = 200;
const kFieldOfView = 32;
/** Each body's share of its engine's colour: neighbours are told apart. */
const kShades = [1, 0.72, 1.25, 0.5];
/** With more contacts than this in a frame dots and arrows become smaller. */
const kManyContacts = 40;
/** Between the two views, CSS pixels. */
const kGap = 6;

/** Alternating dark and light sectors, so that a turning round body is seen to turn. */
function sectored(geometry: THREE.BufferGeometry, acrossZ = true): THREE.BufferGeometry {
  const result = geometry.toNonIndexed();
  const points = result.getAttribute('position');
  const colours = new Float32Array(3 * points.count);
  for (let at = 0; at < points.count; at += 3) {
    const x = points.getX(at) + points.getX(at + 1) + points.getX(at + 2);
    const y = points.getY(at) + points.getY(at + 1) + points.getY(at + 2);
    const z = points.getZ(at) + points.getZ(at + 1) + points.getZ(at + 2);
    colours.fill(((x > 0) !== (y > 0)) !== (acrossZ && z > 0) ? 1 : 0.6, 3 * at, 3 * at + 9);
  }
  result.setAttribute('color', new THREE.BufferAttribute(colours, 3));
  return result;
}

function alongZ(geometry: THREE.BufferGeometry): THREE.BufferGeometry {
  return geometry.rotateX(Math.PI / 2);
}

function surfaceGeometry(surface: PlaybackSurface | undefined): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(surface?.vertices ?? [], 3));
  geometry.setIndex(surface?.triangles ?? []);
  const flat = geometry.toNonIndexed();
  flat.computeVertexNormals();
  const count = flat.getAttribute('position').count;
  flat.setAttribute('color', new THREE.BufferAttribute(new Float32Array(3 * count).fill(1), 3));
  return flat;
}

function boxGeometry(): THREE.BufferGeometry {
  const geometry = new THREE.BoxGeometry(2, 2, 2);
  geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(72).fill(1), 3));
  return geometry;
}

interface ScaledGeometry {
  key: string;
  scale: number[];
  make: () => THREE.BufferGeometry;
}

/** The geometry of a shape and the factors that scale it to its size; the key tells them apart. */
function geometryOf(shape: PlaybackShape, surfaces: readonly PlaybackSurface[], fine: boolean): ScaledGeometry {
  const [a = 1, b = 1, c = 1] = shape.sizes;
  const around = fine ? 32 : 14;
  switch (shape.kind) {
    case 'box': return { key: 'box', scale: [a, b, c], make: boxGeometry };
    case 'sphere': case 'ellipsoid':
      return { key: 'sphere', scale: shape.kind === 'sphere' ? [a, a, a] : [a, b, c],
        make: () => sectored(alongZ(new THREE.SphereGeometry(1, around, around / 2))) };
    case 'cylinder':
      return { key: 'cylinder', scale: [a, a, b],
        make: () => sectored(alongZ(new THREE.CylinderGeometry(1, 1, 2, around, 2))) };
    case 'cone':
      return { key: 'cone', scale: [a, a, b],
        make: () => sectored(alongZ(new THREE.ConeGeometry(1, 2, around, 4))) };
    case 'capsule':
      return { key: `capsule ${b / a}`, scale: [a, a, a],
        make: () => sectored(alongZ(new THREE.CapsuleGeometry(1, (2 * b) / a, around / 4, around)), false) };
    default:
      return { key: `surface ${shape.surface}`, scale: [1, 1, 1],
        make: () => surfaceGeometry(surfaces[shape.surface ?? -1]) };
  }
}

/** A white square with a dark frame: the edges of a box. */
function frameTexture(): THREE.Texture {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 128;
  const pen = canvas.getContext('2d');
  if (pen !== null) {
    pen.fillStyle = '#fff';
    pen.fillRect(0, 0, 128, 128);
    pen.strokeStyle = '#555';
    pen.lineWidth = 5;
    pen.strokeRect(0, 0, 128, 128);
  }
  const texture = new THREE.CanvasTexture(canvas);
  texture.anisotropy = 4;
  return texture;
}

interface Batch {
  mesh: THREE.InstancedMesh;
  bodies: number[];
  /** Pose in the body times scale. */
  locals: THREE.Matrix4[];
}

interface Placement {
  position: number[];
  orientation: number[];
}

function matrixOf({ position, orientation }: Placement, scale = [1, 1, 1]): THREE.Matrix4 {
  const [x = 0, y = 0, z = 0] = position;
  const [w = 1, i = 0, j = 0, k = 0] = orientation;
  const [sx = 1, sy = 1, sz = 1] = scale;
  return new THREE.Matrix4().compose(new THREE.Vector3(x, y, z),
    new THREE.Quaternion(i, j, k, w), new THREE.Vector3(sx, sy, sz));
}

function vector([x = 0, y = 0, z = 0]: readonly number[]): THREE.Vector3 {
  return new THREE.Vector3(x, y, z);
}

/** Of a body that does not move, in the world; else in the body. */
function shapeMatrix(playback: Playback, shape: PlaybackShape, scale = [1, 1, 1]): THREE.Matrix4 {
  const body = playback.bodies[shape.body];
  const local = matrixOf(shape, scale);
  return body?.kind === 'fixed' ? matrixOf(body).multiply(local) : local;
}

/** How large the scene is and where, by the first run: one that flies apart stays out of it. */
function framing(tracks: readonly Track[], playback: Playback): THREE.Sphere {
  const box = new THREE.Box3();
  const moving = tracks[0] === undefined ? null : boundsOf(tracks[0], playback);
  if (moving !== null) box.set(new THREE.Vector3(...moving.low), new THREE.Vector3(...moving.high));
  const extent = box.isEmpty() ? 0 : box.getSize(new THREE.Vector3()).length();
  const centre = new THREE.Vector3();
  for (const shape of playback.shapes) {
    if (playback.bodies[shape.body]?.kind !== 'fixed' || shape.kind === 'half_space') continue;
    const far = reach({ ...shape, position: [0, 0, 0] }, playback.surfaces);
    if (extent > 0 && far > 1.5 * extent) continue;
    centre.setFromMatrixPosition(shapeMatrix(playback, shape));
    box.expandByPoint(centre.clone().addScalar(far)).expandByPoint(centre.clone().addScalar(-far));
  }
  for (const { body_a, body_b, anchor_a, anchor_b } of playback.joints ?? []) {
    for (const [body, anchor] of [[body_a, anchor_a], [body_b, anchor_b]] as const) {
      const holder = playback.bodies[body];
      if (holder?.kind === 'fixed') box.expandByPoint(vector(anchor).applyMatrix4(matrixOf(holder)));
    }
  }
  const sphere = box.isEmpty() ? new THREE.Sphere(new THREE.Vector3(), 1) : box.getBoundingSphere(new THREE.Sphere());
  sphere.radius = Math.max(sphere.radius, 1e-6);
  return sphere;
}

function arrowGeometry(): THREE.BufferGeometry {
  // Along +z, 1 long; the head is the last quarter.
  const shaft = alongZ(new THREE.CylinderGeometry(0.3, 0.3, 0.75, 8)).translate(0, 0, 0.375).toNonIndexed();
  const head = alongZ(new THREE.ConeGeometry(1, 0.25, 12)).translate(0, 0, 0.875).toNonIndexed();
  const merged = new THREE.BufferGeometry();
  for (const name of ['position', 'normal']) {
    const parts = [shaft, head].map((part) => part.getAttribute(name).array as Float32Array);
    merged.setAttribute(name, new THREE.Float32BufferAttribute(parts.flatMap((part) => [...part]), 3));
  }
  return merged;
}

/** One run as a three.js scene. */
class Side {
  readonly scene = new THREE.Scene();
  private readonly batches: Batch[] = [];
  private readonly rods: Rod[];
  private readonly rodMesh: THREE.InstancedMesh;
  private readonly points: THREE.InstancedMesh;
  private readonly arrows: THREE.InstancedMesh;
  private readonly poses: Float32Array;
  private readonly matrices: THREE.Matrix4[];
  /** Of each body, its place in matrices, or -1: it stays where `still` says. */
  private readonly numbers: readonly number[];
  private readonly still: THREE.Matrix4[];
  /** What the sizes of dots and arrows are shares of, m. */
  private readonly markSize: number;
  private readonly disposables: { dispose(): void }[] = [];

  constructor(readonly track: Track, playback: Playback,
    private readonly size: number, centre: THREE.Vector3, private readonly longestForce: number, dark: boolean) {
    this.poses = new Float32Array(7 * track.bodies);
    this.matrices = Array.from({ length: track.bodies }, () => new THREE.Matrix4());
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xb4b4b4, 2.6));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(-2, -3, 5);
    this.scene.add(sun);
    const colours = stageColours(track.engine, dark);
    this.addBatches(playback, new THREE.Color(colours.moving), new THREE.Color(colours.fixed));
    this.rods = rodsOf(playback);
    this.numbers = movingNumbers(playback.bodies);
    this.still = playback.bodies.map((body) => matrixOf(body));
    this.rodMesh = this.instances(alongZ(new THREE.CylinderGeometry(1, 1, 1, 8)).translate(0, 0, 0.5),
      new THREE.MeshLambertMaterial({ color: colours.point }), this.rods.length);
    for (const shape of playback.shapes) {
      if (shape.kind === 'half_space') this.addPlane(shapeMatrix(playback, shape), centre, colours);
    }
    let most = 0;
    track.time.forEach((_, k) => {
      most = Math.max(most, (track.firstContact[k + 1] ?? 0) - (track.firstContact[k] ?? 0));
    });
    this.markSize = size * Math.min(1, (kManyContacts / Math.max(1, most)) ** (1 / 3));
    const over = { depthTest: false, transparent: true, opacity: 0.9 };
    this.points = this.instances(new THREE.SphereGeometry(1, 10, 8),
      new THREE.MeshBasicMaterial({ color: colours.point, ...over }), most);
    this.arrows = this.instances(arrowGeometry(),
      new THREE.MeshBasicMaterial({ color: kForceColour[dark ? 'dark' : 'light'], ...over }), most);
    this.arrows.renderOrder = 1;
    this.points.renderOrder = 2;
  }

  private instances(geometry: THREE.BufferGeometry, material: THREE.Material, count: number): THREE.InstancedMesh {
    const mesh = new THREE.InstancedMesh(geometry, material, Math.max(1, count));
    mesh.frustumCulled = false;
    mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
    this.scene.add(mesh);
    this.disposables.push(geometry, material, mesh);
    return mesh;
  }

  private addBatches(playback: Playback, moving: THREE.Color, fixed: THREE.Color): void {
    const fine = playback.shapes.length <= kMany;
    const batches = new Map<string, { shape: PlaybackShape; geometry: ScaledGeometry }[]>();
    for (const shape of playback.shapes) {
      if (shape.kind === 'half_space') continue;
      const geometry = geometryOf(shape, playback.surfaces, fine);
      const members = batches.get(geometry.key) ?? [];
      members.push({ shape, geometry });
      batches.set(geometry.key, members);
    }
    const frame = frameTexture();
    this.disposables.push(frame);
    const numbers = movingNumbers(playback.bodies);
    for (const [key, members] of batches) {
      const material = new THREE.MeshLambertMaterial({
        vertexColors: true, side: key.startsWith('surface') ? THREE.DoubleSide : THREE.FrontSide,
        map: key === 'box' ? frame : null,
      });
      const mesh = this.instances((members[0] as { geometry: ScaledGeometry }).geometry.make(), material, members.length);
      members.forEach(({ shape }, i) => {
        const number = numbers[shape.body] ?? -1;
        const shade = kShades[Math.max(0, number) % kShades.length] ?? 1;
        mesh.setColorAt(i, number < 0 ? fixed : moving.clone().multiplyScalar(shade));
      });
      this.batches.push({ mesh, bodies: members.map(({ shape }) => numbers[shape.body] ?? -1),
        locals: members.map(({ shape, geometry }) => shapeMatrix(playback, shape, geometry.scale)) });
    }
  }

  /** A grid around the scene, in the plane. */
  private addPlane(place: THREE.Matrix4, centre: THREE.Vector3, colours: { grid: string; fixed: string }): void {
    const cell = gridCell(this.size);
    const cells = 2 * Math.ceil((3 * this.size) / cell);
    const group = new THREE.Group();
    group.applyMatrix4(place);
    group.updateMatrixWorld();
    const under = group.worldToLocal(centre.clone());
    const grid = new THREE.GridHelper(cell * cells, cells, colours.grid, colours.grid).rotateX(Math.PI / 2);
    const sheet = new THREE.Mesh(new THREE.PlaneGeometry(cell * cells, cell * cells),
      new THREE.MeshBasicMaterial({ color: colours.fixed, transparent: true, opacity: 0.22,
        side: THREE.DoubleSide, depthWrite: false, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 }));
    for (const part of [grid, sheet]) {
      part.position.set(cell * Math.round(under.x / cell), cell * Math.round(under.y / cell), 0);
      group.add(part);
    }
    this.disposables.push(grid, sheet.geometry, sheet.material);
    this.scene.add(group);
  }

  /** Puts everything where it is at a time. */
  place(t: number, showPoints: boolean, showForces: boolean): void {
    posesAt(this.track, t, this.poses);
    for (let body = 0; body < this.track.bodies; ++body) {
      const at = 7 * body;
      const p = this.poses;
      kPosition.set(p[at] ?? 0, p[at + 1] ?? 0, p[at + 2] ?? 0);
      kTurn.set(p[at + 4] ?? 0, p[at + 5] ?? 0, p[at + 6] ?? 0, p[at + 3] ?? 1);
      this.matrices[body]?.compose(kPosition, kTurn, kOnes);
    }
    for (const { mesh, bodies, locals } of this.batches) {
      for (let i = 0; i < bodies.length; ++i) {
        const local = locals[i] as THREE.Matrix4;
        const matrix = this.matrices[bodies[i] ?? -1];
        if (matrix === undefined) kProduct.copy(local);
        else kProduct.multiplyMatrices(matrix, local);
        mesh.setMatrixAt(i, kProduct);
      }
      mesh.instanceMatrix.needsUpdate = true;
    }
    this.placeRods();
    this.placeContacts(t, showPoints, showForces);
  }

  private placeRods(): void {
    const thick = 0.006 * this.size;
    this.rods.forEach(({ bodies, points }, i) => {
      const [from, to] = [0, 1].map((end) => {
        const body = bodies[end as 0 | 1];
        const matrix = this.matrices[this.numbers[body] ?? -1] ?? this.still[body] ?? kProduct.identity();
        return vector(points[end as 0 | 1]).applyMatrix4(matrix);
      }) as [THREE.Vector3, THREE.Vector3];
      kDirection.subVectors(to, from);
      kScale.set(thick, thick, kDirection.length());
      kTurn.setFromUnitVectors(kUp, kDirection.normalize());
      this.rodMesh.setMatrixAt(i, kProduct.compose(from, kTurn, kScale));
    });
    this.rodMesh.count = this.rods.length;
    this.rodMesh.instanceMatrix.needsUpdate = true;
  }

  private placeContacts(t: number, showPoints: boolean, showForces: boolean): void {
    const [first, end] = contactsAt(this.track, t);
    const { contacts } = this.track;
    const dot = 0.014 * this.markSize;
    let arrows = 0;
    for (let k = first; k < end; ++k) {
      const at = 6 * k;
      kPosition.set(contacts[at] ?? 0, contacts[at + 1] ?? 0, contacts[at + 2] ?? 0);
      kScale.setScalar(dot);
      this.points.setMatrixAt(k - first, kProduct.compose(kPosition, kNoTurn, kScale));
      kDirection.set(contacts[at + 3] ?? 0, contacts[at + 4] ?? 0, contacts[at + 5] ?? 0);
      const length = arrowLength(kDirection.length(), this.longestForce, this.markSize);
      if (length <= 0) continue;
      kTurn.setFromUnitVectors(kUp, kDirection.normalize());
      kScale.set(1.1 * dot, 1.1 * dot, length);
      this.arrows.setMatrixAt(arrows++, kProduct.compose(kPosition, kTurn, kScale));
    }
    this.points.count = showPoints ? end - first : 0;
    this.arrows.count = showForces ? arrows : 0;
    this.points.instanceMatrix.needsUpdate = true;
    this.arrows.instanceMatrix.needsUpdate = true;
  }

  dispose(): void {
    for (const one of this.disposables) one.dispose();
  }
}

const kPosition = new THREE.Vector3();
const kDirection = new THREE.Vector3();
const kScale = new THREE.Vector3();
const kOnes = new THREE.Vector3(1, 1, 1);
const kUp = new THREE.Vector3(0, 0, 1);
const kTurn = new THREE.Quaternion();
const kNoTurn = new THREE.Quaternion();
const kProduct = new THREE.Matrix4();

function gridCell(size: number): number {
  return niceBelow(size / 2);
}

/** Proportional to the force, up to 0.9 of the size. */
function arrowLength(force: number, longest: number, size: number): number {
  return longest > 0 ? 0.9 * Math.min(1, force / longest) * size : 0;
}

let renderer: THREE.WebGLRenderer | null = null;

/** One for the whole page: browsers allow few. @throws Error without WebGL. */
function sharedRenderer(): THREE.WebGLRenderer {
  if (renderer === null) {
    renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    renderer.setScissorTest(true);
    renderer.domElement.setAttribute('tabindex', '0');
  }
  return renderer;
}

export class Stage {
  readonly canvas: HTMLCanvasElement;
  readonly camera: THREE.PerspectiveCamera;
  readonly target: THREE.Vector3;
  /** Edge of a cell of the grids, m; null without a plane. */
  readonly cell: number | null;
  /** What the longest arrows stand for, N; 0 without forces. */
  readonly longestForce: number;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly radius: number;
  private sides: Side[] = [];
  private isDark: boolean | null = null;
  private width = 1;
  private height = 1;

  /** @throws Error if the browser has no WebGL. */
  constructor(private readonly tracks: readonly Track[], private readonly playback: Playback) {
    this.renderer = sharedRenderer();
    this.canvas = this.renderer.domElement;
    const { center, radius } = framing(tracks, playback);
    this.target = center;
    this.radius = radius;
    this.cell = playback.shapes.some((shape) => shape.kind === 'half_space') ? gridCell(radius) : null;
    const typical = typicalForce(tracks);
    this.longestForce = typical > 0 ? 3 * niceBelow(typical) : 0;
    this.camera = new THREE.PerspectiveCamera(kFieldOfView, 1, radius / 100, radius * 200);
    this.camera.up.set(0, 0, 1);
  }

  setSize(width: number, height: number, pixelRatio: number): void {
    this.width = width;
    this.height = height;
    this.renderer.setPixelRatio(pixelRatio);
    this.renderer.setSize(width, height, false);
    const parts = Math.max(1, this.tracks.length);
    this.camera.aspect = (width - kGap * (parts - 1)) / parts / height;
    this.camera.updateProjectionMatrix();
  }

  /** The view one starts with: everything inside, seen from the front, a little from above. */
  resetView(): void {
    const half = (kFieldOfView * Math.PI) / 360;
    const narrow = Math.atan(Math.tan(half) * Math.min(1, this.camera.aspect));
    const distance = (1.03 * this.radius) / Math.sin(narrow);
    this.camera.position.set(0.42, -1, 0.36).normalize().multiplyScalar(distance).add(this.target);
    this.camera.lookAt(this.target);
  }

  render(t: number, show: { points: boolean; forces: boolean }, dark: boolean): void {
    if (dark !== this.isDark) this.build(dark);
    const part = this.width / Math.max(1, this.sides.length);
    this.sides.forEach((side, i) => {
      side.place(t, show.points, show.forces);
      const left = i * part + (i > 0 ? kGap / 2 : 0);
      const width = part - (i > 0 ? kGap / 2 : 0) - (i + 1 < this.sides.length ? kGap / 2 : 0);
      this.renderer.setViewport(left, 0, width, this.height);
      this.renderer.setScissor(left, 0, width, this.height);
      this.renderer.render(side.scene, this.camera);
    });
  }

  private build(dark: boolean): void {
    this.dispose();
    this.isDark = dark;
    this.sides = this.tracks.map((track) =>
      new Side(track, this.playback, this.radius, this.target, this.longestForce, dark));
  }

  dispose(): void {
    for (const side of this.sides) side.dispose();
    this.sides = [];
    this.isDark = null;
  }
}
