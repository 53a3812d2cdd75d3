import assert from 'node:assert/strict';
import { test } from 'node:test';
import {
  formatDecade, formatDuration, formatNumber, formatRatio, formatTicks, withUnit,
} from '../src/format';

test('numbers are short and keep their magnitude', () => {
  assert.equal(formatNumber(0), '0');
  assert.equal(formatNumber(-0.6), '-0.6');
  assert.equal(formatNumber(0.0012345), '0.00123');
  assert.equal(formatNumber(1.2e-13), '1.2e-13');
  assert.equal(formatNumber(123456), '1.23e5');
  assert.equal(formatNumber(99999.9), '1e5');
  assert.equal(formatNumber(12.402, 7), '12.402');
});

test('what is no number says so', () => {
  assert.equal(formatNumber(NaN), 'NaN');
  assert.equal(formatNumber(Infinity), '∞');
  assert.equal(formatNumber(-Infinity), '-∞');
  assert.equal(formatRatio(NaN), 'NaN');
  assert.equal(formatRatio(Infinity), '∞');
});

test('neither the unit "1" nor a unit of NaN is written', () => {
  assert.equal(withUnit('5', 'm'), '5 m');
  assert.equal(withUnit('5', '1'), '5');
  assert.equal(withUnit('NaN', 'm'), 'NaN');
});

test('durations have the prefix that suits them, and not run is no number', () => {
  assert.equal(formatDuration(null), 'not run');
  assert.equal(formatDuration(0), '0 s');
  assert.equal(formatDuration(12.34), '12.3 s');
  assert.equal(formatDuration(0.0123), '12.3 ms');
  assert.equal(formatDuration(2.1e-5), '21 µs');
});

test('decades are powers of ten', () => {
  assert.equal(formatDecade(1e-12), '10⁻¹²');
  assert.equal(formatDecade(1e6), '10⁶');
  assert.equal(formatDecade(0.1), '10⁻¹');
  assert.equal(formatDecade(1), '1');
  assert.equal(formatDecade(10), '10');
});

test('ticks have the decimals that tell them apart', () => {
  assert.deepEqual(formatTicks([0, 0.25, 0.5], 0.25), ['0.00', '0.25', '0.50']);
  assert.deepEqual(formatTicks([0, 1, 2], 1), ['0', '1', '2']);
  assert.deepEqual(formatTicks([-1e-17, 0.1], 0.1), ['0.0', '0.1']);
  assert.deepEqual(formatTicks([0, 2e-7, 4e-7], 2e-7), ['0', '2e-7', '4e-7']);
  assert.deepEqual(formatTicks([1e6, 1.5e6], 5e5), ['1e6', '1.5e6']);
  const close = formatTicks([9.81, 9.8101, 9.8102], 1e-4);
  assert.equal(new Set(close).size, 3);
});
