// A page that cannot be written is refused in one line, before the run where that is known; nothing is left half-written.
import assert from 'node:assert/strict';
import { mkdirSync, readdirSync } from 'node:fs';
import { spawnSync } from 'node:child_process';
import { join } from 'node:path';
import { test } from 'node:test';
import { folder, program, refused } from './program.mjs';

const where = folder();
const triangle = ['render', 'builtin:triangle', '--size', '64x48', '-q', '--report'];

test('a place that cannot be, and options that a page does not go with, are refused', () => {
  refused([...triangle, join(where, 'none', 'x.html')], /--report: .*there is no folder/);
  refused([...triangle, join(where, 'x.txt')], /--report: .*the name has to end in \.html/);
  mkdirSync(join(where, 'folder.html'));
  refused([...triangle, join(where, 'folder.html')], /--report: .*not a plain file/);
  refused([...triangle, join(where, 'x.html'), '--fidelity', 'functional'], /--report: a functional run has no units/);
});

test('a page that does not fit on the disk leaves no file', () => {
  const empty = join(where, 'small');
  mkdirSync(empty);
  const args = [...triangle, join(empty, 'x.html')];
  const done = spawnSync('bash', ['-c', 'ulimit -f 64; exec "$0" "$@"', program, ...args], { encoding: 'utf8' });
  assert.equal(done.status, 2, done.stderr);
  assert.match(done.stderr, /^quadrille: .*x\.html/);
  assert.deepEqual(readdirSync(empty), []);
});
