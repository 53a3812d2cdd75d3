// What the checks of a scene say, in the order people want to read it.

import type { Check, Scene, Verdict } from './report';

/** Failures first. */
export const kVerdicts: readonly Verdict[] = ['fail', 'pass', 'information'];

export function severity(verdict: Verdict): number {
  return kVerdicts.length - kVerdicts.indexOf(verdict);
}

/** error / tolerance; 0 / 0 is 0, anything else over 0 infinity, NaN stays NaN. */
export function toleranceRatio(error: number, tolerance: number): number {
  if (error === 0 && tolerance === 0) return 0;
  if (Number.isNaN(error) || Number.isNaN(tolerance)) return NaN;
  return tolerance <= 0 ? Infinity : error / tolerance;
}

/** The checks of one name: ours, Bullet's, others'. */
export interface CheckGroup {
  name: string;
  checks: Check[];
  /** Of the first judged check: what Bullet's unjudged number is shown against. */
  tolerance: number | null;
}

function worstSeverity(group: CheckGroup): number {
  return Math.max(...group.checks.map((check) => severity(check.verdict)));
}

/** Checks of the same name side by side, groups with a failure first, then the scene's order. */
export function groupedChecks(checks: readonly Check[]): CheckGroup[] {
  const groups = new Map<string, CheckGroup>();
  for (const check of checks) {
    const group = groups.get(check.name) ?? { name: check.name, checks: [], tolerance: null };
    group.checks.push(check);
    if (check.verdict !== 'information') group.tolerance ??= check.tolerance;
    groups.set(check.name, group);
  }
  return [...groups.values()].sort((a, b) => worstSeverity(b) - worstSeverity(a));
}

/** What a line of the front table shows of a scene. */
export interface SceneSummary {
  scene: Scene;
  /** Address on the page; unique, though two scenes may have one name. */
  route: string;
  worst: Check | null;
  bullet: Check | null;
  /** Against the worst check's tolerance; null if it is not judged. */
  ratio: number | null;
  bulletRatio: number | null;
}

export function summarised(scenes: readonly Scene[]): SceneSummary[] {
  const used = new Map<string, number>();
  return scenes.map((scene) => {
    const count = (used.get(scene.name) ?? 0) + 1;
    used.set(scene.name, count);
    const name = count === 1 ? scene.name : `${scene.name}~${count}`;

    const worst = scene.checks[scene.worst_check ?? -1] ?? null;
    const bullet = scene.checks[scene.bullet_beside ?? -1] ?? null;
    const judged = worst !== null && worst.verdict !== 'information';
    return {
      scene,
      route: `#/scene/${encodeURIComponent(name)}`,
      worst,
      bullet,
      ratio: judged ? toleranceRatio(worst.error, worst.tolerance) : null,
      bulletRatio: judged && bullet ? toleranceRatio(bullet.error, worst.tolerance) : null,
    };
  });
}

export type SortKey = 'verdict' | 'scene' | 'ratio' | 'bullet';

/** Which scenes the front table shows, and in which order. */
export interface Selection {
  text: string;
  verdicts: ReadonlySet<Verdict>;
  key: SortKey;
  descending: boolean;
}

/** NaN is worse than everything, nothing to compare (null) less than everything. */
function ratioRank(ratio: number | null): number {
  if (ratio === null) return -1;
  return Number.isNaN(ratio) ? Infinity : ratio;
}

function compare(a: SceneSummary, b: SceneSummary, key: SortKey): number {
  const rank = (left: number, right: number) => (left === right ? 0 : left < right ? -1 : 1);
  switch (key) {
    case 'verdict': return rank(severity(a.scene.verdict), severity(b.scene.verdict));
    case 'scene': return a.scene.title.localeCompare(b.scene.title, 'en', { numeric: true });
    case 'ratio': return rank(ratioRank(a.ratio), ratioRank(b.ratio));
    case 'bullet': return rank(ratioRank(a.bulletRatio), ratioRank(b.bulletRatio));
  }
}

function matches(summary: SceneSummary, words: readonly string[]): boolean {
  const { scene } = summary;
  const texts = [scene.name, scene.title, ...scene.checks.map((check) => check.name)];
  const haystack = texts.join('\n').toLowerCase();
  return words.every((word) => haystack.includes(word));
}

/** Equal scenes keep the report's order. No verdict chosen means all of them. */
export function selected(all: readonly SceneSummary[], selection: Selection): SceneSummary[] {
  const words = selection.text.toLowerCase().split(/\s+/).filter((word) => word !== '');
  const sign = selection.descending ? -1 : 1;
  return all
    .filter((one) => selection.verdicts.size === 0 || selection.verdicts.has(one.scene.verdict))
    .filter((one) => matches(one, words))
    .sort((a, b) => sign * compare(a, b, selection.key));
}
