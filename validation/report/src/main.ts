// Reads the data of the page and shows what the address asks for:
//   #/              the front page
//   #/scene/NAME    one scene
//   #/all           all of it, to print

import { h } from './dom';
import { Front } from './front';
import { onKeys } from './keyboard';
import type { Player } from './player';
import type { PlotView } from './plot';
import { decodeReport } from './report';
import type { Report } from './report';
import { sceneView } from './scene';
import { selected, summarised } from './verdict';
import type { SceneSummary, Selection } from './verdict';

class App {
  private readonly summaries: readonly SceneSummary[];
  private selection: Selection = { text: '', verdicts: new Set(), key: 'verdict', descending: true };
  private front: Front | null = null;
  private frontScroll = 0;
  private filterOnFront = false;
  private current: SceneSummary | null = null;
  private plots: PlotView[] = [];
  private player: Player | null = null;

  constructor(private readonly report: Report, private readonly root: HTMLElement) {
    this.summaries = summarised(report.scenes);
    addEventListener('hashchange', () => this.show());
    onKeys(() => this.player !== null, {
      '/': () => this.filter(),
      ArrowLeft: () => this.step(-1),
      ArrowRight: () => this.step(+1),
      Escape: () => { location.hash = '#/'; },
      ' ': () => this.player?.toggle(),
      ',': () => this.player?.stepFrame(-1),
      '.': () => this.player?.stepFrame(+1),
      '[': () => this.player?.changeSpeed(-1),
      ']': () => this.player?.changeSpeed(+1),
      Home: () => this.player?.seek(0),
      c: () => this.player?.flip('points'),
      f: () => this.player?.flip('forces'),
      v: () => this.player?.resetView(),
    });
    this.show();
  }

  private show(): void {
    if (this.front !== null) this.frontScroll = scrollY;
    for (const plot of this.plots) plot.detach();
    this.plots = [];
    this.player?.detach();
    this.player = null;
    this.front = null;
    this.current = this.summaries.find((one) => one.route === location.hash) ?? null;
    if (this.current !== null) this.showScene(this.current);
    else if (location.hash === '#/all') this.showAll();
    else this.showFront();
  }

  private showFront(): void {
    this.front = this.makeFront();
    this.root.replaceChildren(this.front.element);
    document.title = 'Signorini validation report';
    scrollTo(0, this.frontScroll);
    if (this.filterOnFront) this.front.focusFilter();
    this.filterOnFront = false;
  }

  private makeFront(): Front {
    return new Front(this.report, this.summaries, this.selection, (selection) => {
      this.selection = selection;
    });
  }

  private showScene(summary: SceneSummary): void {
    const view = sceneView(summary.scene, true);
    this.root.replaceChildren(this.navigation(summary), view.element);
    this.draw(view.plots);
    this.player = view.player;
    this.player?.attach();
    document.title = `${summary.scene.title} – Signorini validation report`;
    scrollTo(0, 0);
    view.element.querySelector('h1')?.focus({ preventScroll: true });
  }

  private showAll(): void {
    const views = this.summaries.map(({ scene }) => sceneView(scene, false));
    this.root.replaceChildren(h('nav', { class: 'bar screen-only' }, h('a', { href: '#/' }, '← Overview')),
      this.makeFront().element, ...views.map((view) => view.element));
    this.draw(views.flatMap((view) => view.plots));
    document.title = 'Signorini validation report, all scenes';
    scrollTo(0, 0);
  }

  private draw(plots: PlotView[]): void {
    this.plots = plots;
    for (const plot of plots) plot.attach();
  }

  /** The scenes in the order of the front table, as filtered there; all if this one is not in it. */
  private listed(current: SceneSummary | null): readonly SceneSummary[] {
    const shown = selected(this.summaries, this.selection);
    if (current === null || shown.includes(current)) return shown;
    return selected(this.summaries, { ...this.selection, text: '', verdicts: new Set() });
  }

  private navigation(summary: SceneSummary): HTMLElement {
    const list = this.listed(summary);
    const at = list.indexOf(summary);
    const link = (to: SceneSummary | undefined, text: string, classes: string) =>
      (to === undefined ? h('span', { class: `${classes} none` }, text)
        : h('a', { href: to.route, class: classes, title: to.scene.title }, text));
    return h('nav', { class: 'bar screen-only', 'aria-label': 'Scenes' },
      h('a', { href: '#/' }, '↑ Overview'),
      h('span', { class: 'steps' }, link(list[at - 1], '← Previous', 'previous'),
        h('span', { class: 'position' }, `${at + 1} of ${list.length}`),
        link(list[at + 1], 'Next →', 'next')));
  }

  private filter(): void {
    if (this.front !== null) {
      this.front.focusFilter();
    } else {
      this.filterOnFront = true;
      location.hash = '#/';
    }
  }

  private step(by: number): void {
    const list = this.listed(this.current);
    const at = this.current === null ? -1 : list.indexOf(this.current);
    const to = list[at === -1 && by < 0 ? list.length - 1 : at + by];
    if (to !== undefined) location.hash = to.route;
  }
}

function start(): void {
  const root = document.getElementById('app');
  const data = document.getElementById('report');
  if (root === null || data === null) return;
  try {
    new App(decodeReport(data.textContent ?? ''), root);
  } catch (error) {
    root.replaceChildren(h('h1', {}, 'This report cannot be shown'),
      h('p', {}, String(error)), h('p', {}, 'The same numbers are in report.md and report.json.'));
  }
}

start();
