// Pages in a real browser without a window. Whatever a page says on its console, and whatever it asks of a network, fails the test.
import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { browser as executable, packages } from './program.mjs';

// ctest counts a test that ends so as skipped.
if (!existsSync(executable ?? '')) {
  console.log('skipped: chromium is not installed; scripts/setup check installs it');
  process.exit(77);
}

const { chromium } = createRequire(join(packages, 'x.js'))('playwright-core');

let started = null;

export async function open(path, { width = 1280, height = 900, theme = 'light' } = {}) {
  started ??= await chromium.launch({ executablePath: executable, args: ['--no-sandbox', '--disable-gpu'] });
  const context = await started.newContext({ viewport: { width, height }, colorScheme: theme });
  const page = await context.newPage();
  const said = [];
  page.on('console', (message) => said.push(`${message.type()}: ${message.text()}`));
  page.on('pageerror', (error) => said.push(`error: ${error.stack}`));
  page.on('request', (request) => /^(file|data|blob):/.test(request.url()) || said.push(`request: ${request.url()}`));
  await page.goto(`file://${path}`);
  await page.waitForFunction(() => [...(window.quadrille?.charts.values() ?? [])].every((c) => c.instance || c.host.hidden || !c.host.isConnected) &&
    [...(window.quadrille?.tables.values() ?? [])].every((t) => t.table?.initialized));
  page.quiet = () => assert.deepEqual(said, []);
  page.done = async () => {
    page.quiet();
    await context.close();
  };
  return page;
}

export async function close() {
  await started?.close();
  started = null;
}

/** The exact number that an element shows. */
export const value = async (page, selector) => Number(await page.locator(selector).first().getAttribute('data-value'));

/** The cells of a plain table: of each row, the exact numbers or else the text. */
export const cells = (page, id) => page.evaluate((table) => [...document.querySelectorAll(`#${table} tbody tr`)].map((row) =>
  [...row.cells].map((cell) => {
    const exact = cell.querySelector('[data-value]');
    return exact ? Number(exact.dataset.value) : cell.textContent;
  })), id);

/** Data of a chart: by name of the series. */
export const series = (page, id) => page.evaluate((chart) => Object.fromEntries(
  window.quadrille.charts.get(chart).instance.getOption().series.map((s) => [s.name, s.data])), id);
