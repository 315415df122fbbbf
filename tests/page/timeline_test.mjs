// The frame over time: lines are the figures' slices, which add up to the totals; the chart switches and zooms.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { close, open } from './browser.mjs';
import { folder, report } from './program.mjs';

const made = report(folder(), 'courtyard', ['builtin:courtyard', '--size', '160x90']);
const { figures } = made;
const { timeline, units, frame, draws } = figures;
const lengthOf = (s) => (s + 1 < timeline.slices ? timeline.slice_cycles : frame.moving_cycles - s * timeline.slice_cycles);
const kindOf = (path) => path.replace(/_\d+$/, '');

after(close);

const option = (page) => page.evaluate(() => {
  const { series, dataZoom } = window.quadrille.charts.get('timeline-chart').instance.getOption();
  return { series: series.map(({ name, data }) => ({ name, data })), zoom: dataZoom.map(({ start, end }) => [start, end]) };
});

test('slices add up to what each unit took of each resource', () => {
  const last = frame.cycles - timeline.slice_cycles * (timeline.slices - 1);
  const key = { rate: 'least_cycles', loss: 'lost_cycles', places: 'full_cycles' };
  for (const [path, resources] of Object.entries(timeline.units)) {
    for (const [name, shares] of Object.entries(resources)) {
      assert.equal(shares.length, timeline.slices);
      const cycles = shares.reduce((all, share, s) => all + share * (s + 1 < timeline.slices ? timeline.slice_cycles : last), 0);
      const own = (cycles * units[path].cycles) / frame.cycles;
      const { kind, ...rest } = units[path].resources[name];
      const error = Math.abs(own - rest[key[kind]]);
      assert.ok(error <= 1e-4 * units[path].cycles, `${path}.${name}: ${own} is not ${rest[key[kind]]}`);
    }
  }
});

test('bytes of the slices are those of the clients and of the memory, to the byte', () => {
  const total = (counts) => counts.reduce((all, n) => all + n, 0);
  assert.deepEqual(Object.keys(timeline.bandwidth), Object.keys(figures.bandwidth));
  for (const [client, { read_bytes, write_bytes }] of Object.entries(timeline.bandwidth)) {
    assert.equal(read_bytes.length, timeline.slices);
    assert.equal(total(read_bytes), figures.bandwidth[client].read_bytes);
    assert.equal(total(write_bytes), figures.bandwidth[client].write_bytes);
  }
  const counted = (name) => total(Object.entries(units).filter(([path]) => kindOf(path) === 'memory').map(([, unit]) => unit.counters[name]));
  for (const [client, counts] of Object.entries(timeline.memory))
    assert.equal(total(counts), counted(client === 'write_back' ? 'write_bytes' : `read_bytes_${client}`), client);
  assert.equal(total(Object.values(timeline.memory).map(total)), frame.memory_bytes);
});

test('tokens of the slices are those that the links held', () => {
  for (const [name, tokens] of Object.entries(timeline.links)) {
    const { links, depth, held_cycles: held } = figures.links[name];
    const all = tokens.reduce((sum, mean, s) => sum + mean * lengthOf(s), 0) * links;
    assert.ok(Math.abs(all - held) <= 1e-4 * frame.moving_cycles * links, `${name}: ${all} is not ${held}`);
    assert.ok(tokens.every((mean) => mean >= 0 && mean <= depth), name);
  }
  for (const [name, { tokens }] of Object.entries(figures.links)) assert.equal(tokens > 0, name in timeline.links, name);
});

test('lines are means over the units of a kind, slice by slice, and end with the frame', async () => {
  const page = await open(made.page);
  const { series } = await option(page);
  const line = series.find(({ name }) => name === 'core.issue');
  const cores = Object.keys(timeline.units).filter((path) => kindOf(path) === 'core');
  for (let s = 0; s < timeline.slices; ++s) {
    const mean = cores.reduce((all, path) => all + timeline.units[path].issue[s], 0) / cores.length;
    assert.ok(Math.abs(line.data[s][1] - mean) < 1e-9);
    assert.equal(line.data[s][0], s * timeline.slice_cycles);
  }
  assert.equal(line.data.at(-1)[0], frame.cycles);
  const flight = series.at(-1).data;
  assert.equal(flight.at(-1)[1], 0);
  assert.ok(Math.max(...flight.map(([, n]) => n)) <= draws.length);
  await page.done();
});

test('the chart switches to places and zooms by keyboard and wheel', async () => {
  const page = await open(made.page);
  await page.locator('#timeline [role="radio"][data-value="places"]').click();
  const { series } = await option(page);
  const [first] = series;
  const [kind, resource] = first.name.split('.');
  assert.equal(units[Object.keys(units).find((path) => kindOf(path) === kind)].resources[resource].kind, 'places');
  const chart = page.locator('#timeline-chart');
  await chart.scrollIntoViewIfNeeded();
  const box = await chart.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + 150);
  await page.mouse.wheel(0, -400);
  await page.waitForFunction(() => {
    const [zoom] = window.quadrille.charts.get('timeline-chart').instance.getOption().dataZoom;
    return zoom.end - zoom.start < 100;
  });
  await page.done();
});

test('bytes are a stack of all clients, and links are filled as far as the figures say', async () => {
  const page = await open(made.page);
  const shown = async (view) => {
    await page.locator(`#timeline [role="radio"][data-value="${view}"]`).click();
    return (await option(page)).series.filter(({ name, data }) => name !== 'draws in flight' && data.length > 0);
  };
  const near = (a, b) => assert.ok(Math.abs(a - b) <= 1e-9 * Math.max(1, b), `${a} is not ${b}`);
  const [asked] = await shown('asked'); // drawn first: up to the sum of all
  for (let s = 0; s < timeline.slices; ++s) {
    const all = Object.values(timeline.bandwidth).reduce((sum, of) => sum + of.read_bytes[s] + of.write_bytes[s], 0);
    near(asked.data[s][1], all / lengthOf(s));
  }
  const [moved] = await shown('moved');
  for (let s = 0; s < timeline.slices; ++s)
    near(moved.data[s][1], Object.values(timeline.memory).reduce((sum, counts) => sum + counts[s], 0) / lengthOf(s));
  for (const { name, data } of await shown('links'))
    for (let s = 0; s < timeline.slices; ++s) near(data[s][1], timeline.links[name][s] / figures.links[name].depth);
  await page.done();
});
