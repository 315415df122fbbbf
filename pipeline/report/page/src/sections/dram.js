// Memory: where the time of the data buses went, rows, and how long requests took.
import { chart, PALETTE, tip } from '../chart.js';
import { counted, sum } from '../data.js';
import { h } from '../dom.js';
import { decimal, integer, number, percent, ratio, short, words } from '../format.js';
import { panel, section, table } from '../layout.js';
import { counter, term } from '../terms.js';
import { colour } from '../theme.js';

const BUS = [
  ['bus_read', 'reads', '#0072b2'], ['bus_write', 'writes', '#56b4e9'], ['bus_refresh', 'refresh', '#cc79a7'],
  ['bus_turnaround', 'turn-around', '#f0e442'], ['bus_activation', 'activation', '#e69f00'], ['bus_spacing', 'spacing', '#d55e00'], ['bus_idle', 'idle', null],
];
const ROWS = [['row_hits', 'row hit', '#0072b2'], ['row_misses', 'row miss', '#e69f00'], ['row_conflicts', 'row conflict', '#d55e00']];

/** Bars of a channel each, parts of 1. */
function stacked(id, label, channels, parts) {
  const totals = channels.map(([, u]) => sum(parts.map(([name]) => u.counters[name])));
  return chart(id, 34 * channels.length + 96, label, (basics) => ({
    ...basics,
    grid: { left: 90, right: 20, top: 58, bottom: 26 },
    legend: { ...basics.legend, top: 0, left: 0 },
    tooltip: {
      ...basics.tooltip, trigger: 'axis', axisPointer: { type: 'shadow' },
      formatter: ([{ dataIndex }]) => tip(words(channels[dataIndex][0]), parts.map(([name, text, c]) => {
        const value = channels[dataIndex][1].counters[name];
        return [text, `${short(value)} · ${percent(ratio(value, totals[dataIndex]))}`, c ?? colour('idle')];
      })),
    },
    xAxis: { ...basics.axis, type: 'value', max: 1, axisLabel: { ...basics.axis.axisLabel, formatter: (v) => `${Math.round(100 * v)} %` } },
    yAxis: { ...basics.axis, type: 'category', inverse: true, data: channels.map(([path]) => words(path)), axisLabel: { ...basics.axis.axisLabel, color: colour('ink') }, splitLine: { show: false } },
    series: parts.map(([name, text, c]) => ({
      name: text, type: 'bar', stack: 'all', barWidth: '64%', itemStyle: { color: c ?? colour('idle') },
      data: channels.map(([, u], i) => ratio(u.counters[name], totals[i]) || 0),
    })),
  }));
}

/** Histograms of all channels together, those that counted anything. */
function latencies(channels) {
  const names = [...new Set(channels.flatMap(([, u]) => Object.keys(u.histograms)))].filter((name) => name.startsWith('latency_'));
  return names.map((name) => {
    const all = channels.map(([, u]) => u.histograms[name]).filter(Boolean);
    const buckets = Array.from({ length: Math.max(0, ...all.map((x) => x.buckets.length)) }, (_, i) => sum(all.map((x) => x.buckets[i] ?? 0)));
    return { key: name, name: words(name.replace('latency_', '')), buckets, count: sum(buckets), total: sum(all.map((x) => x.sum)) };
  }).filter((x) => x.count > 0);
}

/** The least size from which on buckets hold `part` of all. */
function quantile(buckets, part) {
  const all = sum(buckets);
  let seen = 0;
  for (let i = 0; i < buckets.length; ++i) {
    seen += buckets[i];
    if (seen >= part * all) return i === 0 ? 0 : 2 ** i - 1;
  }
  return 0;
}

function latencyChart(rows) {
  const first = Math.min(...rows.map((r) => r.buckets.findIndex((n) => n > 0)));
  const last = Math.max(...rows.map((r) => r.buckets.length));
  const places = Array.from({ length: last - first }, (_, i) => i + first);
  const range = (i) => (i === 0 ? '0' : `${integer(2 ** (i - 1))} to ${integer(2 ** i - 1)}`);
  return chart('latency-chart', 320, 'How long requests took, by client', (basics) => ({
    ...basics,
    grid: { left: 60, right: 16, top: 44, bottom: 46 },
    legend: { ...basics.legend, top: 0, left: 0 },
    tooltip: {
      ...basics.tooltip, trigger: 'axis',
      formatter: (all) => tip(`${range(places[all[0].dataIndex])} cycles`, rows.map((r, i) => {
        const n = r.buckets[places[all[0].dataIndex]] ?? 0;
        return [r.name, `${integer(n)} · ${percent(n / r.count)}`, PALETTE[i % PALETTE.length]];
      })),
    },
    xAxis: { ...basics.axis, type: 'category', name: 'cycles from request to answer, by powers of two', nameLocation: 'middle', nameGap: 28, data: places.map((i) => (i === 0 ? '0' : integer(2 ** (i - 1)))), splitLine: { show: false } },
    yAxis: { ...basics.axis, type: 'value', axisLabel: { ...basics.axis.axisLabel, formatter: (v) => `${Math.round(100 * v)} %` } },
    series: rows.map((r, i) => ({
      name: r.name, type: 'line', step: 'middle', symbol: 'none', lineStyle: { width: 2, color: PALETTE[i % PALETTE.length] }, itemStyle: { color: PALETTE[i % PALETTE.length] },
      data: places.map((p) => (r.buckets[p] ?? 0) / r.count),
    })),
  }));
}

export function dram({ figures }) {
  const channels = Object.entries(figures.units).filter(([path]) => path.replace(/_\d+$/, '') === 'memory');
  if (channels.length === 0 || counted(channels, 'reads') + counted(channels, 'writes') === 0) return null;
  const rows = latencies(channels);
  const queue = ratio(counted(channels, 'queue_occupancy'), sum(channels.map(([, u]) => u.cycles)));
  const hits = ratio(counted(channels, 'row_hits'), sum(ROWS.map(([name]) => counted(channels, name))));
  return section('dram', 'Memory',
    [`${percent(hits)} of the requests found their row open; a controller held ${decimal(queue)} requests in the mean (`, term('in queue'), '). Losses: ',
      ...['refresh', 'turn-around', 'activation', 'spacing'].flatMap((name, i) => [i > 0 ? ', ' : '', term(name)]), '.'],
    h('div', { class: 'halves' },
      panel('Time of the data buses', stacked('bus-chart', 'Time of the data buses by channel', channels, BUS).host),
      panel('Rows', stacked('rows-chart', 'Rows: hits, misses, conflicts by channel', channels, ROWS).host)),
    rows.length > 0 && h('div', { class: 'halves' },
      panel('Latency', latencyChart(rows).host),
      panel('Latency by client', table('latency-table', [
        { title: 'client', of: (r) => counter(figures, 'memory', r.key, r.name) },
        { title: 'requests', number: true, of: (r) => number(r.count) },
        { title: 'mean cycles', number: true, of: (r) => number(r.total / r.count, decimal) },
        { title: 'half within', number: true, of: (r) => number(quantile(r.buckets, 0.5), integer) },
        { title: '95 % within', number: true, of: (r) => number(quantile(r.buckets, 0.95), integer) },
        { title: '99 % within', number: true, of: (r) => number(quantile(r.buckets, 0.99), integer) },
      ], rows))));
}
