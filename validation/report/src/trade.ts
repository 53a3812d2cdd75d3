// Error against cost: the points of all scenes on common axes. Pure functions.

import type { Scene, Trade, TradePoint } from './report';

/** Errors are drawn at least this large: below, none is seen (and 0 has no logarithm). */
export const kSmallestError = 1e-9;

export interface ScatterPoint {
  scene: Scene;
  point: TradePoint;
  /** Wall time of a simulated second, s. */
  cost: number;
  /** Error over the scene's scale, at least kSmallestError. */
  error: number;
}

/** A solver at a step: all of its scenes. */
export interface ScatterGroup {
  solver: string;
  engine: string;
  /** Of the scene's step: 1, or 1/4 ... */
  stepShare: number;
  points: ScatterPoint[];
  /** Geometric means over its scenes. */
  meanCost: number;
  meanError: number;
}

function scatterPoint(scene: Scene, trade: Trade, point: TradePoint): ScatterPoint | null {
  if (point.whole_seconds === null || !(point.whole_seconds > 0) || !Number.isFinite(point.error)) return null;
  return { scene, point, cost: point.whole_seconds / trade.duration,
    error: Math.max(kSmallestError, point.error / trade.scale) };
}

function geometricMean(values: readonly number[]): number {
  return Math.exp(values.reduce((sum, value) => sum + Math.log(value), 0) / values.length);
}

/** Solvers in the order of the report, each at each share of the scenes' steps. */
export function scatterGroups(scenes: readonly Scene[]): ScatterGroup[] {
  const groups = new Map<string, ScatterGroup>();
  for (const scene of scenes) {
    const { trade } = scene;
    if (trade === null) continue;
    const largest = Math.max(...trade.points.map((point) => point.step));
    for (const point of trade.points) {
      const drawn = scatterPoint(scene, trade, point);
      const stepShare = point.step / largest;
      const key = `${point.solver} ${stepShare.toFixed(6)}`;
      const group = groups.get(key) ?? { solver: point.solver, engine: point.engine, stepShare,
        points: [], meanCost: NaN, meanError: NaN };
      if (drawn !== null) group.points.push(drawn);
      groups.set(key, group);
    }
  }
  const all = [...groups.values()].filter((group) => group.points.length > 0);
  for (const group of all) {
    group.meanCost = geometricMean(group.points.map((one) => one.cost));
    group.meanError = geometricMean(group.points.map((one) => one.error));
  }
  return all;
}

/** "at the scene's step", "at 1/4 of it" */
export function stepText(share: number): string {
  return share === 1 ? "the scene's step" : `1/${Math.round(1 / share)} of the step`;
}

/** A scene's heaviest loss, for the list of where we lose. */
export interface LossLine {
  scene: Scene;
  trade: Trade;
  theirs: TradePoint;
  ours: TradePoint | null;
  factor: number;
}

/** The largest factor first; of one scene the heaviest loss. */
export function lossLines(scenes: readonly Scene[]): LossLine[] {
  const lines: LossLine[] = [];
  for (const scene of scenes) {
    const loss = scene.trade?.losses[0];
    const theirs = scene.trade?.points[loss?.theirs ?? -1];
    if (scene.trade === null || loss === undefined || theirs === undefined) continue;
    lines.push({ scene, trade: scene.trade, theirs, factor: loss.factor,
      ours: loss.ours === null ? null : scene.trade.points[loss.ours] ?? null });
  }
  return lines.sort((a, b) => b.factor - a.factor);
}
