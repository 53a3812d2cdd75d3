import assert from 'node:assert/strict';
import { test } from 'node:test';
import { decodeNumber, decodeReport } from '../src/report';

const kCheck = {
  name: 'c', engine: 'signorini', reference: 'r', unit: 'm', value: 'NaN', expected: 'Infinity',
  error: '-Infinity', tolerance: 1e-8, error_kind: 'absolute', reason: '', verdict: 'fail',
};

function report(changes: object): string {
  return JSON.stringify({
    schema: 'signorini-report', schema_version: 1, scenes: [], ...changes,
  });
}

test('numbers that JSON lacks are strings', () => {
  assert.equal(decodeNumber(1.5), 1.5);
  assert.ok(Number.isNaN(decodeNumber('NaN')));
  assert.equal(decodeNumber('-Infinity'), -Infinity);
  for (const bad of ['1', '', null, undefined, {}]) assert.throws(() => decodeNumber(bad));
});

test('checks and plots come with their numbers decoded', () => {
  const plots = [{ title: '', x_label: '', y_label: '', log_y: false,
    series: [{ name: '', engine: '', x: [0, 1], y: ['NaN', 2], points: 2 }] }];
  const scene = decodeReport(report({ scenes: [{ checks: [kCheck], plots }] })).scenes[0];
  assert.ok(Number.isNaN(scene?.checks[0]?.value));
  assert.equal(scene?.checks[0]?.expected, Infinity);
  assert.equal(scene?.checks[0]?.error, -Infinity);
  assert.deepEqual(scene?.plots[0]?.series[0]?.y, [NaN, 2]);
});

test('other data and other versions are refused', () => {
  assert.throws(() => decodeReport('null'), /not the data of a report/);
  assert.throws(() => decodeReport('{}'), /not the data of a report/);
  assert.throws(() => decodeReport('SIGNORINI_REPORT'), SyntaxError);
  assert.throws(() => decodeReport(report({ schema_version: 2 })), /version 2/);
});
