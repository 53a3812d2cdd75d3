// The picture of the front page: error against cost, all solvers, all scenes. An SVG of our own.

import { h } from './dom';
import { formatDecade, formatDuration, formatNumber } from './format';
import { kSmallestError, stepText } from './trade';
import type { ScatterGroup, ScatterPoint } from './trade';

const kSvg = 'http://www.w3.org/2000/svg';
const kBox = { width: 860, height: 400, left: 62, right: 14, top: 14, bottom: 48 };

function svg(tag: string, attributes: Record<string, string | number>, ...children: (Node | string)[]): SVGElement {
  const element = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

/** Whole decades around the values. */
function decades(values: readonly number[]): [number, number] {
  const low = Math.floor(Math.log10(Math.min(...values)));
  return [low, Math.max(low + 1, Math.ceil(Math.log10(Math.max(...values)) + 1e-9))];
}

interface Axes {
  x: (value: number) => number;
  y: (value: number) => number;
  xDecades: [number, number];
  yDecades: [number, number];
}

function axesOf(groups: readonly ScatterGroup[]): Axes {
  const points = groups.flatMap((group) => group.points);
  const xDecades = decades(points.map((one) => one.cost));
  const yDecades = decades([kSmallestError, ...points.map((one) => one.error)]);
  const along = (value: number, [low, high]: [number, number], from: number, to: number) =>
    from + ((Math.log10(value) - low) / (high - low)) * (to - from);
  return {
    xDecades, yDecades,
    x: (value) => along(value, xDecades, kBox.left, kBox.width - kBox.right),
    y: (value) => along(value, yDecades, kBox.height - kBox.bottom, kBox.top),
  };
}

function grid(axes: Axes): SVGElement {
  const lines = svg('g', { class: 'grid' });
  const bottom = kBox.height - kBox.bottom;
  for (let e = axes.xDecades[0]; e <= axes.xDecades[1]; ++e) {
    const x = axes.x(10 ** e);
    lines.append(svg('path', { d: `M${x} ${kBox.top}V${bottom}` }),
      svg('text', { x, y: bottom + 17, 'text-anchor': 'middle' }, formatDecade(10 ** e)));
  }
  for (let e = axes.yDecades[0]; e <= axes.yDecades[1]; ++e) {
    const y = axes.y(10 ** e);
    lines.append(svg('path', { d: `M${kBox.left} ${y}H${kBox.width - kBox.right}` }),
      svg('text', { x: kBox.left - 7, y: y + 4, 'text-anchor': 'end' },
        `${e === axes.yDecades[0] ? '≤ ' : ''}${formatDecade(10 ** e)}`));
  }
  const middle = (kBox.top + bottom) / 2;
  lines.append(
    svg('text', { x: (kBox.left + kBox.width) / 2, y: kBox.height - 8, 'text-anchor': 'middle', class: 'label' },
      'cost: seconds of computing for one simulated second'),
    svg('text', { x: 14, y: middle, 'text-anchor': 'middle', class: 'label', transform: `rotate(-90 14 ${middle})` },
      'error / scale of the scene'));
  return lines;
}

/** Ours are discs, others' diamonds, squares, triangles; hollow at the finer step. */
function markPath(shape: number, size: number): string {
  switch (shape) {
    case 0: return `M${-size} 0A${size} ${size} 0 1 0 ${size} 0A${size} ${size} 0 1 0 ${-size} 0Z`;
    case 1: return `M0 ${-1.25 * size}L${1.25 * size} 0 0 ${1.25 * size} ${-1.25 * size} 0Z`;
    case 2: return `M${-size} ${-size}H${size}V${size}H${-size}Z`;
    default: return `M0 ${-1.2 * size}L${1.1 * size} ${0.8 * size}H${-1.1 * size}Z`;
  }
}

/** One shape a solver, Signorini's first ones are discs. */
function shapes(groups: readonly ScatterGroup[]): Map<string, number> {
  const result = new Map<string, number>();
  let next = 1;
  for (const { solver, engine } of groups) {
    if (!result.has(solver)) result.set(solver, engine === 'signorini' && ![...result.values()].includes(0) ? 0 : next++);
  }
  return result;
}

function mark(group: ScatterGroup, shape: number, size: number, x: number, y: number): SVGElement {
  const fill = group.stepShare === 1 ? 'full' : 'hollow';
  return svg('path', { class: `mark-${group.engine} ${fill}`, d: markPath(shape, size), transform: `translate(${x} ${y})` });
}

function pointText({ scene, point, error }: ScatterPoint): string {
  const { unit } = scene.trade ?? { unit: '' };
  return `${scene.title}\n${point.solver}, step ${formatNumber(point.step)} s\n`
    + `error ${formatNumber(point.error)} ${unit === '1' ? '' : unit} (${formatNumber(error)} of the scale)\n`
    + `whole run ${formatDuration(point.whole_seconds)}, in the solver ${formatDuration(point.solver_seconds)}`;
}

function legend(groups: readonly ScatterGroup[], shapeOf: Map<string, number>): HTMLElement {
  return h('ul', { class: 'scatter-legend' }, ...groups.map((group) => {
    const sample = document.createElementNS(kSvg, 'svg');
    sample.setAttribute('viewBox', '-9 -9 18 18');
    sample.setAttribute('class', 'scatter-key');
    sample.append(mark(group, shapeOf.get(group.solver) ?? 0, 6, 0, 0));
    return h('li', {}, sample, `${group.solver}, ${stepText(group.stepShare)}`);
  }));
}

/** @param routes address of each scene's page */
export function scatter(groups: readonly ScatterGroup[], routes: ReadonlyMap<object, string>): HTMLElement {
  const axes = axesOf(groups);
  const shapeOf = shapes(groups);
  const picture = svg('svg', { viewBox: `0 0 ${kBox.width} ${kBox.height}`, class: 'scatter', role: 'img',
    'aria-label': 'Error against cost of all solvers over all scenes' }, grid(axes));
  const small = svg('g', { class: 'points' });
  const large = svg('g', { class: 'means' });
  for (const group of groups) {
    const shape = shapeOf.get(group.solver) ?? 0;
    for (const one of group.points) {
      const drawn = mark(group, shape, 3.4, axes.x(one.cost), axes.y(one.error));
      drawn.append(svg('title', {}, pointText(one)));
      const link = svg('a', { href: routes.get(one.scene) ?? '#/', tabindex: -1 }, drawn);
      small.append(link);
    }
    const mean = mark(group, shape, 8.5, axes.x(group.meanCost), axes.y(group.meanError));
    mean.append(svg('title', {}, `${group.solver}, ${stepText(group.stepShare)}: geometric means of ${group.points.length} `
      + `scenes: error ${formatNumber(group.meanError)} of the scale, ${formatNumber(group.meanCost)} s a simulated second`));
    large.append(mean);
  }
  picture.append(small, large);
  return h('figure', { class: 'trade' }, h('div', { class: 'trade-body' }, picture, legend(groups, shapeOf)),
    h('figcaption', {}, 'Small marks: one scene each, at its own named error; large marks: geometric means over the scenes. '
      + `Lower is more accurate, further left is faster. Errors below ${formatDecade(kSmallestError)} of the scale stand at the bottom.`));
}
