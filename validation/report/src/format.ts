// Numbers as people read them. The exact ones are in report.json.

const kSuperscripts = '⁰¹²³⁴⁵⁶⁷⁸⁹';

/** At most `digits` significant digits, plain between 1e-3 and 1e5, else as 1.2e-7. */
export function formatNumber(value: number, digits = 3): string {
  if (Number.isNaN(value)) return 'NaN';
  if (!Number.isFinite(value)) return value > 0 ? '∞' : '-∞';
  if (value === 0) return '0';
  const rounded = Number(value.toPrecision(digits));
  const size = Math.abs(rounded);
  if (size >= 1e-3 && size < 1e5) return String(rounded);
  return rounded.toExponential().replace('e+', 'e');
}

export function withUnit(text: string, unit: string): string {
  return unit === '' || unit === '1' || text === 'NaN' ? text : `${text} ${unit}`;
}

/** Seconds with the prefix that suits them; null is an engine that was not run. */
export function formatDuration(seconds: number | null): string {
  if (seconds === null) return 'not run';
  if (seconds >= 1 || seconds === 0) return `${formatNumber(seconds)} s`;
  if (seconds >= 1e-3) return `${formatNumber(seconds * 1e3)} ms`;
  return `${formatNumber(seconds * 1e6)} µs`;
}

/** error / tolerance in words: "0.31 ×", "> 10⁴ ×". */
export function formatRatio(ratio: number): string {
  if (Number.isNaN(ratio)) return 'NaN';
  if (ratio === Infinity) return '∞';
  return `${formatNumber(ratio, 2)} ×`;
}

/** 1e-12 as 10⁻¹². The value is a power of ten up to rounding. */
export function formatDecade(value: number): string {
  const exponent = Math.round(Math.log10(value));
  if (exponent === 0 || exponent === 1) return exponent === 0 ? '1' : '10';
  const digits = [...String(Math.abs(exponent))].map((digit) => kSuperscripts[Number(digit)]);
  return `10${exponent < 0 ? '⁻' : ''}${digits.join('')}`;
}

/** Labels of a linear axis whose ticks are `step` apart: as many decimals as the step needs. */
export function formatTicks(ticks: readonly number[], step: number): string[] {
  const largest = Math.max(step, ...ticks.map(Math.abs));
  if (largest >= 1e5 || largest < 1e-3) {
    const digits = Math.max(1, Math.floor(Math.log10(largest)) - Math.floor(Math.log10(step)) + 1);
    return ticks.map((tick) => formatNumber(Math.abs(tick) < step / 1e3 ? 0 : tick, digits));
  }
  let decimals = 0;
  while (decimals < 12 && Math.abs(step * 10 ** decimals - Math.round(step * 10 ** decimals)) > 1e-6) {
    decimals += 1;
  }
  return ticks.map((tick) => (Math.abs(tick) < step / 1e3 ? 0 : tick).toFixed(decimals));
}
