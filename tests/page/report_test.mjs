// The page of a frame: what it shows are the figures, and everything on it works by pointer and by keyboard.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { cells, close, open, series, value } from './browser.mjs';
import { folder, report } from './program.mjs';

const made = report(folder(), 'courtyard', ['builtin:courtyard', '--size', '330x180', '--set', 'l2.cache_lines=2048', '--set', 'gpu.cores=2']);
const { figures } = made;
const { frame, draws, tiles, units } = figures;
const sum = (numbers) => numbers.reduce((a, b) => a + b, 0);
const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-9 * Math.max(1, Math.abs(b)), `${a} is not ${b}`);

after(close);

test('the page holds exactly the figures, and asks nothing of a network', () => {
  const block = made.text.match(/<script type="application\/json" id="figures">(.*?)<\/script>/s)[1];
  assert.deepEqual(JSON.parse(block), figures);
  assert.equal(made.text.match(/<(?:link|img|script|iframe)[^>]*(?:src|href)="(?!data:)/), null);
  assert.ok(draws.length > 0 && tiles.fragments_shaded.length > 0);
});

test('the head line shows cycles, rate, limit and speed of light', async () => {
  const page = await open(made.page);
  assert.equal(await value(page, '#cycles'), frame.cycles);
  assert.equal(await page.locator('#cycles').textContent(), frame.cycles.toLocaleString('en-GB'));
  near(await value(page, '#frames-per-second'), frame.clock_mhz * 1e6 / frame.cycles);
  near(await value(page, '#least-cycles'), frame.least_cycles);
  near(await value(page, '#speed-of-light'), frame.least_cycles / frame.cycles);
  const [best] = Object.entries(figures.limit.gains).sort((a, b) => b[1] - a[1]);
  assert.equal(await page.locator('#limit').textContent(), best[1] >= 0.05 ? best[0] : figures.limit.name);
  assert.equal(await value(page, '#laws-held'), figures.checks.length);
  assert.equal((await cells(page, 'laws-table')).length, figures.checks.length);
  await page.done();
});

test('units: bars are the cycles of the figures, waits and counters those of the unit chosen', async () => {
  const page = await open(made.page);
  await page.getByRole('radio', { name: 'Every unit' }).click();
  const names = await page.locator('#unit option').allTextContents();
  assert.equal(names.length, Object.keys(units).length);
  const shown = await series(page, 'units-chart');
  for (const [i, name] of names.entries()) {
    const unit = units[name.replaceAll(' ', '_')];
    for (const state of ['busy', 'waiting', 'starved', 'blocked', 'idle']) near(shown[state][i], unit[state] / unit.cycles);
    near(shown.use[i], unit.use);
  }
  await page.locator('#unit').selectOption('depth 0');
  const counters = (await cells(page, 'unit-counters')).map(([, count]) => count);
  assert.deepEqual(counters, Object.values(units.depth_0.counters));
  assert.equal(sum((await cells(page, 'unit-waits')).map(([, cycles]) => cycles)), sum(Object.values(units.depth_0.waits)));
  const word = page.locator('#unit-counters .term').first();
  await word.hover();
  const [first] = Object.keys(units.depth_0.counters);
  assert.ok((await page.locator('#bubble').textContent()).startsWith(figures.counter_definitions.depth[first].definition));
  await page.done();
});

test('critical path: bars and rows are the figures, of the frame and of a draw', async () => {
  const page = await open(made.page);
  const { critical_path: whole } = figures;
  near(sum(whole.parts.map((part) => part.cycles)), frame.cycles);
  near(sum(whole.draws.map((draw) => draw.cycles)), frame.cycles);
  const check = async (path) => {
    const rows = await cells(page, 'path-parts');
    const shares = await series(page, 'path-chart');
    for (const [i, part] of ['busy', 'waiting', 'link'].entries()) {
      const cycles = sum(path.parts.filter((p) => p.part === part).map((p) => p.cycles));
      assert.ok(Math.abs(sum(rows.map((row) => row[i + 1])) - cycles) < 1e-6 * frame.cycles);
      const shown = sum(shares[part]) * path.cycles;
      assert.ok(shown <= cycles * (1 + 1e-9) && shown > cycles - 0.2 * path.cycles);
    }
  };
  await check(whole);
  const first = whole.draws.findIndex(({ draw }) => draw !== null);
  await page.locator('#path-of').selectOption({ index: 1 });
  await check(whole.draws[first]);
  assert.equal(Number((await page.locator('#path-cycles').textContent()).replace(/ cycles.*/, '').replaceAll(',', '')), Math.round(whole.draws[first].cycles));
  await page.done();
});

test('critical path: each draw has its own, which is its time in flight', async () => {
  for (const draw of draws) near(sum(Object.values(draw.path)), draw.cycles_in_flight);
  const page = await open(made.page);
  const at = Number((await page.locator('#draw-name').textContent()).split(':')[0]);
  const rows = await cells(page, 'draw-path');
  near(sum(rows.map(([, cycles]) => cycles)), draws[at].cycles_in_flight);
  assert.equal(rows.length, Object.values(draws[at].path).filter((cycles) => cycles > 0).length);
  await page.done();
});

test('draws: sums are those of the frame, and the table sorts, filters and tells of a draw', async () => {
  const page = await open(made.page);
  const table = (what) => page.evaluate(`window.quadrille.tables.get('draws-table').table.${what}`);
  const calcs = await table('getCalcResults()');
  assert.equal(calcs.bottom.triangles + figures.outside_draws.triangles.in, frame.triangles);
  assert.equal(calcs.bottom.shaded, frame.fragments_shaded);
  assert.equal(calcs.bottom.written, frame.fragments_written);
  assert.equal(calcs.bottom.vertices, frame.vertices);
  assert.equal(calcs.bottom.memory + figures.outside_draws.bytes.memory, frame.memory_bytes);

  await page.locator('#draws-table .tabulator-col-title', { hasText: /^shaded$/ }).click();
  const sorted = (await table("getData('active')")).map((row) => row.shaded);
  assert.deepEqual(sorted, draws.map((d) => d.fragments.shaded).sort((a, b) => b - a));

  await page.locator('#draws-table select[aria-label="limiter"]').selectOption('latency');
  const late = draws.filter((d) => d.limiter.kind === 'latency').length;
  assert.equal(await table("getDataCount('active')"), late);
  assert.match(await page.locator('#draws-shown').textContent(), new RegExp(`^${late} of ${draws.length} `));
  await page.getByRole('button', { name: 'Clear filters' }).click();
  assert.equal(await table("getDataCount('active')"), draws.length);

  await page.locator('#draws-table .tabulator-col[tabulator-field="label"] input').pressSequentially(draws[0].label.slice(0, 5));
  await page.waitForFunction((n) => window.quadrille.tables.get('draws-table').table.getDataCount('active') === n,
    draws.filter((d) => d.label.toLowerCase().includes(draws[0].label.slice(0, 5).toLowerCase())).length);
  await page.getByRole('button', { name: 'Clear filters' }).click();

  const row = page.locator('#draws-table .tabulator-row').nth(3);
  const at = Number(await row.locator('[tabulator-field="number"] [data-value]').getAttribute('data-value'));
  await row.locator('[tabulator-field="cycles"]').click();
  assert.equal(await page.locator('#draw-name').textContent(), `${at}: ${draws[at].label}`);
  const work = await cells(page, 'draw-work');
  assert.deepEqual(work.map((r) => r[1]).sort(), Object.values(draws[at].work).sort());
  await page.done();
});

test('heat maps: every map is the figures, and the square under pointer or keys is read out', async () => {
  const page = await open(made.page);
  const keys = Object.keys(tiles).filter((key) => Array.isArray(tiles[key]));
  assert.equal(keys.length, 8);
  for (const key of keys) {
    await page.locator(`#picture [role="radio"][data-value="${key}"]`).click();
    const shown = await page.evaluate(() => window.quadrille.charts.get('heat-map').instance.getOption().series[0].data);
    assert.deepEqual(shown.map(([, , count]) => count), tiles[key]);
    assert.equal(await value(page, '#map-total .number'), sum(tiles[key]));
    assert.equal(await value(page, '#map-most .number'), Math.max(...tiles[key]));
  }
  for (const [key, total] of [['fragments_shaded', frame.fragments_shaded], ['fragments_written', frame.fragments_written]])
    assert.equal(sum(tiles[key]) + tiles.outside_tiles[key], total);

  await page.locator('#picture [role="radio"][data-value="quad_efficiency"]').click();
  const parts = await page.evaluate(() => window.quadrille.charts.get('heat-map').instance.getOption().series[0].data);
  for (const [at, [, , part]] of parts.entries())
    if (tiles.quads[at] === 0) assert.equal(part, '-');
    else near(part, tiles.fragments_shaded[at] / (4 * tiles.quads[at]));
  near(await value(page, '#map-total .number'), sum(tiles.fragments_shaded) / (4 * sum(tiles.quads)));
  assert.equal(4 * (sum(tiles.quads) + tiles.outside_tiles.quads), frame.executed_lanes);
  const simds = sum(Object.entries(units).filter(([path]) => path.startsWith('core_')).map(([, u]) => u.counters.simd_busy));
  assert.equal(sum(tiles.simd_cycles) + tiles.outside_tiles.simd_cycles, simds);

  // The last square of a row reaches beyond the picture.
  const canvas = page.locator('#canvas');
  await canvas.scrollIntoViewIfNeeded();
  const box = await canvas.boundingBox();
  await page.mouse.move(box.x + box.width * (321 / 330), box.y + box.height * (40 / 180));
  const at = tiles.width + Math.floor(321 / 32);
  const read = () => page.evaluate(() => Object.fromEntries([...document.querySelectorAll('#readout [data-key]')].map((row) => [row.dataset.key, Number(row.querySelector('[data-value]').dataset.value)])));
  const held = (of) => ({ ...Object.fromEntries(keys.map((key) => [key, tiles[key][of]])), quad_efficiency: tiles.fragments_shaded[of] / (4 * tiles.quads[of]) });
  assert.deepEqual(await read(), held(at));
  await canvas.focus();
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('ArrowLeft');
  assert.deepEqual(await read(), held(at + tiles.width - 1));

  const here = () => page.locator('#draws-here').getAttribute('data-draws');
  const { squares } = await page.evaluate(() => ({ squares: window.quadrille.squares }));
  assert.equal(squares.length, tiles.width * tiles.height);
  assert.deepEqual(await here(), squares[at + tiles.width - 1].join(' '));
  await page.locator('#draws-here a').first().click();
  assert.match(await page.locator('#draw-name').textContent(), new RegExp(`^${squares[at + tiles.width - 1][0]}: `));

  await page.locator('#picture [role="radio"][data-value="depth"]').click();
  const size = await page.locator('#frame-picture').evaluate((image) => image.decode().then(() => [image.naturalWidth, image.naturalHeight]));
  assert.deepEqual(size, [330, 180]);
  await page.done();
});

test('a square with fragments has draws that cover it, and only those with covered fragments are named', async () => {
  const page = await open(made.page);
  const squares = await page.evaluate(() => window.quadrille.squares);
  for (const [at, here] of squares.entries()) {
    assert.ok(here.length > 0 || tiles.fragments_shaded[at] + tiles.fragments_killed_early[at] === 0, `square ${at}`);
    assert.deepEqual(here, [...new Set(here)].sort((a, b) => a - b));
  }
  const named = new Set(squares.flat());
  for (const [i, draw] of draws.entries()) if (draw.fragments.covered > 0) assert.ok(named.has(i), draw.label);
  await page.done();
});

test('bandwidth, caches and memory are the figures', async () => {
  const page = await open(made.page);
  const rows = await cells(page, 'bandwidth-table');
  const clients = Object.values(figures.bandwidth);
  assert.deepEqual(rows.slice(0, -1).map((r) => [r[1], r[2]]), clients.map((c) => [c.read_bytes, c.write_bytes]));
  assert.equal(rows.at(-1)[1] + rows.at(-1)[2], frame.memory_bytes);
  const l2 = (await cells(page, 'caches-table')).find(([name]) => name.startsWith('l2'));
  const slices = Object.entries(units).filter(([path]) => path.startsWith('l2_')).map(([, u]) => u.counters);
  assert.deepEqual(l2.slice(1, 5), ['requests', 'hits', 'merged', 'misses'].map((name) => sum(slices.map((c) => c[name]))));
  const { texture_misses: misses } = figures;
  const kinds = ['misses', 'compulsory', 'capacity', 'conflict'];
  const rowsOfKinds = await cells(page, 'miss-kinds');
  assert.deepEqual(rowsOfKinds[0].slice(1, 5), kinds.map((kind) => misses[kind]));
  assert.equal(sum(rowsOfKinds[0].slice(2, 5)), sum(Object.entries(units).filter(([path]) => path.startsWith('texture_')).map(([, u]) => u.counters.cache_misses)));
  assert.deepEqual(rowsOfKinds.slice(1).map((row) => row.slice(1, 5)), Object.values(misses.units).map((m) => kinds.map((kind) => m[kind])));
  const used = figures.textures.filter((t) => t.requests > 0);
  const rowsOfTextures = await cells(page, 'textures-table');
  assert.equal(rowsOfTextures.length, used.length);
  assert.equal(sum(used.map((t) => t.read_bytes)), sum(Object.entries(units).filter(([path]) => path.startsWith('texture_')).map(([, u]) => u.counters.read_bytes)));
  const bus = await series(page, 'bus-chart');
  const memory = units.memory_0.counters;
  const whole = sum(['read', 'write', 'refresh', 'turnaround', 'activation', 'spacing', 'idle'].map((part) => memory[`bus_${part}`]));
  near(bus['turn-around'][0], memory.bus_turnaround / whole);
  const latency = await cells(page, 'latency-table');
  const counted = (unit) => sum(Object.entries(unit.histograms).filter(([n]) => n.startsWith('latency_')).flatMap(([, x]) => x.buckets));
  assert.equal(sum(latency.map((r) => r[1])), sum(Object.entries(units).filter(([p]) => p.startsWith('memory_')).map(([, u]) => counted(u))));
  await page.done();
});

test('the diagram has every kind of unit of the plan, as full as its use, and leads to it', async () => {
  const page = await open(made.page);
  const boxes = await page.locator('#diagram .unit').evaluateAll((all) => all.map((box) => [box.dataset.kind, box.dataset.value]));
  assert.equal(boxes.length, 17);
  for (const [kind, use] of boxes) {
    const uses = Object.entries(units).filter(([path]) => path.replace(/_\d+$/, '') === kind).map(([, u]) => u.use);
    if (uses.length === 0) assert.equal(use, undefined);
    else near(Number(use), Math.max(...uses));
  }
  const lines = await page.locator('#diagram .link').count();
  await page.locator('#back-links').check();
  assert.ok(await page.locator('#diagram .link').count() > lines);
  await page.locator('#diagram [data-kind="rop"]').focus();
  await page.keyboard.press('Enter');
  assert.match(await page.locator('#unit option:checked').textContent(), /^rop/);
  await page.done();
});

test('parameters: those changed are marked and can be shown alone', async () => {
  const page = await open(made.page);
  const changed = Object.keys(figures.machine.changed);
  assert.deepEqual(changed.sort(), ['gpu.cores', 'l2.cache_lines']);
  assert.equal((await page.locator('#changed li').allTextContents()).length, 2);
  await page.getByRole('radio', { name: 'Changed (2)' }).click();
  const rows = await page.evaluate(() => window.quadrille.tables.get('parameters-table').table.getData('active').map((r) => r.path));
  assert.deepEqual(rows.sort(), changed.sort());
  await page.getByRole('radio', { name: /^All/ }).click();
  const all = await page.evaluate(() => window.quadrille.tables.get('parameters-table').table.getDataCount('active'));
  assert.equal(all, Object.keys(figures.machine.parameters).length);
  await page.done();
});

test('light and dark: the system decides, then the button or the key', async () => {
  const ground = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const dark = await open(made.page, { theme: 'dark' });
  assert.equal(await dark.evaluate(() => document.documentElement.dataset.theme), 'dark');
  const light = await open(made.page);
  assert.notEqual(await ground(dark), await ground(light));
  await light.locator('#theme').click();
  assert.equal(await ground(light), await ground(dark));
  await light.keyboard.press('t');
  assert.notEqual(await ground(light), await ground(dark));
  await light.done();
  await dark.done();
});

test('the keyboard alone reaches the figures, switches maps and reads definitions', async () => {
  const page = await open(made.page);
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.className), 'skip');
  await page.keyboard.press('Enter');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'content');
  const first = page.locator('#picture [role="radio"][aria-checked="true"]');
  await first.focus();
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowRight');
  assert.equal(await page.evaluate(() => document.activeElement.dataset.value), 'fragments_shaded');
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'canvas');
  await page.locator('#overview .term').first().focus();
  assert.equal(await page.locator('#bubble').isVisible(), true);
  await page.keyboard.press('Escape');
  assert.equal(await page.locator('#bubble').isVisible(), false);
  await page.done();
});

test('nothing is cut off at the width of a laptop or of a large screen', async () => {
  for (const width of [1280, 1920]) {
    const page = await open(made.page, { width });
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
    const empty = await page.evaluate(() => [...document.querySelectorAll('.chart')].filter((c) => c.id !== 'heat-map' && (c.clientWidth < 200 || c.clientHeight < 80)).map((c) => c.id));
    assert.deepEqual(empty, []);
    await page.done();
  }
});
