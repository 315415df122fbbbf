// --vcd: waves that agree with the figures, with the same cycles as without, whole or not at all.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { folder, program, refused, succeed } from './program.mjs';

const where = folder();
const scene = ['render', 'builtin:triangle', '--size', '64x48'];

/** Signals of a VCD file [IEEE 1364] by name: [time, value] whenever one changes; and its last time. */
function waves(text) {
  const names = new Map();
  const signals = new Map();
  const scopes = [];
  let time = 0;
  let unit = '';
  for (const line of text.split('\n')) {
    const words = line.trim().split(/\s+/);
    if (words[0] === '$timescale') unit = line + text.slice(text.indexOf(line) + line.length, text.indexOf('$end', text.indexOf(line)));
    else if (words[0] === '$scope') scopes.push(words[2]);
    else if (words[0] === '$upscope') scopes.pop();
    else if (words[0] === '$var') names.set(words[3], [...scopes, words[4]].join('.').replace(/^SystemC\./, ''));
    else if (line.startsWith('#')) {
      assert.ok(Number(line.slice(1)) >= time, 'time goes on');
      time = Number(line.slice(1));
    } else if (/^b[01]+ \S+$/.test(line) || /^[01]\S+$/.test(line)) {
      const [value, id] = line.startsWith('b') ? [parseInt(line.slice(1), 2), words[1]] : [Number(line[0]), line.slice(1)];
      const name = names.get(id);
      if (!signals.has(name)) signals.set(name, []);
      signals.get(name).push([time, value]);
    }
  }
  return { signals, time, unit };
}

test('links hold no more than their depth and end empty, units act, and cycles are those without waves', () => {
  const plain = JSON.parse(succeed([...scene, '-q', '--stats', '-']));
  const traced = JSON.parse(succeed([...scene, '-q', '--stats', '-', '--vcd', join(where, 't.vcd')]));
  delete plain.host;
  delete traced.host;
  assert.deepEqual(traced, plain);
  const { signals, time, unit } = waves(readFileSync(join(where, 't.vcd'), 'utf8'));
  assert.match(unit, /1 fs/);
  const { parameters } = plain.machine;
  assert.equal(time, plain.frame.cycles * 1e9 / parameters['gpu.clock_mhz'] + 1, 'SystemC closes the file a femtosecond later');
  const links = [...signals].filter(([name]) => name.startsWith('links.'));
  assert.ok(links.length > 30, `${links.length} links`);
  for (const [name, values] of links) {
    const kind = name.slice('links.'.length).replace(/(_\d+)+$/, '');
    const depth = parameters[`link.${kind}.depth`];
    for (const [, tokens] of values) assert.ok(tokens >= 0 && (depth === undefined || tokens <= depth), `${name} holds ${tokens}`);
    assert.equal(values.at(-1)[1], 0, `${name} is not empty at the end`);
  }
  const used = links.filter(([, values]) => values.some(([, tokens]) => tokens > 0));
  assert.ok(used.length > 20);
  const raster = signals.get('units.coarse_raster');
  assert.ok(raster.length > 2);
});

test('what does not go with waves is refused, and nothing is left where they do not fit', () => {
  const file = join(where, 'x.vcd');
  refused([...scene, '--vcd', join(where, 'x.txt')], /--vcd: .*has to end in \.vcd/);
  refused([...scene, '--vcd', file, '--driver', 'dispatcher'], /--vcd: waves are written by SystemC's own scheduler; leave --driver dispatcher out/);
  refused([...scene, '--vcd', file, '--window', '10'], /leave --window out/);
  refused([...scene, '--vcd', file, '--fidelity', 'functional'], /--vcd: a functional run/);
  refused([...scene, '--vcd', file, '--frames', '2'], /--vcd: it is of one frame/);
  assert.equal(existsSync(file), false);
  const small = join(where, 'small');
  mkdirSync(small);
  const done = spawnSync('bash', ['-c', 'ulimit -f 8; exec "$0" "$@"', program, ...scene, '-q', '--vcd', join(small, 'x.vcd')], { encoding: 'utf8' });
  assert.equal(done.status, 2, done.stderr);
  assert.match(done.stderr, /^quadrille: .*x\.vcd: cannot be written whole/);
  assert.deepEqual(readdirSync(small), []);
});
