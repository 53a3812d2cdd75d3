// One plot: uPlot with our styles. Plots over the same quantity share their cursor.

import uPlot from 'uplot';
import type { Clock } from './clock';
import { h } from './dom';
import { formatDecade, formatNumber, formatTicks } from './format';
import { isDark, lineStyle } from './palette';
import {
  drawable, lineName, linearLimits, logLimits, merged, plotNotes, rangeOf, valueAt,
} from './plot_data';
import type { Column, PlotData } from './plot_data';
import type { Plot, Series } from './report';

const kHeight = 250;
const kPrintSize = { width: 335, height: 165 };
const kFont = '12px system-ui, sans-serif';

function cssColour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** The row nearest to a position at which this line has a point, or a gap. */
function nearestPoint(column: Column, row: number): number {
  for (let away = 0; away < column.length; ++away) {
    for (const at of [row - away, row + away]) {
      if (column[at] !== undefined) return at;
    }
  }
  return row;
}

function axes(plot: Plot): uPlot.Axis[] {
  const common: uPlot.Axis = {
    font: kFont,
    labelFont: kFont,
    labelSize: 20,
    stroke: () => cssColour('--quiet'),
    grid: { stroke: () => cssColour('--grid'), width: 1 },
    ticks: { stroke: () => cssColour('--grid'), width: 1, size: 4 },
  };
  const linear: uPlot.Axis.DynamicValues = (_, ticks) =>
    formatTicks(ticks, Math.abs((ticks[1] ?? 1) - (ticks[0] ?? 0)) || 1);
  const decades: uPlot.Axis.DynamicValues = (_, ticks) =>
    ticks.map(formatDecade);
  return [
    { ...common, label: plot.x_label, size: 28, values: linear },
    {
      ...common,
      label: plot.y_label,
      size: (_, labels) => 16 + 7 * Math.max(3, ...(labels ?? []).map((label) => label.length)),
      ...(plot.log_y ? { values: decades, splits: decadeSplits, filter: (_, splits) => splits }
        : { values: linear }),
    },
  ];
}

/** At most some eight labelled decades, however many the axis spans. */
const decadeSplits: uPlot.Axis.Splits = (_u, _axis, low, high) => {
  const first = Math.ceil(Math.log10(low) - 1e-9);
  const last = Math.floor(Math.log10(high) + 1e-9);
  const step = Math.max(1, Math.ceil((last - first) / 7));
  const splits: number[] = [];
  for (let exponent = first; exponent <= last; exponent += step) splits.push(10 ** exponent);
  return splits;
};

interface DrawnLine {
  line: Series;
  /** How many lines of the same engine stand before it. */
  rank: number;
}

/** References lie under the other lines. */
function inDrawingOrder(lines: readonly Series[]): DrawnLine[] {
  const seen = new Map<string, number>();
  const drawn = lines.map((line) => {
    const rank = seen.get(line.engine) ?? 0;
    seen.set(line.engine, rank + 1);
    return { line, rank };
  });
  const isReference = ({ line }: DrawnLine) => line.engine === 'closed form';
  return [...drawn.filter(isReference), ...drawn.filter((one) => !isReference(one))];
}

/**
 * What the legend shows of a line under the cursor: nothing while there is none.
 * @param all the points of all lines, also those that a logarithmic axis cannot show
 */
function legendValue(all: PlotData, series: number, row: number | null | undefined): string {
  if (row === null || row === undefined) return '';
  const found = valueAt(all.x, all.columns[series] ?? [], row);
  if (found === null) return '–';
  return `${found.isPoint ? '' : '≈ '}${formatNumber(found.value, 5)}`;
}

const xValue: uPlot.Series.Value = (_, value: number | null) =>
  (value === null ? '' : formatNumber(value, 5));

function seriesOptions({ line, rank }: DrawnLine, all: PlotData): uPlot.Series {
  const style = lineStyle(line.engine, rank, false);
  return {
    label: lineName(line),
    stroke: () => lineStyle(line.engine, rank, isDark()).stroke,
    width: style.width,
    dash: style.dash,
    points: { show: line.x.length < 2 },
    // uPlot counts x as series 0.
    value: (chart, _, series) => legendValue(all, series - 1, chart.cursor.idx),
  };
}

/** A sample of the line for the legend, with its width and dash. */
function legendSample({ line, rank }: DrawnLine): SVGSVGElement {
  const style = lineStyle(line.engine, rank, isDark());
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('class', 'sample');
  svg.setAttribute('width', '34');
  svg.setAttribute('height', '10');
  svg.setAttribute('aria-hidden', 'true');
  const stroke = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  stroke.setAttribute('d', 'M0 5H34');
  stroke.setAttribute('stroke', style.stroke);
  stroke.setAttribute('stroke-width', String(style.width));
  stroke.setAttribute('stroke-dasharray', style.dash.join(' '));
  svg.append(stroke);
  return svg;
}

/** Puts the samples before the names in uPlot's legend; again when the colours change. */
function fillLegend(root: HTMLElement, lines: readonly DrawnLine[]): void {
  root.querySelectorAll('.u-legend .u-series').forEach((entry, i) => {
    const line = lines[i - 1];
    if (line) entry.querySelector('.u-marker')?.replaceChildren(legendSample(line));
  });
}

function limits(plot: Plot, columns: readonly Column[]): [number, number] {
  const range = rangeOf(columns) ?? [1, 10];
  return plot.log_y ? logLimits(...range) : linearLimits(...range);
}

function describe(plot: Plot): string {
  const lines = plot.series.map((line) => {
    const range = rangeOf([drawable(line.y, false)]);
    const words = range ? `from ${formatNumber(range[0])} to ${formatNumber(range[1])}` : 'nothing finite';
    return `${lineName(line)}: ${words}`;
  });
  return `${plot.title}: ${plot.y_label} over ${plot.x_label}. ${lines.join('; ')}.`;
}

/** A plot on the page. */
export interface PlotView {
  element: HTMLElement;
  /** Draw: once the element has its place, and so its width. */
  attach(): void;
  /** Stop listening and free the canvas. */
  detach(): void;
}

/** The line at the clock's time. */
class Playhead {
  private readonly line = h('div', { class: 'playhead' });

  constructor(private readonly chart: uPlot, private readonly clock: Clock) {
    chart.over.append(this.line);
    clock.listen(this, () => this.show());
    // Moving over the plot moves the time; pressing the button (to zoom) leaves it.
    chart.over.addEventListener('mousemove', (event) => {
      if (event.buttons === 0) clock.move(chart.posToVal(event.offsetX, 'x'), this);
      this.show();
    });
    this.show();
  }

  show(): void {
    const at = this.chart.valToPos(this.clock.time, 'x');
    const isInside = at >= 0 && at <= this.chart.over.clientWidth;
    this.line.style.display = isInside ? '' : 'none';
    this.line.style.transform = `translateX(${at}px)`;
  }

  remove(): void {
    this.clock.forget(this);
  }
}

/** @param clock what the plot's x is a time of, if it is one */
export function plotView(plot: Plot, clock: Clock | null = null): PlotView {
  const place = h('div', { class: 'canvas' });
  place.setAttribute('role', 'img');
  place.setAttribute('aria-label', describe(plot));
  const notes = plotNotes(plot);
  const element = h('figure', { class: 'plot' }, h('figcaption', {}, plot.title), place,
    notes.length > 0 ? h('ul', { class: 'plot-notes' }, ...notes.map((note) => h('li', {}, note))) : null);

  const lines = inDrawingOrder(plot.series);
  const columns = (log: boolean) =>
    merged(lines.map(({ line }) => ({ x: line.x, y: drawable(line.y, log) })));
  const all = columns(false);
  const data = plot.log_y ? columns(true) : all;
  if (rangeOf(data.columns) === null) {
    place.append(h('p', { class: 'nothing' }, 'Nothing to draw.'));
    return { element, attach: () => undefined, detach: () => undefined };
  }

  let chart: uPlot | null = null;
  let playhead: Playhead | null = null;
  const yLimits = limits(plot, data.columns);
  const print = matchMedia('print');
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const fit = () => {
    const size = print.matches ? kPrintSize : { width: place.clientWidth, height: kHeight };
    if (chart && size.width > 0 && (size.width !== chart.width || size.height !== chart.height)) {
      chart.setSize(size);
    }
  };
  const recolour = () => {
    fit();
    chart?.redraw(false, true);
    fillLegend(place, lines);
  };
  const resized = new ResizeObserver(fit);

  return {
    element,
    attach() {
      const syncKey = `x: ${plot.x_label}`;
      chart = new uPlot({
        width: Math.max(200, place.clientWidth),
        height: kHeight,
        scales: {
          x: { time: false },
          y: { distr: plot.log_y ? 3 : 1, range: () => yLimits },
        },
        axes: axes(plot),
        series: [{ label: plot.x_label, value: xValue }, ...lines.map((line) => seriesOptions(line, all))],
        legend: { markers: { width: 0 } },
        hooks: { setScale: [() => playhead?.show()], setSize: [() => playhead?.show()] },
        cursor: {
          sync: { key: syncKey, scales: ['x', null] },
          points: { size: 7 },
          dataIdx: (u, index, row) =>
            index === 0 ? row : nearestPoint(u.data[index] as Column, row),
        },
      }, [data.x, ...data.columns] as uPlot.AlignedData, place);
      fillLegend(place, lines);
      if (clock !== null) playhead = new Playhead(chart, clock);
      resized.observe(place);
      print.addEventListener('change', recolour);
      dark.addEventListener('change', recolour);
    },
    detach() {
      resized.disconnect();
      print.removeEventListener('change', recolour);
      dark.removeEventListener('change', recolour);
      playhead?.remove();
      playhead = null;
      chart?.destroy();
      chart = null;
    },
  };
}
