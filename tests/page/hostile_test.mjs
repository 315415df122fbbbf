// Names come from files that others made: the page shows them as text, whatever they hold.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { close, open } from './browser.mjs';
import { folder, report } from './program.mjs';

const name = '</script><script>window.hit=1</script><img src=x onerror="window.hit=1">\u2028\u2029 <!-- & \' " \\ \u0001';

/** A triangle whose mesh has that name. */
function scene(where, file) {
  const positions = Buffer.from(new Float32Array([-1, -1, 0, 1, -1, 0, 0, 1, 0]).buffer).toString('base64');
  const gltf = {
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0], name }], nodes: [{ mesh: 0, name }],
    meshes: [{ name, primitives: [{ attributes: { POSITION: 0 }, material: 0 }] }], materials: [{ name }],
    buffers: [{ uri: `data:application/octet-stream;base64,${positions}`, byteLength: 36 }], bufferViews: [{ buffer: 0, byteLength: 36 }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: 'VEC3', min: [-1, -1, 0], max: [1, 1, 0] }],
  };
  const path = join(where, file);
  writeFileSync(path, JSON.stringify(gltf));
  return path;
}

after(close);

test('names that look like HTML, scripts or line ends stay text', async () => {
  const where = folder();
  const made = report(where, 'hostile', [scene(where, '<img src=x onerror="window.hit=1"> &amp;.gltf'), '--size', '64x48']);
  assert.ok(made.figures.draws[0].label.includes('<img'));
  const page = await open(made.page);
  assert.equal(await page.evaluate(() => window.hit), undefined);
  assert.equal(await page.locator('img').count(), 1);
  assert.deepEqual(await page.evaluate(() => window.quadrille.figures), made.figures);
  assert.match(await page.locator('h1').textContent(), /^<img src=x/);
  assert.match(await page.title(), /<img src=x onerror="window.hit=1"> &amp;\.gltf - Quadrille$/);
  const label = page.locator('#draws-table [tabulator-field="label"] span').first();
  assert.ok((await page.locator('#draws-table .tabulator-row [tabulator-field="label"]').first().textContent()).includes('</script><script>'));
  await label.hover();
  await page.evaluate(() => {
    for (const { instance } of window.quadrille.charts.values()) instance?.dispatchAction({ type: 'showTip', seriesIndex: 0, dataIndex: 0 });
  });
  assert.ok((await page.locator('#draw-name').textContent()).includes('</script>'));
  assert.equal(await page.evaluate(() => window.hit), undefined);
  await page.done();
});
