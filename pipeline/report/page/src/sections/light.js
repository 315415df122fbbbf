// How near each resource and each draw is to the best that this machine can do.
import { chart, PALETTE, tip } from '../chart.js';
import { greatest, least } from '../data.js';
import { h } from '../dom.js';
import { integer, percent, short } from '../format.js';
import { panel, section } from '../layout.js';
import { colour } from '../theme.js';
import { term } from '../terms.js';

const MOST_POINTS = 20000; // a canvas shows no more apart

function resources({ limit }) {
  const names = [...new Set([...Object.keys(limit.uses), ...Object.keys(limit.gains)])]
    .map((name) => ({ name, use: limit.uses[name] ?? 0, gain: limit.gains[name] ?? 0 }))
    .sort((a, b) => b.use - a.use || b.gain - a.gain)
    .slice(0, 24);
  return chart('uses-chart', 21 * names.length + 60, 'Use of every resource, and what twice as much is expected to save', (basics) => ({
    ...basics,
    grid: { left: 210, right: 56, top: 34, bottom: 8 },
    legend: { ...basics.legend, top: 0, left: 0 },
    tooltip: {
      ...basics.tooltip, trigger: 'axis', axisPointer: { type: 'shadow' },
      formatter: ([{ dataIndex }]) => tip(names[dataIndex].name, [['use', percent(names[dataIndex].use)], ['twice as much saves', percent(names[dataIndex].gain)]]),
    },
    xAxis: { ...basics.axis, type: 'value', min: 0, max: 1, axisLabel: { show: false }, splitNumber: 4 },
    yAxis: { ...basics.axis, type: 'category', inverse: true, data: names.map((n) => n.name), axisLabel: { ...basics.axis.axisLabel, color: colour('ink') }, splitLine: { show: false } },
    series: [
      { name: 'use', type: 'bar', barGap: '10%', itemStyle: { color: colour('busy') }, data: names.map((n) => n.use), label: { show: true, position: 'right', color: colour('soft'), fontSize: 11, formatter: ({ value }) => percent(value) } },
      { name: 'expected saving if doubled', type: 'bar', itemStyle: { color: colour('accent') }, data: names.map((n) => (n.gain > 0 ? n.gain : null)) },
    ],
  }));
}

/** Every draw as a point: time in flight, and the least time of its work. On the line a draw is as fast as can be. */
function byDraw({ draws }) {
  const points = draws.map((draw, i) => ({ i, draw })).filter(({ draw }) => draw.limiter.work_cycles > 0 && draw.cycles_in_flight > 0)
    .sort((a, b) => b.draw.cycles_in_flight - a.draw.cycles_in_flight).slice(0, MOST_POINTS);
  const kinds = [...new Set(points.map(({ draw }) => draw.limiter.kind))].sort((a, b) => (a === 'latency') - (b === 'latency') || a.localeCompare(b));
  const down = (n) => 10 ** Math.floor(Math.log10(n));
  const values = points.flatMap(({ draw }) => [draw.limiter.work_cycles, draw.cycles_in_flight]);
  const first = down(least(points.map(({ draw }) => draw.cycles_in_flight)));
  const last = 10 * down(greatest(values));
  return chart('draws-chart', 460, 'Draws: cycles in flight against the least time of their work', (basics) => ({
    ...basics,
    grid: { left: 70, right: 20, top: 56, bottom: 52 },
    legend: { ...basics.legend, top: 0, left: 0, icon: 'circle', data: kinds },
    dataZoom: [{ type: 'inside', xAxisIndex: 0, filterMode: 'none' }, { type: 'inside', yAxisIndex: 0, filterMode: 'none' }],
    tooltip: {
      ...basics.tooltip, trigger: 'item',
      formatter: ({ data }) => {
        if (!data?.draw) return '';
        const { draw, i } = data;
        return tip(`${i}: ${draw.label}`, [['in flight', integer(draw.cycles_in_flight)], ['least time', integer(draw.limiter.work_cycles)], ['share', percent(draw.limiter.share)], ['limiter', draw.limiter.kind], ['unit with most work', draw.limiter.unit]]);
      },
    },
    xAxis: { ...basics.axis, type: 'log', min: first, max: last, name: 'cycles in flight', nameLocation: 'middle', nameGap: 30, axisLabel: { ...basics.axis.axisLabel, formatter: short } },
    yAxis: { ...basics.axis, type: 'log', min: down(Math.max(1, least(values))), max: last, name: 'least time of its work, cycles', nameLocation: 'middle', nameGap: 50, axisLabel: { ...basics.axis.axisLabel, formatter: short } },
    series: [
      ...kinds.map((kind, k) => ({
        name: kind, type: 'scatter', symbolSize: 8,
        itemStyle: { color: kind === 'latency' ? colour('idle-mark') : PALETTE[k % (PALETTE.length - 1)], opacity: 0.75 },
        data: points.filter(({ draw }) => draw.limiter.kind === kind).map(({ draw, i }) => ({ value: [draw.cycles_in_flight, draw.limiter.work_cycles], draw, i })),
      })),
      { name: 'speed of light', type: 'line', symbol: 'none', silent: true, lineStyle: { color: colour('soft'), type: 'dashed', width: 1.5 }, data: [[first, first], [last, last]] },
    ],
  }));
}

export function light({ figures }) {
  if (!figures.limit) return null;
  const full = Object.entries(figures.limit.full);
  return section('light', 'Speed of light',
    [term('speed of light', 'The least time'), ' of the counted work at peak rates, by resource and by draw. ', term('gain', 'The saving'), ' is expected, not measured.'],
    h('div', { class: 'halves' },
      panel('By resource', resources(figures).host,
        full.length > 0 && h('p', { class: 'soft' }, term('full', 'Places that were all taken'), ': ', full.map(([name, part]) => `${name} ${percent(part)}`).join(' · '))),
      figures.draws?.length > 0 && panel('By draw', byDraw(figures).host,
        h('p', { class: 'soft' }, `Draws on the dashed line are as fast as their busiest unit allows; below it they wait. ${figures.draws.length > MOST_POINTS ? `The ${integer(MOST_POINTS)} longest of ${integer(figures.draws.length)}` : integer(figures.draws.length)} draws; the wheel zooms.`))));
}
