// report.json as the page reads it. Fields: docs/report-schema.md.

import type { Playback } from './playback';

export type Verdict = 'pass' | 'fail' | 'information';

export interface Check {
  name: string;
  engine: string;
  reference: string;
  unit: string;
  value: number;
  expected: number;
  error: number;
  tolerance: number;
  error_kind: string;
  reason: string;
  verdict: Verdict;
}

export interface Series {
  name: string;
  engine: string;
  x: number[];
  y: number[];
  /** How many points report.json has; x and y may hold fewer. */
  points: number;
}

export interface Plot {
  title: string;
  x_label: string;
  y_label: string;
  log_y: boolean;
  series: Series[];
}

export interface Table {
  title: string;
  header: string[];
  rows: string[][];
}

export interface TradePoint {
  solver: string;
  engine: string;
  step: number;
  error: number;
  whole_seconds: number | null;
  solver_seconds: number | null;
}

/** Error against cost of one scene. */
export interface Trade {
  error: string;
  unit: string;
  reference: string;
  scale: number;
  duration: number;
  points: TradePoint[];
  /** Where another engine is faster at equal error: indices into points, the largest factor first. */
  losses: { theirs: number; ours: number | null; factor: number }[];
}

export interface Scene {
  name: string;
  title: string;
  description: string;
  source: string;
  command: string;
  verdict: Verdict;
  /** Indices into checks. */
  worst_check: number | null;
  bullet_beside: number | null;
  signorini_seconds: number | null;
  bullet_seconds: number | null;
  settings: string[];
  notices: string[];
  checks: Check[];
  plots: Plot[];
  tables: Table[];
  playback: Playback | null;
  trade: Trade | null;
}

export interface Report {
  schema: string;
  schema_version: number;
  command: string;
  version: string;
  engines: string;
  partial: boolean;
  jobs?: string;
  summary: Record<'scenes' | Verdict, number>;
  scenes: Scene[];
}

/** The schema's version that this page was written for. */
export const kSchemaVersion = 1;

/** JSON lacks NaN and infinity: they are the strings "NaN", "Infinity" and "-Infinity". */
export function decodeNumber(value: unknown): number {
  if (typeof value === 'number') return value;
  if (value === 'NaN' || value === 'Infinity' || value === '-Infinity') return Number(value);
  throw new Error(`expected a number, found ${JSON.stringify(value)}`);
}

function decodeCheck(check: Check): Check {
  return {
    ...check,
    value: decodeNumber(check.value),
    expected: decodeNumber(check.expected),
    error: decodeNumber(check.error),
    tolerance: decodeNumber(check.tolerance),
  };
}

function decodePlot(plot: Plot): Plot {
  const series = plot.series.map((line) => ({
    ...line,
    x: line.x.map(decodeNumber),
    y: line.y.map(decodeNumber),
  }));
  return { ...plot, series };
}

function decodeTrade(trade: Trade): Trade {
  return {
    ...trade,
    points: trade.points.map((point) => ({ ...point, error: decodeNumber(point.error) })),
    losses: trade.losses.map((loss) => ({ ...loss, factor: decodeNumber(loss.factor) })),
  };
}

/** @throws Error if the text is no report of this schema's version. */
export function decodeReport(text: string): Report {
  const report = JSON.parse(text) as Report | null;
  if (report?.schema !== 'signorini-report') throw new Error('these are not the data of a report');
  if (report.schema_version !== kSchemaVersion) {
    throw new Error(
      `the data have schema version ${report.schema_version}, this page reads ${kSchemaVersion}`,
    );
  }
  const scenes = report.scenes.map((scene) => ({
    ...scene,
    checks: scene.checks.map(decodeCheck),
    plots: scene.plots.map(decodePlot),
    playback: scene.playback ?? null,
    trade: scene.trade ? decodeTrade(scene.trade) : null,
  }));
  return { ...report, scenes };
}
