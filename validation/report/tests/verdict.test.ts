import assert from 'node:assert/strict';
import { test } from 'node:test';
import { trackPosition } from '../src/marks';
import type { Check, Scene, Verdict } from '../src/report';
import { groupedChecks, selected, summarised, toleranceRatio } from '../src/verdict';
import type { Selection } from '../src/verdict';

function check(name: string, engine: string, verdict: Verdict, error = 0.5, tolerance = 1): Check {
  return {
    name, engine, verdict, error, tolerance, reference: 'closed form', unit: 'm', value: error,
    expected: 0, error_kind: 'absolute', reason: '',
  };
}

function scene(name: string, verdict: Verdict, checks: Check[] = []): Scene {
  return {
    name, title: `Title of ${name}`, description: '', source: '', command: '', verdict,
    worst_check: checks.length > 0 ? 0 : null, bullet_beside: checks.length > 1 ? 1 : null,
    signorini_seconds: null, bullet_seconds: null, settings: [], notices: [], checks, plots: [],
    tables: [], playback: null, trade: null,
  };
}

const kAll: Selection = { text: '', verdicts: new Set(), key: 'verdict', descending: true };

test('error over tolerance', () => {
  assert.equal(toleranceRatio(0.5, 2), 0.25);
  assert.equal(toleranceRatio(0, 0), 0);
  assert.equal(toleranceRatio(1, 0), Infinity);
  assert.ok(Number.isNaN(toleranceRatio(NaN, 1)));
});

test('the tolerance is the middle of the track, what is beyond stands at its ends', () => {
  assert.equal(trackPosition(1), 50);
  assert.equal(trackPosition(100), 75);
  assert.equal(trackPosition(0), 0);
  assert.equal(trackPosition(1e-9), 0);
  assert.equal(trackPosition(Infinity), 100);
  assert.equal(trackPosition(NaN), 100);
});

test('checks of one name stand together, groups with a failure first', () => {
  const groups = groupedChecks([
    check('a', 'signorini', 'pass'), check('b', 'signorini', 'fail', 3, 2),
    check('a', 'bullet', 'information'), check('c', 'bullet', 'information')]);
  assert.deepEqual(groups.map((group) => group.name), ['b', 'a', 'c']);
  assert.deepEqual(groups[1]?.checks.map((one) => one.engine), ['signorini', 'bullet']);
  assert.deepEqual(groups.map((group) => group.tolerance), [2, 1, null]);
});

test('scenes of one name have different addresses', () => {
  const routes = summarised([scene('a b', 'pass'), scene('a b', 'pass')]).map((one) => one.route);
  assert.deepEqual(routes, ['#/scene/a%20b', '#/scene/a%20b~2']);
});

test("Bullet's ratio is against the tolerance of the worst check", () => {
  const [judged, unjudged] = summarised([
    scene('a', 'pass', [check('c', 'signorini', 'pass', 1, 4), check('c', 'bullet', 'information', 8, 0)]),
    scene('b', 'information', [check('c', 'signorini', 'information')])]);
  assert.equal(judged?.ratio, 0.25);
  assert.equal(judged?.bulletRatio, 2);
  assert.equal(unjudged?.ratio, null);
});

test('failures stand first, equals keep their order', () => {
  const all = summarised([scene('p1', 'pass'), scene('i', 'information'), scene('f', 'fail'), scene('p2', 'pass')]);
  const names = (selection: Selection) => selected(all, selection).map((one) => one.scene.name);
  assert.deepEqual(names(kAll), ['f', 'p1', 'p2', 'i']);
  assert.deepEqual(names({ ...kAll, descending: false }), ['i', 'p1', 'p2', 'f']);
  assert.deepEqual(names({ ...kAll, verdicts: new Set(['pass']) }), ['p1', 'p2']);
});

test('NaN counts as the largest error, nothing judged as the smallest', () => {
  const all = summarised([
    scene('none', 'information'), scene('large', 'fail', [check('c', 'signorini', 'fail', 9, 1)]),
    scene('nan', 'fail', [check('c', 'signorini', 'fail', NaN, 1)])]);
  const sorted = selected(all, { ...kAll, key: 'ratio' });
  assert.deepEqual(sorted.map((one) => one.scene.name), ['nan', 'large', 'none']);
});

test('the filter wants every word, in names, titles and checks', () => {
  const all = summarised([scene('ball-drop', 'pass', [check('apex height', 'signorini', 'pass')]), scene('wedge', 'pass')]);
  const count = (text: string) => selected(all, { ...kAll, text }).length;
  assert.equal(count('  '), 2);
  assert.equal(count('BALL height'), 1);
  assert.equal(count('ball wedge'), 0);
  assert.equal(count('title of'), 2);
});
