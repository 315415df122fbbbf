// The page of a sweep: front, effects, indices and table are those of the sweep's own CSV, worked out here again; filters and choices work.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { close, open, series, value } from './browser.mjs';
import { folder, refused, succeed } from './program.mjs';

const where = folder();
const at = (name) => join(where, name);
const SWEEP = `
[[scene]]
file = "builtin:materials"
size = "48x27"
name = "<b>stuff</b>"
[[scene]]
file = "builtin:triangle"
size = "32x32"
[vary]
gpu.cores = [1, 2, 4]
core.simd_lanes = [8, 16, 32]
texture.cache_lines = [16, 64]
[[objective]]
name = "cycles"
unit = "cycle"
formula = "frame.cycles"
over = "sum"
noise = 0.02
[[objective]]
name = "area"
formula = "gpu.cores * (core.simd_lanes + texture.cache_lines / 16)"
at_most = 100
`;
writeFileSync(at('sweep.toml'), SWEEP);
succeed(['explore', 'sweep.toml', '--jobs', '2', '--csv', 'a.csv', '--report', 'a.html'], { cwd: where });

/** Machines of the CSV: values, and objectives over both scenes. */
function machines() {
  const [head, ...lines] = readFileSync(at('a.csv'), 'utf8').trim().split('\r\n').map((line) => line.split(','));
  const of = (line, name) => Number(line[head.indexOf(name)]);
  const names = ['gpu.cores', 'core.simd_lanes', 'texture.cache_lines'];
  const all = new Map();
  for (const line of lines) {
    const values = names.map((name) => of(line, name));
    const key = values.join(' ');
    const known = all.get(key) ?? { values, cycles: 0, area: of(line, 'area') };
    known.cycles += of(line, 'cycles');
    all.set(key, known);
  }
  return [...all.values()];
}
const all = machines();
const holding = all.filter((m) => m.area <= 100);
const better = (a, b) => a.cycles <= b.cycles && a.area <= b.area && (a.cycles < b.cycles || a.area < b.area);
const front = holding.filter((m) => !holding.some((other) => better(other, m)));
const mean = (list) => list.reduce((a, b) => a + b, 0) / list.length;

after(close);

test('cards, front and table are those of the CSV', async () => {
  assert.equal(all.length, 18);
  const page = await open(at('a.html'));
  assert.equal(await value(page, '#machines'), 18);
  assert.equal(await value(page, '#on-front'), front.length);
  assert.equal(await value(page, '#best-cycles'), Math.min(...holding.map((m) => m.cycles)));
  const shown = await series(page, 'front-chart');
  const pairs = (list) => list.map((m) => [m.cycles, m.area]).sort((a, b) => a[0] - b[0]);
  assert.deepEqual(shown.front.map((d) => d.value), pairs(front));
  assert.equal(shown['beyond a limit'].length, all.length - holding.length);
  const rows = await page.evaluate(() => window.quadrille.tables.get('machines-table').table.getData().map((r) => [r.v0, r.v1, r.v2, r.o0, r.o1, r.standing]));
  const near = (a, b) => Math.abs(a - b) <= 0.02 * Math.max(a, b);
  for (const m of all) {
    const row = rows.find((r) => r[0] === m.values[0] && r[1] === m.values[1] && r[2] === m.values[2]);
    assert.deepEqual(row.slice(3, 5), [m.cycles, m.area]);
    const equal = front.some((f) => near(f.cycles, m.cycles) && f.area === m.area);
    assert.equal(row[5], front.includes(m) ? 'front' : !holding.includes(m) ? 'beyond a limit' : equal ? 'equal to the front' : '');
  }
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 1280);
  await page.done();
});

test('main effects are means, and Sobol indices those of a table of all combinations', async () => {
  const page = await open(at('a.html'));
  const total = mean(all.map((m) => m.cycles));
  const variance = mean(all.map((m) => (m.cycles - total) ** 2));
  for (const [i, levels] of [[0, [1, 2, 4]], [1, [8, 16, 32]], [2, [16, 64]]]) {
    const means = levels.map((level) => mean(all.filter((m) => m.values[i] === level).map((m) => m.cycles)));
    const shown = await series(page, `effect-${i}`);
    means.forEach((m, k) => assert.ok(Math.abs(shown.mean[k] - m) < 1e-6 * m));
    const alone = mean(means.map((m) => (m - total) ** 2)) / variance;
    const indices = await series(page, 'indices-chart');
    assert.ok(Math.abs(indices.alone[i] - alone) < 0.01, `${indices.alone[i]} is not ${alone}`);
  }
  await page.selectOption('#effect-objective', '1');
  const area = (await series(page, 'effect-2')).mean;
  assert.ok(area[1] > area[0]);
  await page.done();
});

test('a filter along an axis holds for the front and the table', async () => {
  const page = await open(at('a.html'));
  await page.locator('#parallel-chart').scrollIntoViewIfNeeded();
  const [x, y] = await page.evaluate(() => {
    const { instance, host } = window.quadrille.charts.get('parallel-chart');
    const [left, top] = instance.getModel().getComponent('parallel').coordinateSystem.dataToPoint('2', 'dim0');
    const box = host.getBoundingClientRect();
    return [box.left + left, box.top + top];
  });
  await page.mouse.move(x, y - 12);
  await page.mouse.down();
  await page.mouse.move(x, y, { steps: 4 });
  await page.mouse.move(x, y + 12, { steps: 4 });
  await page.mouse.up();
  await page.waitForFunction(() => document.getElementById('passing').textContent === '6');
  assert.equal(await page.evaluate(() => window.quadrille.tables.get('machines-table').table.getDataCount('active')), 6);
  const shown = await series(page, 'front-chart');
  assert.equal(shown.front.length, front.filter((m) => m.values[0] === 2).length);
  await page.done();
});

test('a machine is shown with what it sets, its pictures and the command of its own report', async () => {
  const page = await open(at('a.html'), { theme: 'dark' });
  await page.locator('#machines-table .tabulator-row').first().locator('[tabulator-field="o0"]').click();
  const best = all.reduce((a, b) => (b.cycles < a.cycles ? b : a));
  assert.match(await page.locator('#chosen-name').textContent(), new RegExp(`gpu.cores=${best.values[0]}`));
  const sizes = await page.locator('#chosen img').evaluateAll((images) => Promise.all(images.map((image) => image.decode().then(() => [image.naturalWidth, image.naturalHeight]))));
  assert.deepEqual(sizes, [[48, 27], [32, 32]]);
  assert.match(await page.locator('#chosen figcaption').first().textContent(), /<b>stuff<\/b>.*quadrille render builtin:materials --size 48x27 --machine default --set .*--report point\.html/);
  assert.equal(await page.locator('#chosen b').count(), 0);
  await page.done();
});

test('--report wants a page', () => {
  refused(['explore', at('sweep.toml'), '--report', 'a.txt'], /--report/);
});
