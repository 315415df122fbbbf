// The page of several frames: its curve and table are the document's, the slowest frame is shown, and the table and film say the same.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { close, open, series, value } from './browser.mjs';
import { folder, refused, succeed } from './program.mjs';

const where = folder();
const at = (name) => join(where, name);
const FRAMES = 6;
succeed(['render', 'builtin:flag', '--size', '96x64', '--frames', String(FRAMES), '-q', '--report', at('f.html'), '--stats', at('f.json'), '--csv', at('f.csv')]);
const document_ = JSON.parse(readFileSync(at('f.json'), 'utf8'));
const { frames } = document_;

after(close);

test('curve, table and the slowest are those of the document', async () => {
  const page = await open(at('f.html'));
  const shown = await series(page, 'frames-chart');
  assert.deepEqual(shown.drawing, frames.map((f) => f.figures.frame.render_cycles));
  assert.deepEqual(shown['scan-out'], frames.map((f) => f.figures.frame.scan_out_cycles));
  const slowest = [...frames].sort((a, b) => b.figures.frame.cycles - a.figures.frame.cycles)[0];
  assert.equal(await page.locator('#slowest-list li').count(), 5);
  assert.match(await page.locator('#slowest-list li').first().textContent(), new RegExp(`^frame ${slowest.frame}: `));
  assert.match(await page.locator('#frame-name').textContent(), new RegExp(`^Frame ${slowest.frame}:`));
  const size = await page.locator('#frame-picture').evaluate((image) => image.decode().then(() => [image.naturalWidth, image.naturalHeight]));
  assert.deepEqual(size, [96, 64]);
  const rows = await page.evaluate(() => window.quadrille.tables.get('frames-table').table.getData('active').map((r) => [r.number, r.cycles, r.shaded, r.limit]));
  assert.deepEqual(rows, frames.map((f) => [f.frame, f.figures.frame.cycles, f.figures.frame.fragments_shaded, f.figures.limit.name]));
  await page.locator('#frames-table .tabulator-row').nth(2).locator('[tabulator-field="cycles"]').click();
  assert.match(await page.locator('#frame-name').textContent(), /^Frame 2:/);
  assert.equal(await value(page, '#overview .card .number'), FRAMES);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 1280);
  await page.done();
});

test('the table of --csv has a line a frame, with the figures of the document', () => {
  const lines = readFileSync(at('f.csv'), 'utf8').split('\r\n').slice(0, -1).map((line) => line.split(','));
  const [head, ...rows] = lines;
  assert.equal(rows.length, FRAMES);
  for (const [i, row] of rows.entries()) {
    assert.equal(row.length, head.length);
    const of = (name) => row[head.indexOf(name)];
    assert.equal(Number(of('frame')), i);
    assert.equal(Number(of('time_s')), frames[i].time_s);
    assert.equal(of('turn'), '');
    for (const [name, figure] of Object.entries(frames[i].figures.frame)) assert.equal(Number(of(name)), figure, name);
    assert.equal(Number(of('color_write_bytes')), frames[i].figures.bandwidth.color.write_bytes);
    assert.equal(of('limit'), frames[i].figures.limit.name);
  }
});

test('a turn around a scene has a page too, on which nothing is cut off', async () => {
  succeed(['render', 'builtin:cubes', '--size', '64x48', '--frames', '3', '-q', '--report', at('o.html')]);
  const page = await open(at('o.html'));
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 1280);
  assert.equal(await page.evaluate(() => window.quadrille.tables.get('frames-table').table.getDataCount()), 3);
  assert.match(await page.locator('#frame-name').textContent(), /^Frame \d: [\d.]+.% of the turn/);
  await page.done();
});

test('a film holds every frame, and is refused by name where ffmpeg is missing or fails', (t) => {
  const film = (name, env) => ['render', 'builtin:flag', '--size', '95x63', '--frames', '4', '--fidelity', 'functional', '-q', '--film', at(name), ...(env ?? [])];
  refused(film('x.mp4'), /--film: no ffmpeg is on the PATH/, { env: { ...process.env, PATH: where } });
  assert.equal(existsSync(at('x.mp4')), false);
  if (spawnSync('ffmpeg', ['-version']).status !== 0) return t.skip('ffmpeg is not installed');
  for (const name of ['flag.mp4', 'flag.gif']) {
    succeed(film(name));
    assert.ok(statSync(at(name)).size > 500);
    const probed = spawnSync('ffprobe', ['-v', 'error', '-count_frames', '-select_streams', 'v', '-show_entries', 'stream=nb_read_frames,r_frame_rate,width,height', '-of', 'json', at(name)], { encoding: 'utf8' });
    const [stream] = JSON.parse(probed.stdout).streams;
    assert.equal(Number(stream.nb_read_frames), 4);
    assert.equal(stream.r_frame_rate, '2/1'); // 4 frames over 2 s
    assert.deepEqual([stream.width, stream.height], name.endsWith('.gif') ? [95, 63] : [96, 64]);
  }
  const before = readFileSync(at('flag.gif'));
  succeed(film('flag.gif'));
  assert.deepEqual(readFileSync(at('flag.gif')), before);
});
