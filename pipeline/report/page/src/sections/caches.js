// Look-ups of every cache: hits, lines on their way, misses.
import { chart, tip } from '../chart.js';
import { counted, kindsOf } from '../data.js';
import { h } from '../dom.js';
import { integer, number, percent, ratio, words } from '../format.js';
import { panel, section, table } from '../layout.js';
import { counter, explained, term } from '../terms.js';
import { colour } from '../theme.js';

/** The L2 cache counts under names without the prefix that first-level caches have. */
function look([kind, units]) {
  const prefix = kind === 'l2' ? '' : 'cache_';
  const of = (name) => counted(units, prefix + name);
  return { kind, prefix, name: units.length > 1 ? `${words(kind)} x${units.length}` : words(kind), requests: of('requests'), hits: of('hits'), merged: of('merged'), misses: of('misses') };
}

const isCache = ([kind, units]) => (kind === 'l2' ? 'hits' : 'cache_hits') in units[0][1].counters;

const KINDS = [
  ['compulsory', 'Something of what is asked for was never held before'],
  ['capacity', 'A cache of as many lines without sets, that gives up the line used longest ago, misses too'],
  ['conflict', 'Such a cache does not: sets are too small, or the order of replacement is another one'],
];

/** Why texture caches missed, of all and of each; only where it was asked for. */
function kindsOfMisses({ texture_misses: all }) {
  if (!all || all.look_ups === 0) return null;
  const rows = [['all', all], ...Object.entries(all.units)];
  return panel('Why texture caches missed', table('miss-kinds', [
    { title: 'cache', of: ([name]) => words(name) },
    { title: 'misses', number: true, of: ([, m]) => number(m.misses) },
    ...KINDS.map(([kind, text]) => ({ title: explained(kind, text), number: true, of: ([, m]) => number(m[kind]) })),
    ...KINDS.map(([kind]) => ({ title: `% ${kind}`, number: true, of: ([, m]) => percent(ratio(m[kind], m.misses)) })),
    { title: explained('without sets', 'Misses of a cache of as many lines in which any line may lie anywhere'), number: true, of: ([, m]) => number(m.associative_misses) },
  ], rows));
}

/** What each texture was asked for, the dearest first; only where it was asked for. */
function useOfTextures({ textures }) {
  if (!textures || textures.length === 0) return null;
  const rows = textures.filter((t) => t.requests > 0).sort((a, b) => b.read_bytes - a.read_bytes);
  const level = (t) => t.lanes_by_level.reduce((all, lanes, l) => all + l * lanes, 0) / t.lanes;
  return panel('Textures', table('textures-table', [
    { title: 'texture', of: (t) => t.name },
    { title: 'texels', of: (t) => `${t.width}x${t.height}${t.depth > 1 ? `x${t.depth}` : ''}${t.layers > 1 ? `, ${t.layers} layers` : ''}` },
    { title: 'format', of: (t) => t.format },
    { title: 'lanes', number: true, of: (t) => number(t.lanes) },
    { title: explained('linear', 'Lanes that read 2x2 texels of a level, of all'), number: true, of: (t) => percent(ratio(t.linear, t.lanes)) },
    { title: explained('two levels', 'Lanes whose texels are of two levels'), number: true, of: (t) => percent(ratio(t.two_levels, t.lanes)) },
    { title: explained('along an axis', 'Lanes with several anisotropic samples'), number: true, of: (t) => percent(ratio(t.several_samples, t.lanes)) },
    { title: explained('level', 'Mean of the finer level that lanes read'), number: true, of: (t) => level(t).toFixed(2) },
    { title: 'look-ups', number: true, of: (t) => number(t.look_ups) },
    { title: 'misses', number: true, of: (t) => number(t.misses) },
    { title: explained('L2 bytes', 'Bytes asked of the L2 cache'), number: true, of: (t) => number(t.read_bytes) },
    { title: explained('memory bytes', 'Bytes that memory read for the texture units'), number: true, of: (t) => number(t.memory_bytes) },
  ], rows));
}

export function caches({ figures, order }) {
  const rows = kindsOf(figures, order).filter(isCache).map(look).filter((r) => r.requests > 0);
  if (rows.length === 0) return null;
  const parts = [['hits', 'busy'], ['merged', 'waiting'], ['misses', 'blocked']];
  const made = chart('caches-chart', 36 * rows.length + 70, 'Look-ups of every cache: hits, merged, misses', (basics) => ({
    ...basics,
    grid: { left: 120, right: 24, top: 34, bottom: 26 },
    legend: { ...basics.legend, top: 0, left: 0 },
    tooltip: {
      ...basics.tooltip, trigger: 'axis', axisPointer: { type: 'shadow' },
      formatter: ([{ dataIndex }]) => {
        const r = rows[dataIndex];
        return tip(r.name, [['look-ups', integer(r.requests)], ...parts.map(([name, c]) => [name, `${integer(r[name])} · ${percent(r[name] / r.requests)}`, colour(c)])]);
      },
    },
    xAxis: { ...basics.axis, type: 'value', max: 1, axisLabel: { ...basics.axis.axisLabel, formatter: (v) => `${Math.round(100 * v)} %` } },
    yAxis: { ...basics.axis, type: 'category', inverse: true, data: rows.map((r) => r.name), axisLabel: { ...basics.axis.axisLabel, color: colour('ink') }, splitLine: { show: false } },
    series: parts.map(([name, c]) => ({ name, type: 'bar', stack: 'look-ups', barWidth: '60%', itemStyle: { color: colour(c) }, data: rows.map((r) => r[name] / r.requests) })),
  }));
  const column = (name) => ({ title: name, number: true, of: (r) => number(r[name]) });
  return section('caches', 'Caches',
    ['Each distinct line of a request is looked up once. ', term('merged', 'Merged'), ' look-ups found their line on the way already; hit rates by texel or by quad, as other tools give them, are higher.'],
    h('div', { class: 'halves' }, made.host, table('caches-table', [
      { title: 'cache', of: (r) => counter(figures, r.kind, `${r.prefix}hits`, r.name) },
      { title: 'look-ups', number: true, of: (r) => [number(r.requests)] },
      column('hits'), column('merged'), column('misses'),
      { title: explained('hit', 'Hits of all look-ups'), number: true, of: (r) => percent(ratio(r.hits, r.requests)) },
    ], rows)),
    kindsOfMisses(figures), useOfTextures(figures));
}
