// Several lines, each with an x of its own, as the one table that uPlot draws.

import type { Plot, Series } from './report';

/** undefined: this line has no point at this x. null: a gap in the line. */
export type Column = (number | null | undefined)[];

export interface PlotData {
  x: number[];
  columns: Column[];
}

/**
 * All points of all lines in the order of x. Lines that have a point at the same x share a row; a
 * line with two points at one x (a jump) gets a row for each.
 * O(rows * lines).
 */
export function merged(lines: readonly { x: number[]; y: Column }[]): PlotData {
  const x: number[] = [];
  const columns: Column[] = lines.map(() => []);
  const next = lines.map(() => 0);
  for (;;) {
    const heads = lines.map((line, i) => line.x[next[i] ?? 0] ?? Infinity);
    const here = Math.min(Infinity, ...heads);
    if (here === Infinity) return { x, columns };
    x.push(here);
    lines.forEach((line, i) => {
      const at = next[i] ?? 0;
      const isHere = heads[i] === here;
      columns[i]?.push(isHere ? line.y[at] : undefined);
      if (isHere) next[i] = at + 1;
    });
  }
}

/** y as it can be drawn: a gap where it is not finite, or not above 0 on a logarithmic axis. */
export function drawable(y: readonly number[], log: boolean): (number | null)[] {
  return y.map((value) => (Number.isFinite(value) && (!log || value > 0) ? value : null));
}

/** Smallest and largest of what is drawn; null if nothing is. */
export function rangeOf(columns: readonly Column[]): [number, number] | null {
  let low = Infinity;
  let high = -Infinity;
  for (const column of columns) {
    for (const value of column) {
      if (value === null || value === undefined) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  return low <= high ? [low, high] : null;
}

/** Variation below this part of the value is drawn as the flat line it is to the eye. */
const kFlat = 1e-7;

/** The ends of a linear y axis: the range and a margin; a flat line in the middle of +-5 %. */
export function linearLimits(low: number, high: number): [number, number] {
  const size = Math.max(Math.abs(low), Math.abs(high));
  if (high - low <= kFlat * size) {
    const half = size === 0 ? 1 : 0.05 * size;
    return [low - half, high + half];
  }
  const margin = 0.06 * (high - low);
  // An axis that starts at 0 stays there when nothing is below it.
  const bottom = low >= 0 && low <= 0.25 * high ? (low === 0 ? -margin / 3 : 0) : low - margin;
  return [bottom, high + margin];
}

/** The ends of a logarithmic axis: whole decades around the range, at least one. */
export function logLimits(low: number, high: number): [number, number] {
  const bottom = Math.floor(Math.log10(low) + 1e-9);
  const top = Math.ceil(Math.log10(high) - 1e-9);
  return [10 ** bottom, 10 ** Math.max(top, bottom + 1)];
}

/** The value of a line at a row: its point there, or on the line between its neighbours. */
export interface ValueAt {
  value: number;
  isPoint: boolean;
}

/** null where the line has a gap or has ended. */
export function valueAt(x: readonly number[], column: Column, row: number): ValueAt | null {
  const here = column[row];
  if (here !== undefined) return here === null ? null : { value: here, isPoint: true };
  let left = row;
  let right = row;
  while (left >= 0 && column[left] === undefined) left -= 1;
  while (right < column.length && column[right] === undefined) right += 1;
  const [y0, y1, x0, x1] = [column[left], column[right], x[left], x[right]];
  if (typeof y0 !== 'number' || typeof y1 !== 'number') return null;
  if (x0 === undefined || x1 === undefined || x1 <= x0) return null;
  const part = ((x[row] ?? x0) - x0) / (x1 - x0);
  return { value: y0 + part * (y1 - y0), isPoint: false };
}

/** What a reader of the plot must know and cannot see. */
export function plotNotes(plot: Plot): string[] {
  const notes: string[] = [];
  for (const line of plot.series) {
    const name = lineName(line);
    const undrawable = line.y.filter((value) => !Number.isFinite(value)).length;
    if (line.y.length === 0) {
      notes.push(`${name}: no points.`);
    } else if (undrawable > 0) {
      notes.push(`${name}: not finite where the line has a gap or is missing.`);
    }
    const finite = line.y.filter((value) => Number.isFinite(value));
    if (plot.log_y && finite.length > 0) {
      const positive = finite.filter((value) => value > 0).length;
      if (finite.every((value) => value === 0)) {
        notes.push(`${name}: exactly 0 throughout, which a logarithmic axis cannot show.`);
      } else if (positive < finite.length) {
        notes.push(`${name}: 0 or less where not drawn (logarithmic axis).`);
      }
    } else if (finite.length > 1) {
      const spread = Math.max(...finite) - Math.min(...finite);
      const size = Math.max(...finite.map(Math.abs));
      if (spread > 0 && spread <= kFlat * size) {
        notes.push(`${name}: varies by ${spread.toExponential(1)}, too little to be seen.`);
      }
    }
  }
  return notes;
}

/** A line that is named after its engine is named once. */
export function lineName({ name, engine }: Pick<Series, 'name' | 'engine'>): string {
  const isSame = name === '' || name.toLowerCase() === engine.toLowerCase();
  return isSame ? engineName(engine) : `${name}, ${engineName(engine)}`;
}

export function engineName(engine: string): string {
  if (engine === 'signorini') return 'Signorini';
  return engine === 'bullet' ? 'Bullet' : engine;
}
