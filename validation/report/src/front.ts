// The front page: how many scenes fail, and the table of all of them.

import { h } from './dom';
import type { Child } from './dom';
import { formatDuration, formatNumber, withUnit } from './format';
import { ratioTrack, trackAxis, trackLegend, verdictChip, verdictIcon } from './marks';
import type { Mark } from './marks';
import { engineName } from './plot_data';
import type { Check, Report, Verdict } from './report';
import { scatter } from './scatter';
import { lossLines, scatterGroups } from './trade';
import type { LossLine } from './trade';
import { kVerdicts, selected } from './verdict';
import type { SceneSummary, Selection, SortKey } from './verdict';

export function headline(report: Report): string {
  const { scenes, fail, pass } = report.summary;
  if (scenes === 0) return 'No scene was run';
  if (fail > 0) return `${fail} of ${scenes} scenes ${fail === 1 ? 'fails' : 'fail'}`;
  if (pass === 0) return `${scenes} scenes for information, none judged`;
  return pass === scenes ? `All ${scenes} scenes pass` : `All ${pass} judged scenes pass`;
}

/** The problem in one line. */
export function equation(): HTMLElement {
  return h('p', { class: 'equation' },
    h('span', { class: 'formula', role: 'math', 'aria-label': '0 at most f, perpendicular to d at least 0' },
      '0 ≤ ', h('i', {}, 'f'), '  ⊥  ', h('i', {}, 'd'), ' ≥ 0'),
    h('span', { class: 'meaning' },
      'At each contact the force only pushes, the gap does not close, and one of the two is zero.'));
}

export function partialBanner(report: Report): HTMLElement | null {
  if (!report.partial) return null;
  return h('p', { class: 'banner', role: 'alert' },
    h('strong', {}, 'Partial report. '), 'The run was interrupted: scenes are missing.');
}

/** An error as the tolerance measures it: relative ones have no unit. */
export function errorText(check: Check): string {
  return withUnit(formatNumber(check.error), check.error_kind === 'relative' ? '' : check.unit);
}

function errorCell(check: Check | null): HTMLElement {
  if (check === null) return h('td', { class: 'number' }, h('span', { class: 'none' }, 'no check'));
  const owed = check.verdict === 'information'
    ? 'not judged' : `tolerance ${formatNumber(check.tolerance)}`;
  return h('td', { class: 'number' }, errorText(check), h('small', {}, owed));
}

function bulletCell(check: Check | null): HTMLElement {
  const text: Child = check === null ? h('span', { class: 'none', title: 'no such check' }, '–')
    : errorText(check);
  return h('td', { class: 'number' }, text);
}

function marksOf(summary: SceneSummary): Mark[] {
  const marks: Mark[] = [];
  if (summary.bulletRatio !== null) marks.push({ engine: 'bullet', ratio: summary.bulletRatio });
  if (summary.ratio !== null) {
    const engine = summary.worst?.engine === 'bullet' ? 'bullet' : 'signorini';
    marks.push({ engine, ratio: summary.ratio });
  }
  return marks;
}

function row(summary: SceneSummary): HTMLElement {
  const { scene, worst } = summary;
  const marks = marksOf(summary);
  const compared = worst === null ? h('td')
    : h('td', { class: 'compared' }, worst.name,
        h('small', {}, worst.engine === 'signorini' ? '' : `${engineName(worst.engine)} `,
          `against ${worst.reference}`));
  const line = h('tr', { class: scene.verdict, 'data-scene': scene.name },
    h('td', {}, verdictChip(scene.verdict)),
    h('th', { scope: 'row' }, h('a', { href: summary.route }, scene.title),
      h('small', { class: 'name', title: 'Repeats this scene' }, scene.command)),
    compared, errorCell(worst), bulletCell(summary.bullet),
    h('td', { class: 'track-cell' }, marks.length > 0 ? ratioTrack(marks) : null));
  // The whole line is a target; the link in it is what keyboards and screen readers use.
  line.addEventListener('click', (event) => {
    const isOnLink = event.target instanceof Element && event.target.closest('a') !== null;
    if (!isOnLink && getSelection()?.isCollapsed !== false) location.hash = summary.route;
  });
  return line;
}

function lossRow({ scene, trade, theirs, ours, factor }: LossLine, route: string): HTMLElement {
  const text = (value: number) => withUnit(formatNumber(value), trade.unit);
  const way = (step: number, solver: string, seconds: number | null) =>
    [solver, h('small', {}, `step ${formatNumber(step)} s, ${formatDuration(seconds)}`)];
  return h('tr', {},
    h('th', { scope: 'row' }, h('a', { href: route }, scene.title), h('small', {}, trade.error)),
    h('td', { class: 'number' }, text(theirs.error)),
    h('td', {}, ...way(theirs.step, theirs.solver, theirs.whole_seconds)),
    h('td', {}, ...(ours === null ? ['not reached by any run']
      : [...way(ours.step, ours.solver, ours.whole_seconds), h('small', {}, `error ${text(ours.error)}`)])),
    h('td', { class: 'number' }, Number.isFinite(factor) ? `${formatNumber(factor, 2)} ×` : '–'));
}

function routesOf(summaries: readonly SceneSummary[]): Map<object, string> {
  return new Map<object, string>(summaries.map(({ scene, route }) => [scene, route]));
}

/** The picture of error against cost; null if no scene has any. */
function tradeSection(summaries: readonly SceneSummary[]): HTMLElement | null {
  const groups = scatterGroups(summaries.map(({ scene }) => scene));
  if (groups.length === 0) return null;
  return h('section', {}, h('h2', {}, 'Error against cost'), scatter(groups, routesOf(summaries)));
}

/** What the picture says against us. */
function lossSection(summaries: readonly SceneSummary[]): HTMLElement | null {
  const measured = summaries.filter(({ scene }) => scene.trade !== null).length;
  if (measured === 0) return null;
  const routes = routesOf(summaries);
  const lost = lossLines(summaries.map(({ scene }) => scene));
  return h('section', {},
    h('h2', {}, `Where we lose: ${lost.length} of ${measured} scenes`),
    h('p', { class: 'hint' }, 'Bullet is faster at equal error. For each scene the heaviest case: its run, and the cheapest '
      + 'of ours that errs no more. Errors below 10⁻⁹ of the scale count as equal; a run that is wrong by the scale or more is no answer.'),
    lost.length === 0 ? h('p', {}, 'Nowhere in this report.')
      : h('div', { class: 'scroll' }, h('table', { class: 'losses' },
        h('thead', {}, h('tr', {}, ...['Scene', 'Error', 'Theirs', 'Ours, at most that error', 'Our time / theirs'].map(
          (title, i) => h('th', { scope: 'col', class: i === 1 || i === 4 ? 'number' : '' }, title)))),
        h('tbody', {}, ...lost.map((line) => lossRow(line, routes.get(line.scene) ?? '#/'))))));
}

const kColumns: { key: SortKey | null; title: string; classes: string }[] = [
  { key: 'verdict', title: 'Verdict', classes: '' },
  { key: 'scene', title: 'Scene', classes: '' },
  { key: null, title: 'Worst check', classes: '' },
  { key: null, title: 'Error', classes: 'number' },
  { key: 'bullet', title: "Bullet's error", classes: 'number' },
  { key: 'ratio', title: 'Error / tolerance', classes: 'track-cell' },
];

/** Worst first is what one wants of everything but names. */
function startsDescending(key: SortKey): boolean {
  return key !== 'scene';
}

/** The front page, over a selection that outlives it: back from a scene, it is as it was left. */
export class Front {
  readonly element: HTMLElement;
  private readonly filter = h('input', {
    type: 'search', id: 'filter', placeholder: 'Filter scenes ( / )', 'aria-label': 'Filter scenes',
    autocomplete: 'off', spellcheck: 'false',
  });
  private readonly head = h('tr');
  private readonly body = h('tbody');
  private readonly count = h('p', { class: 'count', role: 'status' });
  private readonly tiles = new Map<Verdict, HTMLButtonElement>();

  constructor(
    private readonly report: Report,
    private readonly summaries: readonly SceneSummary[],
    private selection: Selection,
    private readonly onSelection: (selection: Selection) => void,
  ) {
    this.filter.value = selection.text;
    this.filter.addEventListener('input', () => this.select({ text: this.filter.value }));
    this.element = h('div', { class: 'front' }, this.header(), tradeSection(summaries),
      h('h2', {}, 'Scenes'),
      h('div', { class: 'tools' }, this.filter, this.count, trackLegend()),
      h('div', { class: 'scroll' }, h('table', { class: 'scenes' },
        h('caption', { class: 'unseen' }, 'All scenes with verdict and worst check'),
        h('thead', {}, this.head), this.body)),
      lossSection(summaries),
      this.footer());
    this.update();
  }

  focusFilter(): void {
    this.filter.focus();
    this.filter.select();
  }

  private select(change: Partial<Selection>): void {
    this.selection = { ...this.selection, ...change };
    this.onSelection(this.selection);
    this.update();
  }

  private toggleVerdict(verdict: Verdict): void {
    const verdicts = new Set(this.selection.verdicts);
    if (!verdicts.delete(verdict)) verdicts.add(verdict);
    this.select({ verdicts });
  }

  private sortBy(key: SortKey): void {
    const isSame = key === this.selection.key;
    const descending = isSame ? !this.selection.descending : startsDescending(key);
    this.select({ key, descending });
  }

  private header(): HTMLElement {
    const words: Record<Verdict, string> = {
      fail: 'failed', pass: 'passed', information: 'for information',
    };
    const tiles = h('div', { class: 'tiles', role: 'group', 'aria-label': 'Show only' });
    for (const verdict of kVerdicts) {
      const tile = h('button', { type: 'button', class: `tile ${verdict}`,
        click: () => this.toggleVerdict(verdict) },
        verdictIcon(verdict), h('b', {}, String(this.report.summary[verdict])), ` ${words[verdict]}`);
      this.tiles.set(verdict, tile);
      tiles.append(tile);
    }
    return h('header', { class: 'masthead' },
      h('p', { class: 'kicker' }, 'Signorini validation report'),
      h('h1', { tabindex: '-1' }, headline(this.report)), equation(), partialBanner(this.report), tiles);
  }

  private footer(): HTMLElement {
    const { version, engines, command, jobs } = this.report;
    return h('footer', {},
      h('p', {}, `Signorini ${version}, beside ${engines}. Made by`),
      h('pre', { class: 'command', tabindex: '0' }, command),
      jobs ? h('p', {}, `${jobs}.`) : null,
      h('p', { class: 'screen-only' }, 'Keys: ', h('kbd', {}, '/'), ' filter, ', h('kbd', {}, '←'), ' ',
        h('kbd', {}, '→'), ' previous and next scene, ', h('kbd', {}, 'Esc'), ' back here. ',
        h('a', { href: '#/all' }, 'All scenes on one page'),
        ', to print. All numbers in full: report.json.'));
  }

  private update(): void {
    const shown = selected(this.summaries, this.selection);
    this.body.replaceChildren(...shown.map(row));
    if (shown.length === 0) {
      this.body.append(h('tr', { class: 'empty' },
        h('td', { colspan: String(kColumns.length) }, 'No scene matches.')));
    }
    this.head.replaceChildren(...kColumns.map((column) => this.headCell(column)));
    this.count.textContent = shown.length === this.summaries.length
      ? `${shown.length} scenes` : `${shown.length} of ${this.summaries.length} scenes`;
    for (const [verdict, tile] of this.tiles) {
      tile.setAttribute('aria-pressed', String(this.selection.verdicts.has(verdict)));
    }
  }

  private headCell({ key, title, classes }: (typeof kColumns)[number]): HTMLElement {
    const cell = h('th', { scope: 'col', class: classes });
    if (key === null) {
      cell.append(title);
    } else {
      cell.append(h('button', { type: 'button', class: 'sort', click: () => {
        this.sortBy(key);
        // The heads are made anew; the one in use keeps the focus.
        const heads = [...this.head.querySelectorAll('button')];
        heads.find((head) => head.textContent === title)?.focus();
      } }, title));
      if (key === this.selection.key) {
        cell.setAttribute('aria-sort', this.selection.descending ? 'descending' : 'ascending');
      }
    }
    if (classes === 'track-cell') cell.append(trackAxis());
    return cell;
  }
}
