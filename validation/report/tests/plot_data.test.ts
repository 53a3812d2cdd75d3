import assert from 'node:assert/strict';
import { test } from 'node:test';
import {
  drawable, lineName, linearLimits, logLimits, merged, plotNotes, rangeOf, valueAt,
} from '../src/plot_data';
import type { Plot } from '../src/report';

function plot(y: number[], log_y: boolean): Plot {
  const x = y.map((_, i) => i);
  return {
    title: 't', x_label: 'x', y_label: 'y', log_y,
    series: [{ name: 'line', engine: 'signorini', x, y, points: y.length }],
  };
}

test('lines with different x share one table without inventing points', () => {
  const { x, columns } = merged([{ x: [0, 1, 2], y: [10, 11, 12] }, { x: [0, 1.5], y: [20, 21] }]);
  assert.deepEqual(x, [0, 1, 1.5, 2]);
  assert.deepEqual(columns[0], [10, 11, undefined, 12]);
  assert.deepEqual(columns[1], [20, undefined, 21, undefined]);
});

test('a jump keeps both of its points', () => {
  const { x, columns } = merged([{ x: [0, 1, 1, 2], y: [0, 1, 5, 5] }, { x: [1], y: [7] }]);
  assert.deepEqual(x, [0, 1, 1, 2]);
  assert.deepEqual(columns[0], [0, 1, 5, 5]);
  assert.deepEqual(columns[1], [undefined, 7, undefined, undefined]);
});

test('a value between two points of a line is interpolated and says so', () => {
  const x = [0, 1, 2, 3, 4];
  const column = [10, undefined, 20, undefined, null];
  assert.deepEqual(valueAt(x, column, 0), { value: 10, isPoint: true });
  assert.deepEqual(valueAt(x, column, 1), { value: 15, isPoint: false });
  assert.equal(valueAt(x, column, 3), null);
  assert.equal(valueAt(x, column, 4), null);
  assert.equal(valueAt(x, [undefined, 1, undefined], 0), null);
  assert.equal(valueAt(x, [undefined, 1, undefined], 2), null);
});

test('nothing to merge is an empty table', () => {
  assert.deepEqual(merged([]), { x: [], columns: [] });
  assert.deepEqual(merged([{ x: [], y: [] }]), { x: [], columns: [[]] });
});

test('what cannot be drawn is a gap', () => {
  assert.deepEqual(drawable([1, NaN, 0, -1, Infinity], false), [1, null, 0, -1, null]);
  assert.deepEqual(drawable([1, NaN, 0, -1, Infinity], true), [1, null, null, null, null]);
});

test('the range is of what is drawn', () => {
  assert.deepEqual(rangeOf([[3, null, undefined, -1], [2]]), [-1, 3]);
  assert.equal(rangeOf([[null, undefined], []]), null);
});

test('a line is named by what it is and its engine, and not twice by its engine', () => {
  assert.equal(lineName({ name: 'height', engine: 'bullet' }), 'height, Bullet');
  assert.equal(lineName({ name: 'signorini', engine: 'signorini' }), 'Signorini');
  assert.equal(lineName({ name: 'Closed form', engine: 'closed form' }), 'closed form');
});

test('rounding of a constant is drawn flat, in the middle', () => {
  const [low, high] = linearLimits(9.81, 9.81 + 1e-14);
  assert.ok(low < 9.5 && high > 10.1);
  assert.deepEqual(linearLimits(0, 0), [-1, 1]);
});

test('limits enclose the range', () => {
  for (const [low, high] of [[0, 1], [-3, 2], [5, 6], [0.1, 1], [-2, -1]] as const) {
    const [bottom, top] = linearLimits(low, high);
    assert.ok(bottom <= low && top > high, `${low} .. ${high} in ${bottom} .. ${top}`);
  }
});

test('logarithmic limits are whole decades and never equal', () => {
  assert.deepEqual(logLimits(2e-3, 5), [1e-3, 10]);
  assert.deepEqual(logLimits(1, 1), [1, 10]);
});

test('notes say what the eye cannot see', () => {
  assert.deepEqual(plotNotes(plot([1, 2], false)), []);
  assert.match(plotNotes(plot([], false)).join(), /no points/);
  assert.match(plotNotes(plot([1, NaN], false)).join(), /not finite/);
  assert.match(plotNotes(plot([0, 0], true)).join(), /exactly 0 throughout/);
  assert.match(plotNotes(plot([0, 1], true)).join(), /0 or less where not drawn/);
  assert.match(plotNotes(plot([5, 5 + 1e-13], false)).join(), /too little to be seen/);
});
