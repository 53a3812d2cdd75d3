// node e2e.mjs CHROMIUM REPORT.html FOLDER: opens the sample report (tests/validation/sample_report.h)
// from the disk as a reader would, and leaves pictures of it in the folder.

import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import process from 'node:process';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';
import type { Browser, Page } from 'playwright-core';

const [browserPath, reportPath, pictures] = process.argv.slice(2);
if (!browserPath || !reportPath || !pictures) {
  console.error('usage: node e2e.mjs CHROMIUM REPORT.html FOLDER');
  process.exit(64);
}
mkdirSync(pictures, { recursive: true });

interface View {
  /** Another file than the sample report. */
  file?: string;
  width: number;
  dark?: boolean;
}

/** Opens the report; whatever is logged, thrown or requested beyond the file fails the test. */
async function withPage(browser: Browser, view: View, use: (page: Page) => Promise<void>): Promise<void> {
  const context = await browser.newContext({
    viewport: { width: view.width, height: 900 }, colorScheme: view.dark ? 'dark' : 'light',
  });
  const page = await context.newPage();
  const reportUrl = pathToFileURL(view.file ?? (reportPath as string)).href;
  const complaints: string[] = [];
  page.on('console', (message) => {
    if (message.type() === 'error' || message.type() === 'warning') complaints.push(message.text());
  });
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('request', (request) => {
    const url = request.url();
    if (url.split('#')[0] !== reportUrl && !url.startsWith('data:')) complaints.push(`requested ${url}`);
  });
  await page.goto(reportUrl);
  await use(page);
  await context.close();
  assert.deepEqual(complaints, []);
}

function picture(page: Page, name: string): Promise<Buffer> {
  return page.screenshot({ path: join(pictures as string, `${name}.png`), fullPage: true });
}

async function openScene(page: Page, title: string): Promise<void> {
  await page.locator('.scenes').getByRole('link', { name: title, exact: true }).click();
  await page.getByRole('heading', { level: 1, name: title }).waitFor();
}

/** For each plot, how many of its pixels have exactly each of these colours. */
function pixelsOfColours(page: Page, colours: number[][]): Promise<number[][]> {
  return page.evaluate((wanted) => [...document.querySelectorAll<HTMLCanvasElement>('.plot canvas')].map((canvas) => {
    const { data } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
    const counts = wanted.map(() => 0);
    for (let i = 0; i < data.length; i += 4) {
      wanted.forEach((colour, k) => {
        if (colour.every((part, c) => data[i + c] === part)) counts[k] = (counts[k] ?? 0) + 1;
      });
    }
    return counts;
  }), colours);
}

/** Nothing but tables that scroll by themselves may be wider than the window. */
async function assertNoSidewaysScroll(page: Page): Promise<void> {
  const [content, view] = await page.evaluate(() =>
    [document.documentElement.scrollWidth, document.documentElement.clientWidth] as const);
  assert.ok(content <= view, `content is ${content} px wide, the window ${view} px`);
}

async function sceneNames(page: Page): Promise<(string | null)[]> {
  const rows = await page.locator('.scenes tbody tr').all();
  return Promise.all(rows.map((row) => row.getAttribute('data-scene')));
}

async function frontPage(page: Page): Promise<void> {
  assert.equal(await page.locator('h1').textContent(), '1 of 16 scenes fails');
  assert.equal((await sceneNames(page)).length, 16);
  assert.equal((await sceneNames(page))[0], 'stack-of-5-boxes');
  await assertNoSidewaysScroll(page);
  await picture(page, 'front');

  await page.keyboard.press('/');
  await page.keyboard.type('ball drop');
  assert.deepEqual(await sceneNames(page),
    ['ball-drop-e0', 'ball-drop-e0.5', 'ball-drop-e0.9', 'ball-drop-e1']);
  await page.getByRole('button', { name: "Bullet's error" }).click();
  assert.equal((await sceneNames(page))[0], 'ball-drop-e1');
  await picture(page, 'front-filtered');

  await page.locator('#filter').fill('');
  await page.getByRole('button', { name: 'failed' }).click();
  assert.deepEqual(await sceneNames(page), ['stack-of-5-boxes']);
}

async function scenePage(page: Page): Promise<void> {
  await openScene(page, 'Ball dropped, e = 0.5');
  // Height, energy, penetration; ours penetrates by 0, which its logarithmic axis cannot show.
  const pixels = await pixelsOfColours(page, [[0x00, 0x72, 0xb2], [0xd5, 0x5e, 0x00]]);
  const isDrawn = pixels.map((counts) => counts.map((count) => count > 100));
  assert.deepEqual(isDrawn, [[true, true], [true, true], [false, true]], `pixels of ours, Bullet's: ${pixels.join('; ')}`);
  await assertNoSidewaysScroll(page);
  await picture(page, 'scene');

  // The cursor in one plot stands in all, and their legends show numbers there.
  const plots = page.locator('.u-over');
  await plots.first().hover({ position: { x: 120, y: 60 } });
  const values = await page.locator('.u-legend .u-series .u-value').allTextContents();
  assert.ok(values.length > 0 && values.filter((value) => /\d/.test(value)).length >= 6, values.join());
  await picture(page, 'scene-cursor');
}

/** How many different colours the 3D view shows, left and right half; 1 is an empty one. */
async function coloursOfStage(page: Page): Promise<[number, number]> {
  const shot = await page.locator('.stage canvas').screenshot();
  return page.evaluate(async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const canvas = document.createElement('canvas');
    canvas.width = image.width;
    canvas.height = image.height;
    const pen = canvas.getContext('2d', { willReadFrequently: true })!;
    pen.drawImage(image, 0, 0);
    const half = Math.floor(image.width / 2);
    const count = (from: number) => new Set(new Uint32Array(pen.getImageData(from, 0, half, image.height).data.buffer)).size;
    return [count(0), count(half)] as [number, number];
  }, shot.toString('base64'));
}

/** The time that the player shows, s. */
async function shownTime(page: Page): Promise<number> {
  return Number.parseFloat((await page.locator('.clock').innerText()));
}

async function playheadPlace(page: Page): Promise<number> {
  const box = await page.locator('.playhead').first().boundingBox();
  return box?.x ?? NaN;
}

async function playback(page: Page): Promise<void> {
  await openScene(page, 'Ball dropped, e = 0.5');
  const colours = await coloursOfStage(page);
  assert.ok(colours.every((count) => count > 20), `colours of the two halves: ${colours.join()}`);

  // The scrubber moves the line in the plots; moving over a plot moves the scrubber.
  const start = await playheadPlace(page);
  await page.locator('.scrubber').fill('2.5');
  assert.equal(await shownTime(page), 2.5);
  const middle = await playheadPlace(page);
  assert.ok(middle > start + 50, `the line in the plot stands at ${start}, then at ${middle}`);
  await picture(page, 'playback');
  const plot = page.locator('.u-over').first();
  const width = (await plot.boundingBox())?.width ?? 0;
  await plot.hover({ position: { x: 0.2 * width, y: 30 } });
  assert.ok(Math.abs((await shownTime(page)) - 1) < 0.15, `time over a fifth of the plot: ${await shownTime(page)}`);
  assert.ok(Math.abs(Number(await page.locator('.scrubber').inputValue()) - (await shownTime(page))) < 1e-3);

  // A frame is 1/30 s.
  await page.locator('.scrubber').fill('2');
  await page.locator('h1').click();
  await page.keyboard.press('.');
  assert.equal(await shownTime(page), 2.033);
  await page.keyboard.press(',');
  await page.keyboard.press(',');
  assert.equal(await shownTime(page), 1.967);

  // Playing moves time on; space stops it.
  await page.keyboard.press('Home');
  assert.equal(await shownTime(page), 0);
  await page.keyboard.press(' ');
  await page.waitForFunction(() => Number.parseFloat(document.querySelector('.clock')?.textContent ?? '0') > 0.2);
  await page.keyboard.press(' ');
  const stopped = await shownTime(page);
  await page.waitForTimeout(150);
  assert.equal(await shownTime(page), stopped);
  await page.keyboard.press(']');
  assert.equal(await page.locator('.controls select').inputValue(), '2');
  await page.keyboard.press('f');
  assert.equal(await page.getByLabel('Forces').isChecked(), false);

  // Dragging turns both views.
  const before = await page.locator('.stage canvas').screenshot();
  const box = (await page.locator('.stage canvas').boundingBox())!;
  await page.mouse.move(box.x + box.width / 4, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 4 + 80, box.y + box.height / 2 - 20, { steps: 4 });
  await page.mouse.up();
  assert.notDeepEqual(await page.locator('.stage canvas').screenshot(), before);
}

function base64(numbers: readonly number[]): string {
  return Buffer.from(Int16Array.from(numbers).buffer).toString('base64');
}

/** A thousand boxes and balls that dance, with a contact each, in both engines. */
function thousandBodies(): object {
  const count = 1000;
  const frames = 20;
  const track = (engine: string) => {
    const poses: number[] = [];
    const contacts: number[] = [];
    const pairs: number[] = [];
    for (let k = 0; k < frames; ++k) {
      for (let i = 0; i < count; ++i) {
        const angle = 0.2 * k + i;
        poses.push((i % 10) * 100, (Math.floor(i / 10) % 10) * 100, Math.floor(i / 100) * 100 + Math.round(20 * Math.sin(angle)),
          Math.round(32767 * Math.cos(angle / 2)), Math.round(32767 * Math.sin(angle / 2)), 0, 0);
        contacts.push((i % 10) * 100, (Math.floor(i / 10) % 10) * 100, Math.floor(i / 100) * 100 - 40, 0, 0, 1000);
        pairs.push(i + 1, 0);
      }
    }
    const axes = new Array<number>(3 * count);
    return { engine, time: Array.from({ length: frames }, (_, k) => k / 10),
      poses: { middle: axes.fill(0).slice(), step: axes.fill(0.01).slice(), data: base64(poses) },
      contacts: { count: new Array<number>(frames).fill(count), count_whole: new Array<number>(frames).fill(count),
        point_middle: [0, 0, 0], point_step: [0.01, 0.01, 0.01], force_step: 0.01, bodies: base64(pairs), data: base64(contacts) } };
  };
  const still = { position: [0, 0, 0], orientation: [1, 0, 0, 0] };
  const numbers = Array.from({ length: count }, (_, i) => i + 1);
  return {
    gravity: [0, 0, -9.8], surfaces: [],
    bodies: [{ name: 'ground', kind: 'fixed', ...still }, ...numbers.map((i) => ({ name: `body ${i}`, kind: 'dynamic', ...still }))],
    shapes: [{ name: 'ground', body: 0, kind: 'half_space', sizes: [], surface: null, ...still },
      ...numbers.map((i) => ({ name: 'shape', body: i, kind: i % 2 ? 'box' : 'sphere', sizes: i % 2 ? [0.4, 0.4, 0.4] : [0.4], surface: null, ...still }))],
    tracks: [track('signorini'), track('bullet')],
  };
}

/** A copy of the sample report whose first scene has another playback. */
function withPlayback(name: string, playback: object): string {
  const page = readFileSync(reportPath as string, 'utf8');
  const opening = '<script type="application/json" id="report">';
  const from = page.indexOf(opening) + opening.length;
  const to = page.indexOf('</script>', from);
  const report = JSON.parse(page.slice(from, to)) as { scenes: { playback: object }[] };
  report.scenes[0]!.playback = playback;
  const file = join(pictures as string, name);
  writeFileSync(file, page.slice(0, from) + JSON.stringify(report).replace(/</g, '\\u003c') + page.slice(to));
  return file;
}

/** Prints the script's thread time a frame: the page promises at most 8 ms. */
async function manyBodies(page: Page): Promise<void> {
  await page.locator('.scenes tbody th a').first().waitFor();
  await page.evaluate(() => { location.hash = `#/scene/${encodeURIComponent('ball-drop-e0')}`; });
  await page.locator('.stage canvas').waitFor();
  const session = await page.context().newCDPSession(page);
  await session.send('Performance.setTimeDomain' as 'Performance.enable', { timeDomain: 'threadTicks' });
  await session.send('Performance.enable');
  const script = async () => (await session.send('Performance.getMetrics')).metrics
    .find((metric) => metric.name === 'ScriptDuration')?.value ?? NaN;
  // Scrubbing: every input is one frame, drawn at once.
  const scrub = (steps: number) => page.evaluate((count) => {
    const slider = document.querySelector<HTMLInputElement>('.scrubber')!;
    for (let k = 0; k < count; ++k) {
      slider.value = String(1.9 * (k / count));
      slider.dispatchEvent(new Event('input'));
    }
  }, steps);
  await scrub(5);
  const frames = 40;
  const before = await script();
  await scrub(frames);
  const milliseconds = (1000 * ((await script()) - before)) / frames;
  assert.ok(milliseconds > 0 && (await shownTime(page)) > 1.8);
  console.log(`script time a frame, 1000 bodies in each of two views: ${milliseconds.toFixed(2)} ms`);
  await picture(page, 'thousand-bodies');
}

async function errorAgainstCost(page: Page): Promise<void> {
  assert.ok(await page.locator('.scatter .means path').count() >= 5);
  assert.ok(await page.locator('.losses tbody tr').count() >= 1);
  assert.match(await page.locator('.losses').innerText(), /Bullet, default/);
  await page.locator('.scatter').screenshot({ path: join(pictures as string, 'scatter.png') });
  await page.locator('.scatter .points a').first().dispatchEvent('click');
  await page.locator('article').waitFor();
}

async function keyboard(page: Page): Promise<void> {
  const heading = () => page.locator('h1').innerText();
  await page.keyboard.press('ArrowRight');
  await page.getByRole('heading', { name: 'Stack of 5 boxes' }).waitFor();
  await page.keyboard.press('ArrowRight');
  await page.getByRole('heading', { name: 'Free flight' }).waitFor();
  await page.keyboard.press('ArrowLeft');
  await page.getByRole('heading', { name: 'Stack of 5 boxes' }).waitFor();
  assert.match(await heading(), /fail/);
  assert.equal(await page.locator('.checks tbody').first().locator('th').first().innerText()
    .then((text) => text.split('\n')[0]), 'deepest penetration');
  await picture(page, 'scene-failed');
  await page.keyboard.press('Escape');
  await page.getByRole('heading', { name: '1 of 16 scenes fails' }).waitFor();
  await openScene(page, 'Free flight');
  await page.keyboard.press('/');
  await page.waitForFunction(() => document.activeElement?.id === 'filter');
}

async function hostileTexts(page: Page): Promise<void> {
  await openScene(page, 'Texts with </script>, <!-- and | in them');
  assert.match(await page.locator('.description').innerText(), /<\/script><script>throw/);
  assert.equal(await page.locator('article img, article b').count(), 0);
}

async function manyLines(page: Page): Promise<void> {
  await openScene(page, "Newton's cradle, five touching balls");
  await picture(page, 'scene-cradle');
  await page.goBack();
  await openScene(page, 'Torque-free spin (Dzhanibekov)');
  await picture(page, 'scene-spin');
  await page.goBack();
  await openScene(page, 'The wedge: sequential against simultaneous impulses');
  await picture(page, 'scene-wedge');
}

async function everythingInOne(page: Page): Promise<void> {
  await page.getByRole('link', { name: 'All scenes on one page' }).click();
  await page.locator('article').nth(15).waitFor();
  assert.equal(await page.locator('article').count(), 16);
  await page.pdf({ path: join(pictures as string, 'all.pdf'), preferCSSPageSize: true });
}

async function printed(page: Page): Promise<void> {
  await page.emulateMedia({ media: 'print' });
  await page.setViewportSize({ width: 703, height: 900 });
  await picture(page, 'print-front');
  await page.emulateMedia({ media: 'screen' });
  await openScene(page, 'Ball dropped, e = 0.5');
  await page.emulateMedia({ media: 'print' });
  await picture(page, 'print-scene');
}

async function darkAndNarrow(page: Page): Promise<void> {
  await assertNoSidewaysScroll(page);
  await picture(page, `front-${page.viewportSize()?.width}-dark`);
  await openScene(page, 'Ball dropped, e = 0.5');
  await assertNoSidewaysScroll(page);
  await picture(page, `scene-${page.viewportSize()?.width}-dark`);
}

/** A copy of the sample report with one piece of its data changed. */
function changed(name: string, from: string, to: string): string {
  const parts = readFileSync(reportPath as string, 'utf8').split(from);
  assert.equal(parts.length, 2, `${from} stands in the report ${parts.length - 1} times`);
  const file = join(pictures as string, name);
  writeFileSync(file, parts.join(to));
  return file;
}

async function partial(page: Page): Promise<void> {
  assert.match(await page.getByRole('alert').innerText(), /Partial report/);
  await picture(page, 'front-partial');
}

async function otherSchema(page: Page): Promise<void> {
  assert.match(await page.locator('main').innerText(), /schema version 99, this page reads 1/);
}

const steps: [string, View, (page: Page) => Promise<void>][] = [
  ['front page, filter, sort', { width: 1280 }, frontPage],
  ['scene page, plots, shared cursor', { width: 1280 }, scenePage],
  ['3D playback', { width: 1280 }, playback],
  ['a thousand bodies', { width: 560, file: withPlayback('thousand.html', thousandBodies()) }, manyBodies],
  ['error against cost', { width: 1280 }, errorAgainstCost],
  ['keyboard', { width: 1280 }, keyboard],
  ['texts are only texts', { width: 1280 }, hostileTexts],
  ['plots of many lines', { width: 1280 }, manyLines],
  ['all scenes on one page, as PDF', { width: 1280 }, everythingInOne],
  ['print', { width: 1280 }, printed],
  ['a partial report says so', { width: 1080, file: changed('partial.html', '"partial":false', '"partial":true') }, partial],
  ['data of another version are refused',
    { width: 1080, file: changed('version.html', '"schema_version":1', '"schema_version":99') }, otherSchema],
  ['dark and wide', { width: 1600, dark: true }, darkAndNarrow],
  ['dark and narrow', { width: 800, dark: true }, darkAndNarrow],
];

// A browser of its own, with a new profile that is removed at the end.
const browser = await chromium.launch({
  executablePath: browserPath,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--no-first-run', '--disable-background-networking',
    '--disable-component-update', '--disable-sync', '--disable-dev-shm-usage'],
});
try {
  for (const [name, view, step] of steps) {
    await withPage(browser, view, step);
    console.log(`passed: ${name}`);
  }
} finally {
  await browser.close();
}
