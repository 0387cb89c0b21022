// node report_page.mjs NODE_MODULES REPORT.html OUT_DIR: opens a report in headless Chromium and fails, saying why, unless it
// makes no request, tells the console nothing, and its filters and its 3-D view work. Screenshots go to OUT_DIR.
import { mkdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [modules, page_path, out] = process.argv.slice(2);
const { chromium } = createRequire(join(resolve(modules), 'x.js'))('playwright-core');
mkdirSync(out, { recursive: true });

const failures = [];
function expect(holds, what) {
  if (!holds) failures.push(what);
}

const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
});

async function open(options, flags = {}) {
  const context = await browser.newContext({ reducedMotion: 'reduce', ...options });
  const page = await context.newPage();
  page.on('console', (message) => { if (message.type() === 'error' || message.type() === 'warning') told(message.text()); });
  page.on('pageerror', (error) => failures.push(`script: ${error.stack}`));
  page.on('dialog', (dialog) => { failures.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url()) || (request.url().startsWith('file:') && !request.url().endsWith('.html')))
      failures.push(`request: ${request.url()}`);
  });
  await page.goto(pathToFileURL(resolve(page_path)).href);
  if (!flags.withoutScript) await page.waitForFunction(() => document.documentElement.dataset.ready !== undefined, null, { timeout: 20000 }).catch(() => failures.push('the script did not come to its end'));
  return page;
}

// What the driver says of its own speed isn't the page's.
function told(text) {
  if (!/GL Driver Message|GPU stall|WebGL.*(performance|ReadPixels)/i.test(text)) failures.push(`console: ${text}`);
}

async function expectNoSidewaysScroll(page, name) {
  const [wide, seen] = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.clientWidth]);
  expect(wide <= seen, `${name}: the page is ${wide} px wide, ${seen} are seen`);
}

// The 3-D view's pixels: how many of each colour.
async function coloursOfView(page) {
  return page.evaluate(() => {
    const canvas = document.querySelector('#model canvas');
    const copy = document.createElement('canvas');
    copy.width = canvas.width;
    copy.height = canvas.height;
    const context = copy.getContext('2d');
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    const colours = {};
    for (let i = 0; i < data.length; i += 4) {
      const colour = (data[i] << 16) | (data[i + 1] << 8) | data[i + 2];
      colours[colour] = (colours[colour] ?? 0) + 1;
    }
    return colours;
  });
}

async function tryView(page) {
  expect(await page.evaluate(() => document.documentElement.dataset.ready) === 'with-model', 'the page has a 3-D view');
  const before = await coloursOfView(page);
  expect(Object.keys(before).length > 3, 'the 3-D view shows more than its background');
  // Without parts, hull, points and balls only the grid is left: most of what is seen has another colour then.
  const boxes = page.locator('form.switches input');
  for (let i = 0; i < await boxes.count(); ++i) await boxes.nth(i).uncheck();
  const without = await coloursOfView(page);
  const changed = Object.entries(before).reduce((sum, [colour, pixels]) => sum + Math.max(pixels - (without[colour] ?? 0), 0), 0);
  expect(changed > 100, `parts and hull cover pixels of the view: ${changed}`);
  for (let i = 0; i < await boxes.count(); ++i) await boxes.nth(i).check();
  const rows = page.locator('tr[data-touch]');
  const count = await rows.count();
  if (count === 0) return;
  const last = rows.nth(count - 1);
  const touch = await last.getAttribute('data-touch');
  await last.click();
  expect(await page.getAttribute('#model', 'data-selected') === touch, 'a row selects its touch in the view');
  expect(/selected/.test(await last.getAttribute('class') ?? ''), 'the selected row is marked');
  await page.locator('#model').scrollIntoViewIfNeeded();
  const [x, y] = await page.evaluate((i) => document.getElementById('model').positionOfTouch(i), Number(touch));
  await rows.first().evaluate((row) => row.click());
  await last.evaluate((row) => row.click());
  await page.mouse.click(x, y);
  expect(await page.getAttribute('#model', 'data-selected') !== null, 'a ball selects its touch');
  expect(await page.locator('tr.selected').count() === 1, 'one row is selected');
}

async function tryFilters(page) {
  const rows = page.locator('tr[data-touch]');
  const count = await rows.count();
  if (count === 0) return;
  const shown = () => page.locator('tr[data-touch]:not([hidden])').count();
  const part = await rows.first().getAttribute('data-part');
  await page.selectOption('form.filters select[name=part]', part);
  expect(await shown() === await page.locator(`tr[data-touch][data-part="${part}"]`).count(), 'the filter of parts shows its rows');
  await page.selectOption('form.filters select[name=part]', '');
  await page.selectOption('form.filters select[name=kind]', 'near');
  expect(await shown() === await page.locator('tr[data-kind=near]').count(), 'the filter of kinds shows near misses');
  await page.selectOption('form.filters select[name=kind]', '');
  await page.fill('form.filters input[name=text]', 'nothing is called this');
  expect(await shown() === 0, 'the filter of texts hides every row');
  await page.fill('form.filters input[name=text]', '');
  expect(await shown() === count, 'without filters every row is shown');
}

for (const colorScheme of ['light', 'dark']) {
  for (const width of [1200, 400]) {
    const page = await open({ colorScheme, viewport: { width, height: 900 } });
    await expectNoSidewaysScroll(page, `${width} px, ${colorScheme}`);
    if (await page.locator('#model').count() > 0) await tryView(page);
    await tryFilters(page);
    expect(await page.locator('figure.chart svg').count() === await page.locator('figure.chart').count(), 'each chart is drawn');
    await page.screenshot({ path: join(out, `${colorScheme}_${width}.png`), fullPage: true });
    await page.context().close();
  }
}
const still = await open({ javaScriptEnabled: false, viewport: { width: 1200, height: 900 } }, { withoutScript: true });
expect(await still.locator('figure.chart svg').count() === await still.locator('figure.chart').count(), 'each chart has its picture without a script');
await still.screenshot({ path: join(out, 'without_script.png'), fullPage: true });
await browser.close();
for (const failure of failures) console.error(failure);
process.exitCode = failures.length > 0 ? 1 : 0;
