import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Clock } from '../src/clock';
import {
  boundsOf, contactsAt, frameAtOrAfter, nearestFrame, niceBelow, posesAt, rodsOf, typicalForce, unpack,
} from '../src/playback';
import type { Playback, PlaybackBody, Track } from '../src/playback';

function base64(numbers: number[]): string {
  return Buffer.from(Int16Array.from(numbers).buffer).toString('base64');
}

function body(name: string, kind: PlaybackBody['kind']): PlaybackBody {
  return { name, kind, position: [0, 0, 0], orientation: [1, 0, 0, 0] };
}

/** A fixed floor and two bodies; two frames; the second with three contacts. */
function playback(): Playback {
  return {
    gravity: [0, 0, -10],
    bodies: [body('floor', 'fixed'), body('a', 'dynamic'), body('b', 'kinematic')],
    shapes: [
      { name: 's', body: 1, kind: 'sphere', sizes: [0.5], surface: null, position: [0, 0, 0], orientation: [1, 0, 0, 0] },
      { name: 'p', body: 0, kind: 'half_space', sizes: [], surface: null, position: [0, 0, 0], orientation: [1, 0, 0, 0] },
    ],
    surfaces: [],
    tracks: [{
      engine: 'signorini',
      time: [0, 2],
      poses: {
        middle: [0, 0, 1, 5, 5, 5], step: [0.5, 0, 0, 0, 0, 0],
        data: base64([0, 0, 0, 32767, 0, 0, 0, 0, 0, 0, 32767, 0, 0, 0,
          4, 0, 0, 0, 32767, 0, 0, 0, 0, 0, -32767, 0, 0, 0]),
      },
      contacts: {
        count: [0, 3], count_whole: [0, 9], point_middle: [0, 0, 0], point_step: [1, 1, 1], force_step: 2,
        bodies: base64([0, 1, 1, 0, 1, 2]),
        data: base64([1, 2, 3, 0, 0, -5, 0, 0, 0, 0, 0, 5, 0, 0, 0, 1, 0, -5]),
      },
    }],
  };
}

function track(): Track {
  const all = playback();
  return unpack(all.tracks[0]!, all);
}

test('positions are middle + step k, of the bodies that are not fixed', () => {
  const { poses, bodies } = track();
  assert.equal(bodies, 2);
  assert.deepEqual([...poses.slice(0, 7)], [0, 0, 1, 1, 0, 0, 0]);
  assert.deepEqual([...poses.slice(14, 21)], [2, 0, 1, 0, 1, 0, 0]);
});

test('joints are drawn from moving centres to their anchors, and between anchors that are apart', () => {
  const all = playback();
  assert.deepEqual(rodsOf(all), []);
  const joint = { name: 'j', body_a: 1, body_b: 0, anchor_a: [0, 0, 5], anchor_b: [1, 2, 3] };
  all.joints = [{ ...joint, kind: 'hinge' }];
  assert.deepEqual(rodsOf(all), [{ bodies: [1, 1], points: [[0, 0, 0], [0, 0, 5]] }]);
  all.joints = [{ ...joint, kind: 'distance', anchor_a: [0, 0, 0], body_b: 2 }];
  assert.deepEqual(rodsOf(all), [
    { bodies: [2, 2], points: [[0, 0, 0], [1, 2, 3]] },
    { bodies: [1, 2], points: [[0, 0, 0], [1, 2, 3]] },
  ]);
});

test('forces are shown on the moving body, of two on the one that is pushed up', () => {
  const { contacts } = track();
  const forces = [0, 1, 2].map((k) => [...contacts.slice(6 * k + 3, 6 * k + 6)]);
  assert.deepEqual(forces, [[-0, -0, 10], [0, 0, 10], [-2, -0, 10]]);
  assert.deepEqual([...contacts.slice(0, 3)], [1, 2, 3]);
});

test('data that do not fit their counts are refused', () => {
  const all = playback();
  all.tracks[0]!.time.push(3);
  assert.throws(() => unpack(all.tracks[0]!, all), /poses: 56 bytes, expected 84/);
});

test('between two frames: halfway on the line, and on the shorter arc', () => {
  const out = new Float32Array(14);
  posesAt(track(), 1, out);
  const half = Math.SQRT1_2;
  [1, 0, 1, half, half, 0, 0].forEach((value, i) => assert.ok(Math.abs(out[i]! - value) < 1e-6));
  // q and -q are the same turn: halfway between them nothing has turned.
  assert.equal(Math.abs(out[10]!), 1);
  posesAt(track(), 99, out);
  assert.equal(out[0], 2);
  posesAt(track(), -1, out);
  assert.equal(out[0], 0);
});

test('contacts are those of the step that ends at the frame', () => {
  assert.deepEqual(contactsAt(track(), 0), [0, 0]);
  assert.deepEqual(contactsAt(track(), 0.5), [0, 3]);
  assert.deepEqual(contactsAt(track(), 2), [0, 3]);
});

test('frames are found by time', () => {
  const time = [0, 1, 2, 5];
  assert.deepEqual([-1, 0, 0.5, 1, 4, 9].map((t) => frameAtOrAfter(time, t)), [0, 0, 1, 1, 3, 3]);
  assert.deepEqual([-1, 0.4, 0.6, 3, 4, 9].map((t) => nearestFrame(time, t)), [0, 0, 1, 2, 3, 3]);
  assert.equal(frameAtOrAfter([], 1), 0);
});

test('a run without bodies, frames or contacts is shown as nothing', () => {
  const all = { ...playback(), bodies: [body('floor', 'fixed')], shapes: [] };
  const empty = unpack({
    engine: 'bullet', time: [], poses: { middle: [], step: [], data: '' },
    contacts: { count: [], count_whole: [], point_middle: [], point_step: [], force_step: 0, bodies: '', data: '' },
  }, all);
  assert.equal(boundsOf(empty, all), null);
  assert.equal(typicalForce([empty]), 0);
  posesAt(empty, 1, new Float32Array(0));
});

test('bounds hold every body with its shape over the whole run', () => {
  const all = playback();
  assert.deepEqual(boundsOf(track(), all), { low: [-0.5, -0.5, 0.5], high: [5, 5, 5] });
});

test('round numbers', () => {
  assert.deepEqual([1, 1.9, 2, 4.9, 5, 99, 0.03].map(niceBelow), [1, 1, 2, 2, 5, 50, 0.02]);
});

test('the clock stays in its range and tells all but the mover', () => {
  const clock = new Clock(2);
  const heard: string[] = [];
  const [a, b] = [{}, {}];
  clock.listen(a, (t) => heard.push(`a ${t}`));
  clock.listen(b, (t) => heard.push(`b ${t}`));
  clock.move(5, a);
  clock.move(-1, b);
  clock.forget(a);
  clock.move(1, b);
  assert.deepEqual(heard, ['b 2', 'a 0']);
  assert.equal(clock.time, 1);
});
