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
    kindsOfMisses(figures));
}
