// Figures as a flat table, and counters under the names of real GPUs' profilers.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { folder, program, refused, report, root, succeed } from './program.mjs';

/** Lines and fields of a CSV [RFC 4180]. */
function parsed(text) {
  const rows = [[]];
  for (const [, quoted, plain, end] of text.matchAll(/(?:"((?:[^"]|"")*)"|([^",\r\n]*))(,|\r\n)/g)) {
    rows.at(-1).push(quoted?.replaceAll('""', '"') ?? plain);
    if (end !== ',') rows.push([]);
  }
  return rows.slice(0, -1);
}

/** Every value of a document by its path. */
function flat(value, path, into = {}) {
  if (Array.isArray(value)) value.forEach((entry, i) => flat(entry, `${path}[${i}]`, into));
  else if (value !== null && typeof value === 'object') Object.entries(value).forEach(([key, entry]) => flat(entry, path ? `${path}.${key}` : key, into));
  else into[path] = value;
  return into;
}

test('the table holds every value of the JSON once, with the units of counters', () => {
  const where = folder();
  const file = join(where, 'f.csv');
  const { figures } = report(where, 'f', ['builtin:quad', '--size', '64x48', '--csv', file]);
  const [head, ...rows] = parsed(readFileSync(file, 'utf8'));
  assert.deepEqual(head, ['path', 'value', 'unit']);
  const { counter_definitions: definitions, ...shown } = figures;
  const expected = flat(shown, '');
  assert.equal(rows.length, Object.keys(expected).length);
  for (const [path, text, unit] of rows) {
    const value = expected[path];
    assert.ok(path in expected, path);
    if (typeof value === 'number') assert.equal(Number(text), value, path);
    else assert.equal(text, value === null ? '' : String(value), path);
    const counter = path.match(/^units\.(.+?)(?:_\d+)?\.counters\.(.+)$/);
    assert.equal(unit, counter ? definitions[counter[1]][counter[2]].unit : '', path);
  }
});

test('a table that cannot be written is refused', () => {
  const where = folder();
  const args = ['render', 'builtin:quad', '--size', '64x48', '-q', '--csv'];
  refused([...args, join(where, 'f.txt')], /--csv: .*has to end in \.csv/);
});

test('every counter named after a profiler\'s is one of ours, and there are enough of them', () => {
  const described = JSON.parse(succeed(['describe', 'counters', '--json'])).counters;
  const frame = JSON.parse(succeed(['render', 'builtin:quad', '--size', '64x48', '-q', '--stats', '-'])).frame;
  let count = 0;
  for (const profiler of ['arm', 'rgp', 'nsight']) {
    const text = succeed(['describe', 'counters', '--as', profiler]);
    const names = [...text.matchAll(/^  (\S+) += (.*)$/gm)];
    assert.ok(names.length >= 20, profiler);
    assert.equal(new Set(names.map(([, name]) => name)).size, names.length);
    count += names.length;
    for (const [, name, ours] of names) {
      for (const [, kind, counter] of ours.matchAll(/([a-z0-9_]+)\.([a-z0-9_]+)/g))
        assert.ok(kind === 'frame' ? counter in frame : described[kind]?.[counter], `${name} = ${ours}`);
    }
    for (const [, tag] of text.matchAll(/\[([^\]]+)\]$/gm)) assert.ok(readFileSync(join(root, 'docs/sources.md'), 'utf8').includes(`| ${tag} |`), tag);
  }
  assert.ok(count >= 60, String(count));
  refused(['describe', 'texture', '--as', 'arm'], /--as names counters/);
  assert.ok(program);
});
