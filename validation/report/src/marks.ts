// The marks that mean something wherever they stand: verdicts, and error / tolerance on an axis.

import { h, icon } from './dom';
import { formatRatio } from './format';
import type { Verdict } from './report';

const kIcons: Record<Verdict, string> = {
  fail: 'M3.2 3.2 12.8 12.8M12.8 3.2 3.2 12.8',
  pass: 'M2.5 8.5 6.3 12.3 13.5 4.2',
  information: 'M8 14.5A6.5 6.5 0 1 0 8 1.5a6.5 6.5 0 0 0 0 13M8 7.4v3.8M8 4.6v.2',
};

const kWords: Record<Verdict, string> = { fail: 'fail', pass: 'pass', information: 'info' };

/** A verdict as symbol and word; colour only underlines them. */
export function verdictChip(verdict: Verdict): HTMLElement {
  return h('span', { class: `chip ${verdict}` }, icon(kIcons[verdict], 'stroke'), kWords[verdict]);
}

export function verdictIcon(verdict: Verdict): SVGSVGElement {
  return icon(kIcons[verdict], `stroke ${verdict}`);
}

/** The axis of all tracks: error / tolerance from 1e-4 to 1e4, the tolerance in the middle. */
const kDecades = 4;

/** Where a ratio stands on the axis, in percent; what lies beyond an end stands at the end. */
export function trackPosition(ratio: number): number {
  if (Number.isNaN(ratio)) return 100;
  const decades = Math.max(-kDecades, Math.min(kDecades, Math.log10(Math.max(ratio, 0))));
  return 50 + (50 * decades) / kDecades;
}

function isBeyond(ratio: number): '' | ' below' | ' above' {
  if (Number.isNaN(ratio) || ratio > 10 ** kDecades) return ' above';
  return ratio < 10 ** -kDecades ? ' below' : '';
}

export interface Mark {
  engine: 'signorini' | 'bullet';
  ratio: number;
}

/** The marks of one line on the axis. Ours is a disc, Bullet's a diamond, arrows lie beyond. */
export function ratioTrack(marks: readonly Mark[]): HTMLElement {
  const words = marks.map(({ engine, ratio }) =>
    `${engine === 'bullet' ? 'Bullet' : 'Signorini'}: error ${formatRatio(ratio)} the tolerance`);
  const track = h('div', { class: 'track', role: 'img', 'aria-label': words.join('; ') });
  track.title = words.join('\n');
  for (const { engine, ratio } of marks) {
    const mark = h('span', { class: `mark ${engine}${isBeyond(ratio)}` });
    mark.style.left = `${trackPosition(ratio)}%`;
    track.append(mark);
  }
  return track;
}

/** The numbers of the axis, to stand over a column of tracks. */
export function trackAxis(): HTMLElement {
  const axis = h('div', { class: 'track-axis', 'aria-hidden': 'true' });
  const labels: [number, string][] = [[1e-4, '10⁻⁴'], [1e-2, '10⁻²'], [1, '1'], [1e2, '10²'], [1e4, '10⁴']];
  for (const [ratio, text] of labels) {
    const label = h('span', {}, text);
    label.style.left = `${trackPosition(ratio)}%`;
    axis.append(label);
  }
  return axis;
}

/** What the marks of the tracks are. */
export function trackLegend(): HTMLElement {
  return h('p', { class: 'legend' },
    h('span', { class: 'key' }, h('span', { class: 'mark signorini' }), 'Signorini'),
    h('span', { class: 'key' }, h('span', { class: 'mark bullet' }), 'Bullet, same check'),
    h('span', { class: 'key' }, h('span', { class: 'tolerance-key' }), 'tolerance, and beyond it'),
    h('span', { class: 'key' }, h('span', { class: 'mark signorini above' }), 'off the axis (0, or NaN and ∞)'));
}
