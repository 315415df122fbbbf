// The frame over time: use of resources by slice, and how many draws were in flight.
import { chart, PALETTE, tip } from '../chart.js';
import { kindOf, sum } from '../data.js';
import { choice } from '../dom.js';
import { integer, percent, short } from '../format.js';
import { panel, section } from '../layout.js';
import { colour } from '../theme.js';
import { term } from '../terms.js';

const MOST_LINES = 8;
const KINDS = [
  { value: 'rate', text: 'Use', title: 'Part of the slice that the work takes at the peak rate' },
  { value: 'places', text: 'Places all taken', title: 'Part of the slice in which all places were taken' },
  { value: 'loss', text: 'Lost', title: "Part of the slice in which a rate's resource could not work" },
];

/** Curves of one kind of resource: the mean over the units of each kind, those with the most first. */
export function curvesOf(figures, kind) {
  const all = new Map();
  for (const [unit, resources] of Object.entries(figures.timeline.units)) {
    for (const [resource, share] of Object.entries(resources)) {
      if (figures.units[unit].resources[resource].kind !== kind) continue;
      const name = `${kindOf(unit)}.${resource}`;
      if (!all.has(name)) all.set(name, []);
      all.get(name).push(share);
    }
  }
  return [...all].map(([name, shares]) => ({ name, share: shares[0].map((_, s) => sum(shares.map((of) => of[s])) / shares.length) }))
    .filter(({ share }) => share.some((part) => part > 0))
    .sort((a, b) => sum(b.share) - sum(a.share));
}

/** Draws in flight: [cycle, count] wherever the count changes. */
export function inFlight(draws) {
  const changes = new Map();
  const change = (cycle, by) => changes.set(cycle, (changes.get(cycle) ?? 0) + by);
  for (const draw of draws) {
    change(draw.issued, 1);
    change(draw.retired, -1);
  }
  let count = 0;
  return [...changes].sort((a, b) => a[0] - b[0]).map(([cycle, by]) => [cycle, (count += by)]);
}

function option(basics, figures, kind) {
  const { slice_cycles: slice, slices } = figures.timeline;
  const { cycles } = figures.frame;
  const lines = curvesOf(figures, kind).slice(0, MOST_LINES);
  const steps = (share) => [...share.map((part, s) => [s * slice, part]), [cycles, share[slices - 1]]];
  const hover = ([first]) => {
    const s = Math.min(slices - 1, Math.floor(first.axisValue / slice));
    return tip(`Cycles ${integer(s * slice)} to ${integer(Math.min(cycles, (s + 1) * slice))}`,
      lines.map(({ name, share }, i) => [name, percent(share[s]), PALETTE[i]]));
  };
  const x = (index, shown) => ({
    ...basics.axis, type: 'value', gridIndex: index, min: 0, max: cycles,
    axisLabel: { ...basics.axis.axisLabel, show: shown, formatter: short }, splitLine: { show: false },
  });
  return {
    ...basics,
    axisPointer: { link: [{ xAxisIndex: 'all' }] },
    legend: { ...basics.legend, top: 0, left: 0, data: lines.map(({ name }) => name) },
    grid: [{ left: 56, right: 20, top: 60, height: 250 }, { left: 56, right: 20, top: 340, height: 70 }],
    tooltip: { ...basics.tooltip, trigger: 'axis', formatter: hover },
    dataZoom: [
      { type: 'inside', xAxisIndex: [0, 1], filterMode: 'none' },
      { type: 'slider', xAxisIndex: [0, 1], filterMode: 'none', bottom: 6, height: 18, labelFormatter: (v) => short(Math.round(v)) },
    ],
    xAxis: [x(0, false), { ...x(1, true), name: 'cycles', nameLocation: 'middle', nameGap: 24 }],
    yAxis: [
      { ...basics.axis, type: 'value', gridIndex: 0, min: 0, max: 1, axisLabel: { ...basics.axis.axisLabel, formatter: (v) => `${Math.round(100 * v)} %` } },
      { ...basics.axis, type: 'value', gridIndex: 1, name: 'draws in flight', nameTextStyle: { ...basics.axis.nameTextStyle, align: 'left' }, minInterval: 1, splitNumber: 2 },
    ],
    series: [
      ...lines.map(({ name, share }, i) => ({
        name, type: 'line', step: 'end', symbol: 'none', data: steps(share),
        lineStyle: { width: 1.5, color: PALETTE[i] }, itemStyle: { color: PALETTE[i] },
      })),
      {
        name: 'draws in flight', type: 'line', step: 'end', symbol: 'none', xAxisIndex: 1, yAxisIndex: 1, silent: true,
        data: inFlight(figures.draws ?? []), lineStyle: { width: 1, color: colour('soft') }, areaStyle: { color: colour('line') },
      },
    ],
  };
}

export function timeline({ figures }) {
  if (!figures.timeline || figures.timeline.slices < 2) return null;
  const kinds = KINDS.filter(({ value }) => curvesOf(figures, value).length > 0);
  if (kinds.length === 0) return null;
  let shown = kinds[0].value;
  const made = chart('timeline-chart', 470, 'Use of resources over the frame', (basics) => option(basics, figures, shown));
  const choose = choice('What of the resources', kinds, shown, (value) => {
    shown = value;
    made.refresh();
  });
  return section('timeline', 'Over time',
    [term('slice', 'Slices'), ` of ${integer(figures.timeline.slice_cycles)} cycles; of each kind of unit the mean. The wheel, or the bar below, zooms.`],
    panel(null, choose.element, made.host));
}
