// The page of one scene.

import { Clock } from './clock';
import { h } from './dom';
import { errorText } from './front';
import { formatDuration, formatNumber, withUnit } from './format';
import { ratioTrack, trackAxis, trackLegend, verdictChip } from './marks';
import { Player, playbackEnd, stillFigure } from './player';
import { plotView } from './plot';
import type { PlotView } from './plot';
import { engineName } from './plot_data';
import type { Check, Scene, Table } from './report';
import { groupedChecks, toleranceRatio } from './verdict';
import type { CheckGroup } from './verdict';

function track(check: Check, group: CheckGroup): HTMLElement | null {
  const isJudged = check.verdict !== 'information';
  const tolerance = isJudged ? check.tolerance : group.tolerance;
  if (tolerance === null) return null;
  const engine = check.engine === 'bullet' ? 'bullet' : 'signorini';
  return ratioTrack([{ engine, ratio: toleranceRatio(check.error, tolerance) }]);
}

function checkRow(check: Check, group: CheckGroup): HTMLElement {
  // Beside an expected 0 a value is an error: more digits say nothing.
  const digits = check.expected === 0 ? 3 : 7;
  const exact = (value: number) => h('td', { class: 'number', title: String(value) },
    withUnit(formatNumber(value, digits), check.unit));
  return h('tr', { class: check.verdict },
    h('td', {}, verdictChip(check.verdict)),
    h('td', {}, engineName(check.engine)),
    exact(check.value), exact(check.expected),
    h('td', { class: 'number', title: String(check.error) }, errorText(check),
      h('small', {}, check.error_kind)),
    h('td', { class: 'number' }, check.verdict === 'information'
      ? h('span', { class: 'none', title: 'not judged' }, '–') : formatNumber(check.tolerance)),
    h('td', { class: 'track-cell' }, track(check, group)));
}

/** Why these tolerances, each reason once, with the engine it is for if they differ. */
function reasons(group: CheckGroup): HTMLElement[] {
  const judged = group.checks.filter((check) => check.verdict !== 'information');
  const shown = judged.length > 0 ? judged : group.checks;
  const texts = new Set(shown.map((check) => check.reason).filter((reason) => reason !== ''));
  return [...texts].map((text) => h('small', {}, text));
}

function checkGroup(group: CheckGroup): HTMLElement {
  const rows = group.checks.map((check) => checkRow(check, group));
  const references = [...new Set(group.checks.map((check) => check.reference))].join(', ');
  rows[0]?.prepend(h('th', { scope: 'rowgroup', rowspan: String(rows.length) }, group.name,
    h('small', { class: 'against' }, `against ${references}`), ...reasons(group)));
  return h('tbody', {}, ...rows);
}

function checksSection(scene: Scene): HTMLElement {
  if (scene.checks.length === 0) {
    return h('section', {}, h('h2', {}, 'Checks'), h('p', {}, 'Nothing is compared in this scene.'));
  }
  const heads = ['Check', 'Verdict', 'Engine', 'Value', 'Expected', 'Error', 'Tolerance'];
  const cells = heads.map((text, i) =>
    h('th', { scope: 'col', class: i >= 3 ? 'number' : '' }, text));
  return h('section', {}, h('h2', {}, 'Checks'), trackLegend(),
    h('div', { class: 'scroll' }, h('table', { class: 'checks' },
      h('caption', { class: 'unseen' }, `Checks of ${scene.title}`),
      h('thead', {}, h('tr', {}, ...cells,
        h('th', { scope: 'col', class: 'track-cell' }, 'Error / tolerance', trackAxis()))),
      ...groupedChecks(scene.checks).map(checkGroup))));
}

/** Columns whose cells are all numbers (or empty) stand on the right. */
function isNumeric(table: Table, column: number): boolean {
  const cells = table.rows.map((row) => row[column] ?? '');
  return cells.some((cell) => cell !== '')
    && cells.every((cell) => /^[-+−]?[\d.]*(\/\d+)?(e[-+−]?\d+)?$/i.test(cell));
}

function tableSection(table: Table): HTMLElement {
  const classes = table.header.map((_, column) => (isNumeric(table, column) ? 'number' : ''));
  const rows = table.rows.map((row) => h('tr', {}, ...row.map((cell, column) =>
    (column === 0 ? h('th', { scope: 'row', class: classes[column] ?? '' }, cell)
      : h('td', { class: classes[column] ?? '' }, cell)))));
  return h('section', {}, h('div', { class: 'scroll' }, h('table', { class: 'free' },
    h('caption', {}, table.title),
    h('thead', {}, h('tr', {}, ...table.header.map((text, column) =>
      h('th', { scope: 'col', class: classes[column] ?? '' }, text)))),
    h('tbody', {}, ...rows))));
}

const NOTICES_SHOWN = 6;

function noticesSection(scene: Scene): HTMLElement | null {
  if (scene.notices.length === 0) return null;
  const list = (notices: string[]) => h('ul', {}, ...notices.map((notice) => h('li', {}, notice)));
  const rest = scene.notices.slice(NOTICES_SHOWN);
  return h('section', { class: 'notices' }, h('h2', {}, 'Notices'), list(scene.notices.slice(0, NOTICES_SHOWN)),
    rest.length > 0 ? h('details', {}, h('summary', {}, `${rest.length} more`), list(rest)) : null);
}

function runSection(scene: Scene): HTMLElement {
  return h('section', { class: 'run' }, h('h2', {}, 'How it was run'),
    scene.settings.length > 0
      ? h('ul', {}, ...scene.settings.map((setting) => h('li', {}, setting))) : null,
    h('dl', {},
      h('dt', {}, 'Scene'), h('dd', {}, scene.source),
      h('dt', {}, 'Wall time'), h('dd', {}, `Signorini ${formatDuration(scene.signorini_seconds)}, `
        + `Bullet ${formatDuration(scene.bullet_seconds)}`),
      h('dt', {}, 'To repeat it'), h('dd', {}, h('pre', { class: 'command', tabindex: '0' }, scene.command))));
}

/** Plots over this play along with the 3D view. */
const kTimeLabel = 'time [s]';

function playbackSection(view: HTMLElement): HTMLElement {
  return h('section', {}, h('h2', {}, 'Playback'), view,
    h('p', { class: 'hint screen-only' }, h('kbd', {}, 'Space'), ' plays, ', h('kbd', {}, ','), ' ', h('kbd', {}, '.'),
      ' step, ', h('kbd', {}, '['), ' ', h('kbd', {}, ']'), ' change the speed, ', h('kbd', {}, 'c'), ' contacts, ',
      h('kbd', {}, 'f'), ' forces, ', h('kbd', {}, 'v'), ' resets the view. Drag turns both views, the wheel zooms '
      + 'after a click. Moving over a plot moves the time.'));
}

/** A scene on the page with what must be drawn and, in the end, freed. */
export interface SceneView {
  element: HTMLElement;
  plots: PlotView[];
  player: Player | null;
}

/** @param live a player and plots that follow it; else a still */
export function sceneView(scene: Scene, live: boolean): SceneView {
  const clock = scene.playback !== null && live ? new Clock(playbackEnd(scene.playback)) : null;
  const player = scene.playback !== null && clock !== null ? new Player(scene.playback, clock) : null;
  const plots = scene.plots.map((plot) => plotView(plot, plot.x_label === kTimeLabel ? clock : null));
  const view = player?.element ?? (scene.playback === null ? null : stillFigure(scene.playback));
  const element = h('article', { class: 'scene' },
    h('header', {}, h('p', { class: 'kicker' }, scene.name),
      h('h1', { tabindex: '-1' }, scene.title, ' ', verdictChip(scene.verdict)),
      h('p', { class: 'description' }, scene.description)),
    noticesSection(scene), view === null ? null : playbackSection(view), checksSection(scene),
    plots.length > 0 ? h('section', {}, h('h2', {}, 'Plots'),
      h('p', { class: 'hint screen-only' }, 'Drag to zoom, double-click to see all, click a name to hide its line.'),
      h('div', { class: 'plots' }, ...plots.map((plot) => plot.element))) : null,
    scene.tables.length > 0 ? h('h2', {}, 'Tables') : null, ...scene.tables.map(tableSection),
    runSection(scene));
  return { element, plots, player };
}
