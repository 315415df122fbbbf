// The frame over time: lines are the figures' slices, which add up to the totals; the chart switches and zooms.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { close, open } from './browser.mjs';
import { folder, report } from './program.mjs';

const made = report(folder(), 'courtyard', ['builtin:courtyard', '--size', '160x90']);
const { figures } = made;
const { timeline, units, frame, draws } = figures;
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
