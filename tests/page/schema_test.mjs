// Documents of figures hold what docs/figures.schema.json says, on runs of every kind; a changed document does not.
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { packages, root, succeed } from './program.mjs';

const Ajv = createRequire(join(packages, 'x.js'))('ajv/dist/2020');
const ajv = new Ajv({ strict: true, allowUnionTypes: true, allErrors: true });
const schema = JSON.parse(readFileSync(join(root, 'docs/figures.schema.json'), 'utf8'));
const valid = ajv.compile(schema);

const figures = (args) => JSON.parse(succeed(['render', '-q', '--size', '96x64', '--stats', '-', ...args]));
const holds = (document) => assert.ok(valid(document), ajv.errorsText(valid.errors));

const RUNS = {
  'a plain frame': ['builtin:triangle'],
  'draws, squares and slices': ['builtin:quad', '--detail', 'draws,tiles,timeline'],
  'the critical path, of the frame and by draw': ['builtin:cubes', '--detail', 'draws,path'],
  'kinds of misses': ['builtin:quad', '--detail', 'misses'],
  'use of textures': ['builtin:deferred', '--detail', 'textures'],
  'the critical path alone': ['builtin:triangle', '--detail', 'path'],
  'draws alone': ['builtin:primitives', '--detail', 'draws'],
  'squares alone, on a large machine with HBM2 and a window': ['builtin:shadow', '--machine', 'large', '--set', 'memory.kind=hbm2', '--window', '100', '--detail', 'tiles'],
  'queries, and transparency in lists': ['builtin:glass', '--queries', '--transparency', 'abuffer', '--detail', 'draws,tiles'],
  'a k-buffer with samples': ['builtin:glass', '--transparency', 'kbuffer', '--samples', '4'],
  'several passes, every unit built': ['builtin:deferred', '--leave-out', 'none', '--detail', 'draws,tiles'],
  'energy alone': ['builtin:triangle', '--energy', '45nm'],
  'energy by draw': ['builtin:glass', '--energy', '45nm', '--detail', 'draws'],
  'no machine at all': ['builtin:quad', '--fidelity', 'functional', '--queries'],
};

for (const [name, args] of Object.entries(RUNS)) test(`the schema holds for ${name}`, () => holds(figures(args)));

test('the schema holds for every frame of an animation', () => {
  const { frames } = figures(['builtin:flag', '--frames', '2']);
  assert.equal(frames.length, 2);
  for (const frame of frames) holds(frame.figures);
});

test('a key too many, one too few and a wrong kind are found', () => {
  const document = figures(['builtin:quad', '--detail', 'draws']);
  const changed = (change) => {
    const copy = structuredClone(document);
    change(copy);
    return valid(copy);
  };
  assert.ok(changed(() => {}));
  assert.ok(!changed((d) => { d.extra = 1; }));
  assert.ok(!changed((d) => { delete d.frame.cycles; }));
  assert.ok(!changed((d) => { delete d.outside_draws; }));
  assert.ok(!changed((d) => { d.draws[0].triangles.in = -1; }));
  assert.ok(!changed((d) => { d.units.core_0.counters.instructions = '7'; }));
  assert.ok(!changed((d) => { d.schema = 'quadrille-figures-2'; }));
});
