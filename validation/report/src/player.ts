// The 3D playback of a scene: the runs side by side, and what moves their time.

import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Clock } from './clock';
import { h, icon } from './dom';
import { formatNumber } from './format';
import { isDark } from './palette';
import { frameAtOrAfter, nearestFrame, unpack } from './playback';
import type { Playback, Track } from './playback';
import { engineName } from './plot_data';
import { Stage } from './stage';

const kSpeeds = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];
const kAspect = 0.74;
const kStill = { width: 1200, ratio: 1 };
/** After this long without a frame (a hidden tab) the playback goes on where it was, ms. */
const kLongestFrame = 250;

/** The time of the end of a playback, s. */
export function playbackEnd(playback: Playback): number {
  return Math.max(0, ...playback.tracks.map((track) => track.time[track.time.length - 1] ?? 0));
}

function tracksOf(playback: Playback): Track[] {
  return playback.tracks.map((track) => unpack(track, playback));
}

/** What the canvas cannot say. */
function captionOf(stage: Stage, tracks: readonly Track[]): string {
  const parts = stage.cell === null ? [] : [`Grid ${formatNumber(stage.cell)} m.`];
  if (stage.longestForce > 0) {
    parts.push(`Arrows: force on the moving body; the longest stand for ${formatNumber(stage.longestForce)} N or more.`);
  }
  const thinned = tracks.filter((track) => track.found.some((count, k) =>
    count > (track.firstContact[k + 1] ?? 0) - (track.firstContact[k] ?? 0)));
  if (thinned.length > 0) parts.push('Of many contacts the strongest are drawn.');
  return parts.join(' ');
}

function labels(tracks: readonly Track[]): HTMLElement {
  return h('div', { class: 'sides' }, ...tracks.map((track) =>
    h('span', { class: `side ${track.engine}` }, engineName(track.engine))));
}

function noWebGl(error: unknown): HTMLElement {
  return h('p', { class: 'nothing' }, `No 3D view: this browser has no WebGL (${String(error)}).`);
}

/** A picture of both runs at one time, as it is printed. @throws Error without WebGL */
function stillOf(stage: Stage, t: number, show: Shown): string {
  stage.setSize(kStill.width, Math.round((kStill.width / 2) * kAspect), kStill.ratio);
  stage.render(t, show, false);
  return stage.canvas.toDataURL('image/png');
}

interface Shown {
  points: boolean;
  forces: boolean;
}

/** The runs of a scene as one picture, at half time. */
export function stillFigure(playback: Playback): HTMLElement {
  const tracks = tracksOf(playback);
  try {
    const stage = new Stage(tracks, playback);
    stage.setSize(kStill.width, Math.round((kStill.width / 2) * kAspect), kStill.ratio);
    stage.resetView();
    const t = playbackEnd(playback) / 2;
    const picture = h('img', { src: stillOf(stage, t, { points: true, forces: true }), alt: `The runs at ${formatNumber(t)} s` });
    stage.dispose();
    return h('figure', { class: 'player' }, labels(tracks), picture,
      h('figcaption', {}, `At ${formatNumber(t)} s. ${captionOf(stage, tracks)}`));
  } catch (error) {
    return h('figure', { class: 'player' }, noWebGl(error));
  }
}

export class Player {
  readonly element: HTMLElement;
  private readonly tracks: Track[];
  private readonly stage: Stage | null = null;
  private controls: OrbitControls | null = null;
  private readonly show: Shown = { points: true, forces: true };
  private speed = 1;
  private isPlaying = false;
  private request = 0;
  private lastTick = 0;
  private readonly place = h('div', { class: 'stage' });
  private readonly still = h('img', { class: 'still', alt: '' });
  private readonly stillTime = h('span', { class: 'print-only' });
  private readonly playButton = h('button', { type: 'button', class: 'play', click: () => this.toggle() });
  private readonly slider: HTMLInputElement;
  private readonly clockText = h('output', { class: 'clock' });
  private readonly speedChoice = h('select', { 'aria-label': 'Speed', change: () => this.setSpeed(Number(this.speedChoice.value)) });
  private readonly toggles: Record<keyof Shown, HTMLInputElement>;
  private readonly resized = new ResizeObserver(() => this.fit());
  private readonly print = matchMedia('print');
  private readonly dark = matchMedia('(prefers-color-scheme: dark)');
  private readonly redrawn = () => (this.print.matches ? this.takeStill() : this.draw());

  constructor(playback: Playback, private readonly clock: Clock) {
    this.tracks = tracksOf(playback);
    this.slider = h('input', { type: 'range', min: '0', max: String(clock.end), step: 'any', value: '0',
      'aria-label': 'Time [s]', class: 'scrubber', input: () => this.seek(Number(this.slider.value)) });
    const toggle = (name: keyof Shown) => {
      const box = h('input', { type: 'checkbox', checked: true });
      box.addEventListener('change', () => { this.show[name] = box.checked; this.draw(); });
      return box;
    };
    this.toggles = { points: toggle('points'), forces: toggle('forces') };
    for (const speed of kSpeeds) this.speedChoice.append(new Option(`${speed} ×`, String(speed), false, speed === 1));
    let view: HTMLElement = this.place;
    try {
      this.stage = new Stage(this.tracks, playback);
    } catch (error) {
      view = noWebGl(error);
    }
    this.element = h('figure', { class: 'player', 'aria-label': '3D playback' }, labels(this.tracks), view, this.still,
      this.bar(), h('figcaption', {}, this.stillTime, this.stage === null ? '' : captionOf(this.stage, this.tracks)));
    this.showState();
  }

  private bar(): HTMLElement {
    const button = (face: string | Node, label: string, act: () => void) =>
      h('button', { type: 'button', title: label, 'aria-label': label, click: act }, face);
    return h('div', { class: 'controls screen-only' },
      button(icon('M3.5 3v10M12.5 3 6 8l6.5 5z', 'stroke'), 'To the start (Home)', () => this.seek(0)),
      button('−1', 'One frame back (,)', () => this.stepFrame(-1)), this.playButton,
      button('+1', 'One frame on (.)', () => this.stepFrame(+1)),
      this.slider, this.clockText, this.speedChoice,
      h('label', { title: 'c' }, this.toggles.points, 'Contacts'),
      h('label', { title: 'f' }, this.toggles.forces, 'Forces'),
      button('Reset view', 'Reset view (v)', () => this.resetView()));
  }

  /** Once the element has its place. */
  attach(): void {
    this.clock.listen(this, () => { this.pause(); this.showState(); this.draw(); });
    if (this.stage === null) return;
    const { canvas, camera, target } = this.stage;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', `${this.tracks.map((track) => engineName(track.engine)).join(' and ')} in 3D`);
    this.place.replaceChildren(canvas);
    this.fit();
    this.stage.resetView();
    this.controls = new OrbitControls(camera, canvas);
    this.controls.target.copy(target);
    this.controls.enableZoom = false; // the wheel belongs to the page until the view is touched
    this.controls.addEventListener('change', () => this.draw());
    canvas.addEventListener('pointerdown', this.takeWheel);
    canvas.addEventListener('pointerleave', this.leaveWheel);
    this.resized.observe(this.place);
    for (const media of [this.print, this.dark]) media.addEventListener('change', this.redrawn);
    addEventListener('beforeprint', this.takeStill);
    this.controls.update();
    this.draw();
  }

  detach(): void {
    this.pause();
    this.clock.forget(this);
    this.resized.disconnect();
    for (const media of [this.print, this.dark]) media.removeEventListener('change', this.redrawn);
    removeEventListener('beforeprint', this.takeStill);
    this.stage?.canvas.removeEventListener('pointerdown', this.takeWheel);
    this.stage?.canvas.removeEventListener('pointerleave', this.leaveWheel);
    this.controls?.dispose();
    this.controls = null;
    this.stage?.dispose();
  }

  toggle(): void {
    if (this.isPlaying) this.pause();
    else this.play();
  }

  /** To the next frame of the first run, or the one before. */
  stepFrame(by: 1 | -1): void {
    const time = this.tracks[0]?.time ?? [];
    const here = nearestFrame(time, this.clock.time);
    const isOn = Math.abs((time[here] ?? 0) - this.clock.time) < 1e-9;
    const before = isOn || (time[here] ?? 0) < this.clock.time ? here : here - 1;
    const to = by > 0 ? before + 1 : isOn ? here - 1 : before;
    this.seek(time[Math.max(0, Math.min(time.length - 1, to))] ?? 0);
  }

  /** Slower (-1) or faster (+1). */
  changeSpeed(by: 1 | -1): void {
    const at = kSpeeds.indexOf(this.speed);
    this.setSpeed(kSpeeds[Math.max(0, Math.min(kSpeeds.length - 1, at + by))] ?? 1);
  }

  flip(name: keyof Shown): void {
    this.toggles[name].click();
  }

  /** Stops there. */
  seek(t: number): void {
    this.pause();
    this.move(t);
  }

  resetView(): void {
    this.stage?.resetView();
    this.controls?.update();
    this.draw();
  }

  private readonly takeWheel = () => { if (this.controls !== null) this.controls.enableZoom = true; };
  private readonly leaveWheel = () => { if (this.controls !== null) this.controls.enableZoom = false; };

  private readonly takeStill = () => {
    if (this.stage === null) return;
    this.still.src = stillOf(this.stage, this.clock.time, this.show);
    this.still.alt = `The runs at ${formatNumber(this.clock.time)} s`;
    this.stillTime.textContent = `At ${formatNumber(this.clock.time)} s. `;
    this.fit();
  };

  private setSpeed(speed: number): void {
    this.speed = speed;
    this.speedChoice.value = String(speed);
  }

  private play(): void {
    if (this.clock.time >= this.clock.end) this.move(0);
    this.isPlaying = true;
    this.lastTick = performance.now();
    this.request = requestAnimationFrame(this.tick);
    this.showState();
  }

  private pause(): void {
    this.isPlaying = false;
    cancelAnimationFrame(this.request);
    this.showState();
  }

  private readonly tick = (now: number) => {
    if (!this.isPlaying) return;
    const elapsed = Math.min(kLongestFrame, Math.max(0, now - this.lastTick)) / 1000;
    this.lastTick = now;
    this.move(this.clock.time + this.speed * elapsed);
    if (this.clock.time >= this.clock.end) this.pause();
    else this.request = requestAnimationFrame(this.tick);
  };

  private move(t: number): void {
    this.clock.move(t, this);
    this.showState();
    this.draw();
  }

  private showState(): void {
    const t = this.clock.time;
    this.slider.value = String(t);
    const frame = frameAtOrAfter(this.tracks[0]?.time ?? [], t);
    this.clockText.textContent = `${t.toFixed(3)} s`;
    this.clockText.title = `frame ${frame + 1} of ${this.tracks[0]?.time.length ?? 0}`;
    const word = this.isPlaying ? 'Pause' : 'Play';
    if (this.playButton.textContent !== word) {
      this.playButton.textContent = word;
      this.playButton.title = `${word} (space)`;
    }
  }

  private fit(): void {
    const width = this.place.clientWidth;
    if (this.stage === null || width === 0) return;
    const parts = Math.max(1, this.tracks.length);
    const height = Math.max(180, Math.min(560, Math.round((width / Math.max(2, parts)) * kAspect)));
    this.place.style.height = `${height}px`;
    this.stage.setSize(width, height, Math.min(2, devicePixelRatio));
    this.draw();
  }

  private draw(): void {
    if (this.controls !== null) this.stage?.render(this.clock.time, this.show, isDark());
  }
}
