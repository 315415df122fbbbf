// Two frames beside each other: table, JSON and page say what the figures of both say, the largest difference first.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { cells, close, open, value } from './browser.mjs';
import { folder, refused, succeed } from './program.mjs';

const where = folder();
const at = (name) => join(where, name);

function figures(name, args) {
  succeed(['render', 'builtin:courtyard', '--size', '160x96', '-q', '--detail', 'draws,tiles,path', '--stats', at(name), ...args]);
  return JSON.parse(readFileSync(at(name), 'utf8'));
}

const a = figures('a.json', []);
const b = figures('b.json', ['--set', 'gpu.cores=8']);
const table = succeed(['compare', at('a.json'), at('b.json'), '--report', at('c.html'), '--json', at('c.json')]);
const c = JSON.parse(readFileSync(at('c.json'), 'utf8'));
const sum = (numbers) => numbers.reduce((x, y) => x + y, 0);
const falls = (list) => list.every((n, i) => i === 0 || Math.abs(list[i - 1]) >= Math.abs(n));

after(close);

test('differences are those of the two files', () => {
  assert.deepEqual(c.parameters, [{ path: 'gpu.cores', a: 4, b: 8 }]);
  for (const [key, pair] of Object.entries(c.frame)) assert.deepEqual([pair.a, pair.b], [a.frame[key], b.frame[key]]);
  const units = (d, kind) => Object.entries(d.units).filter(([path]) => path.replace(/_\d+$/, '') === kind).map(([, u]) => u);
  for (const unit of c.units) {
    assert.equal(unit.units.b, units(b, unit.kind).length);
    assert.equal(unit.own.a, unit.busy.a + unit.waiting.a);
    assert.equal(unit.starved.b, Math.round(sum(units(b, unit.kind).map((u) => u.starved)) / unit.units.b));
  }
  for (const entry of c.counters) assert.equal(entry.b, sum(units(b, entry.kind).map((u) => u.counters[entry.name] ?? 0)));
  const near = (x, y) => assert.ok(Math.abs(x - y) < 0.01, `${x} is not ${y}`);
  near(sum(c.critical_path.map((p) => p.cycles.difference)), b.frame.cycles - a.frame.cycles);
  for (const { of, part, by, cycles } of c.critical_path)
    near(cycles.b, sum(b.critical_path.parts.filter((p) => p.of === of && p.part === part && p.by === by).map((p) => p.cycles)));
  assert.equal(c.draws.length, a.draws.length);
  for (const draw of c.draws) {
    assert.equal(draw.cycles.a, a.draws[draw.number.a].cycles_in_flight);
    assert.equal(draw.cycles.difference, b.draws[draw.number.b].cycles_in_flight - a.draws[draw.number.a].cycles_in_flight);
  }
  for (const [key, { total, squares }] of Object.entries(c.tiles.counts)) {
    assert.equal(total.b, sum(b.tiles[key]));
    assert.deepEqual(squares, b.tiles[key].map((n, i) => n - a.tiles[key][i]));
  }
});

test('the largest comes first, and the table begins with the parameters', () => {
  assert.ok(falls(c.units.map((u) => u.own.difference)));
  assert.ok(falls(c.critical_path.map((p) => p.cycles.difference)));
  assert.ok(falls(c.draws.map((d) => d.cycles.difference)));
  assert.ok(falls(c.bandwidth.map((x) => x.bytes.difference)));
  assert.match(table, /PARAMETERS that differ[^\n]*\n  gpu\.cores +4 +8\n/);
  assert.ok(table.indexOf('PARAMETERS') < table.indexOf('FRAME') && table.indexOf('FRAME') < table.indexOf('UNITS'));
  assert.ok(table.includes(a.frame.cycles.toLocaleString('en-GB')));
  assert.ok(table.split('\n').every((line) => line.length <= 140 || line.startsWith('  limit of')));
});

test('a frame compared with itself differs in nothing', () => {
  const same = JSON.parse(succeed(['compare', at('a.json'), at('a.json'), '-q', '--json', '-']));
  assert.deepEqual([same.parameters, same.counters], [[], []]);
  for (const pair of Object.values(same.frame)) assert.equal(pair.difference, 0);
});

test('draws of another frame are paired by label, and those of one alone are kept', () => {
  const other = structuredClone(b);
  const [gone] = other.draws.splice(1, 1);
  other.draws.push({ ...gone, label: 'one more' });
  writeFileSync(at('other.json'), JSON.stringify(other));
  const { draws } = JSON.parse(succeed(['compare', at('a.json'), at('other.json'), '-q', '--json', '-']));
  assert.equal(draws.length, a.draws.length + 1);
  assert.deepEqual(draws.filter((d) => d.number.b === null).map((d) => d.number.a), [a.draws.findLastIndex((d) => d.label === gone.label)]);
  assert.equal(draws.find((d) => d.label === 'one more').cycles.a, 0);
});

test('the page shows the same', async () => {
  const page = await open(at('c.html'));
  assert.equal((await cells(page, 'path-table')).length, c.critical_path.length);
  assert.deepEqual(await page.evaluate(() => window.quadrille.comparison), c);
  assert.equal(await value(page, '#cycles'), b.frame.cycles - a.frame.cycles);
  assert.deepEqual((await cells(page, 'units-table')).map((r) => r[2]), c.units.map((u) => u.own.difference));
  assert.deepEqual((await cells(page, 'parameters-table')), [['gpu.cores', '4', '8']]);
  assert.equal(await page.evaluate(() => window.quadrille.tables.get('draws-table').table.getDataCount()), c.draws.length);
  await page.locator('#tiles [role="radio"][data-value="bytes"]').click();
  assert.deepEqual(await page.evaluate(() => window.quadrille.charts.get('tiles-chart').instance.getOption().series[0].data.map((d) => d[2])), c.tiles.counts.bytes.squares);
  await page.locator('#theme').click();
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 1280);
  await page.done();
});

test('what is no document of figures is refused in a line with file and place', () => {
  const damaged = (name, text) => {
    writeFileSync(at(name), text);
    return ['compare', at('a.json'), at(name)];
  };
  const changed = (name, change) => {
    const copy = structuredClone(a);
    change(copy);
    return damaged(name, JSON.stringify(copy));
  };
  refused(['compare', at('a.json'), at('none.json')], /none\.json/);
  refused(damaged('cut.json', JSON.stringify(a, null, 1).slice(0, 300)), /cut\.json:\d+:\d+: this is not JSON/);
  refused(damaged('empty.json', ''), /empty\.json/);
  refused(damaged('deep.json', '['.repeat(100000)), /deep\.json:1:\d+: this is not JSON/);
  refused(changed('frames.json', (d) => { d.schema = 'quadrille-frames-1'; }), /frames\.json: schema: "quadrille-frames-1" instead of "quadrille-figures-1"/);
  refused(changed('no.json', (d) => { delete d.units.core_0.busy; }), /no\.json: units\.core_0\.busy: missing/);
  refused(changed('kind.json', (d) => { d.draws[2].cycles_in_flight = 'x\ny'; }), /kind\.json: draws\[2\]\.cycles_in_flight: string instead of a number/);
  refused(changed('squares.json', (d) => { d.tiles.bytes.pop(); }), /squares\.json: tiles\.bytes: \d+ squares instead of \d+/);
  refused(changed('functional.json', (d) => { d.frame.cycles = null; }), /functional\.json: frame\.cycles: null/);
  refused(['compare', at('a.json'), at('b.json'), '--report', at('x.txt')], /--report: .*has to end in \.html/);
  refused(['compare', at('a.json'), at('b.json'), '--json', at('a.json')], /A and --json: both name/);
});
