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
  await page.getByRole('link', { name: title, exact: true }).click();
  await page.getByRole('heading', { level: 1, name: title }).waitFor();
}

/** For each plot, how many of its pixels have exactly each of these colours. */
function pixelsOfColours(page: Page, colours: number[][]): Promise<number[][]> {
  return page.evaluate((wanted) => [...document.querySelectorAll('canvas')].map((canvas) => {
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
  args: ['--no-sandbox', '--disable-gpu', '--no-first-run', '--disable-background-networking',
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
