// The section on energy: its figures are the JSON's, with their ranges; what a user's own file says is what is charged.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { cells, close, open, series, value } from './browser.mjs';
import { folder, report, succeed } from './program.mjs';

const where = folder();
const made = report(where, 'glass', ['builtin:glass', '--size', '160x90', '--energy', '45nm']);
const { energy, draws } = made.figures;
const sum = (numbers) => numbers.reduce((a, b) => a + b, 0);
const near = (a, b) => assert.ok(Math.abs(a - b) <= 1e-9 * Math.max(1, Math.abs(b)), `${a} is not ${b}`);
const PARTS = ['low', 'typical', 'high'];

after(close);

test('units, draws and events add up to the total, low and high too', () => {
  for (const part of PARTS) {
    near(sum(Object.values(energy.units).map((r) => r[part])), energy.total[part]);
    near(sum(energy.events.map((e) => e.pj[part])), energy.total[part]);
    near(sum(energy.draws.map((r) => r[part])) + energy.outside_draws[part], energy.total[part]);
    near(sum(energy.area.parts.map((p) => p.um2[part])), energy.area.total[part]);
    for (const event of energy.events) near(event.pj[part], event.each[part] * event.count);
  }
  for (const { low, typical, high } of [energy.total, ...Object.values(energy.units), ...energy.draws]) assert.ok(low <= typical && typical <= high);
  assert.equal(energy.draws.length, draws.length);
});

test('counts of events are those of the units', () => {
  for (const { unit, counter, count } of energy.events) {
    const units = Object.entries(made.figures.units).filter(([path]) => path.replace(/_\d+$/, '') === unit);
    assert.equal(count, sum(units.map(([, u]) => u.counters[counter])), `${unit}.${counter}`);
  }
});

test('the page shows energy, area, parts and draws as the figures have them', async () => {
  const page = await open(made.page);
  near(await value(page, '#energy-total'), energy.total.typical);
  const shown = await series(page, 'energy-chart');
  const units = Object.values(energy.units);
  for (const [i, r] of units.entries()) {
    near(shown.typical[i], r.typical / 1e6);
    near(shown.low[i], r.low / 1e6);
    near(shown['low to high'][i], (r.high - r.low) / 1e6);
  }
  const rows = await cells(page, 'energy-parts');
  near(sum(rows.map((r) => r[6])), energy.total.typical);
  assert.equal(rows.length, energy.events.filter((e) => e.pj.high > 0).length);
  const source = page.locator('#energy-parts .term').first();
  await source.hover();
  assert.notEqual(await page.locator('#bubble').textContent(), '');

  const data = await page.evaluate(() => window.quadrille.tables.get('energy-draws').table.getData('active').map((r) => r.typical));
  assert.deepEqual(data, energy.draws.map((r) => r.typical).sort((a, b) => b - a));

  await page.locator('#energy [role="radio"][data-value="area"]').click();
  near(await value(page, '#energy-total'), energy.area.total.typical);
  near(sum((await cells(page, 'energy-parts')).map((r) => r[6])), energy.area.total.typical);
  await page.done();
});

test('a page without --energy has no such section', async () => {
  const plain = report(where, 'plain', ['builtin:triangle', '--size', '64x64']);
  assert.equal(plain.figures.energy, undefined);
  const page = await open(plain.page);
  assert.equal(await page.locator('#energy').count(), 0);
  await page.done();
});

test("a user's own file is charged, and shown with its words", () => {
  const file = join(where, 'own.toml');
  writeFileSync(file, `[constants.fragment]\nlow = 1\ntypical = 2\nhigh = 3\nunit = "pJ"\nsource = "<b>mine</b>"\n` +
    `[[event]]\nunit = "core"\ncounter = "fragments"\ncost = "fragment"\nwhat = "fragments"\n`);
  const own = JSON.parse(succeed(['render', 'builtin:triangle', '--size', '64x64', '-q', '--energy', file, '--stats', '-']));
  assert.deepEqual(own.energy.total, { low: own.frame.fragments_shaded, typical: 2 * own.frame.fragments_shaded, high: 3 * own.frame.fragments_shaded });
  assert.equal(own.energy.constants.fragment.source, '<b>mine</b>');
});
