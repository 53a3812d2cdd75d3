import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Scene, Trade, TradePoint } from '../src/report';
import { kSmallestError, lossLines, scatterGroups, stepText } from '../src/trade';

function point(solver: string, step: number, error: number, whole_seconds: number | null): TradePoint {
  return { solver, engine: solver === 'ours' ? 'signorini' : 'bullet', step, error, whole_seconds, solver_seconds: null };
}

function scene(points: TradePoint[] | null, losses: Trade['losses'] = []): Scene {
  const trade = points && { error: 'e', unit: 'm', reference: 'closed form', scale: 2, duration: 4, points, losses };
  return { name: 's', trade } as Scene;
}

test('solvers are grouped by their share of the step, with geometric means', () => {
  const groups = scatterGroups([
    scene([point('ours', 0.1, 2e-2, 4), point('ours', 0.025, 2e-4, 16)]),
    scene([point('ours', 0.4, 2e-4, 400), point('theirs', 0.4, 2, 4)]), scene(null)]);
  assert.deepEqual(groups.map(({ solver, stepShare }) => [solver, stepShare]), [['ours', 1], ['ours', 0.25], ['theirs', 1]]);
  assert.ok(Math.abs((groups[0]?.meanCost ?? 0) - 10) < 1e-9);
  assert.ok(Math.abs((groups[0]?.meanError ?? 0) - 1e-3) < 1e-12);
});

test('no error, not run, no time: not drawn; error 0 stands at the bottom', () => {
  const groups = scatterGroups([scene([
    point('ours', 1, NaN, 1), point('theirs', 1, Infinity, 1), point('c', 1, 1, null), point('d', 1, 1, 0), point('e', 1, 0, 1)])]);
  assert.deepEqual(groups.map(({ solver, points }) => [solver, points[0]?.error]), [['e', kSmallestError]]);
});

test('of each scene the heaviest loss, the heaviest scene first', () => {
  const points = [point('ours', 1, 0, 8), point('theirs', 1, 0, 1), point('theirs', 0.5, 0, 2)];
  const lines = lossLines([
    scene(points, [{ theirs: 1, ours: 0, factor: 8 }, { theirs: 2, ours: 0, factor: 4 }]), scene(points), scene(null),
    scene(points, [{ theirs: 2, ours: null, factor: Infinity }])]);
  assert.deepEqual(lines.map(({ factor, ours }) => [factor, ours?.solver]), [[Infinity, undefined], [8, 'ours']]);
});

test('steps in words', () => {
  assert.equal(stepText(1), "the scene's step");
  assert.equal(stepText(0.25), '1/4 of the step');
});
