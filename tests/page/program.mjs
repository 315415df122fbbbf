// Runs the program in a folder of its own and keeps what it wrote.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

export const [program, root, packages, browser] = process.argv.slice(2);

/** A folder that goes away with the process. */
export function folder() {
  const path = mkdtempSync(join(tmpdir(), 'quadrille-page-'));
  process.on('exit', () => rmSync(path, { recursive: true, force: true }));
  return path;
}

/** Exit code and what went to the standard streams. */
export function run(args, options = {}) {
  const done = spawnSync(program, args, { encoding: 'utf8', maxBuffer: 1 << 28, ...options });
  return { code: done.status, out: done.stdout, error: done.stderr };
}

export function succeed(args, options) {
  const done = run(args, options);
  assert.equal(done.code, 0, `${args.join(' ')}\n${done.error}`);
  return done.out;
}

/** One line, exit code 2: how a user's mistake is told. */
export function refused(args, text, options) {
  const { code, error } = run(args, options);
  assert.equal(code, 2, error);
  assert.match(error, text);
  assert.equal(error.trim().split('\n').length, 1, error);
}

/** Renders with a page and its figures as JSON; both and the text of the page. */
export function report(where, name, args) {
  const page = join(where, `${name}.html`);
  const stats = join(where, `${name}.json`);
  succeed(['render', ...args, '-q', '--report', page, '--stats', stats]);
  return { page, stats, text: readFileSync(page, 'utf8'), figures: JSON.parse(readFileSync(stats, 'utf8')) };
}
