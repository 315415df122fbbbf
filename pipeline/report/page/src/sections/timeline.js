// The frame over time: use of resources, bytes by client and how full links are, by slice, and how many draws were in flight.
import { chart, PALETTE, tip } from '../chart.js';
import { choice } from '../dom.js';
import { decimal, integer, short } from '../format.js';
import { panel, section } from '../layout.js';
import { colour } from '../theme.js';
import { term } from '../terms.js';
import { viewsOf } from './curves.js';

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

/** A series a line. Of a stack each is drawn from the ground up to the sum so far, the highest behind the others, so that what is not its own is covered. */
function seriesOf(view, steps) {
  const one = ({ name }, i, data) => ({
    name, type: 'line', step: 'end', symbol: 'none', data,
    lineStyle: { width: view.stacked ? 0 : 1.5, color: PALETTE[i] }, itemStyle: { color: PALETTE[i] },
    ...(view.stacked && { areaStyle: { color: PALETTE[i], opacity: 1 }, z: 2 + view.lines.length - i }),
  });
  if (!view.stacked) return view.lines.map((line, i) => one(line, i, steps(line.values)));
  let below = view.lines[0].values.map(() => 0);
  return view.lines.map((line, i) => {
    below = below.map((v, s) => v + line.values[s]);
    return one(line, i, steps(below));
  }).reverse();
}

/** A line across the chart at the most that is possible. */
const peakLine = (peak) => ({
  name: 'peak', type: 'line', data: [], silent: true,
  markLine: {
    silent: true, symbol: 'none', data: [{ yAxis: peak }], lineStyle: { color: colour('soft'), type: 'dashed' },
    label: { position: 'insideEndTop', color: colour('soft'), formatter: `peak ${decimal(peak)} B` },
  },
});

function hoverOf(figures, view) {
  const { slice_cycles: slice, slices } = figures.timeline;
  const { cycles } = figures.frame;
  return ([first]) => {
    const s = Math.min(slices - 1, Math.floor(first.axisValue / slice));
    return tip(`Cycles ${integer(s * slice)} to ${integer(Math.min(cycles, (s + 1) * slice))}`,
      view.lines.map((line, i) => [line.name, view.tell(line, s), PALETTE[i]]));
  };
}

function option(basics, figures, view) {
  const { slice_cycles: slice, slices } = figures.timeline;
  const { cycles } = figures.frame;
  const steps = (values) => [...values.map((value, s) => [s * slice, value]), [cycles, values[slices - 1]]];
  const x = (index, shown) => ({
    ...basics.axis, type: 'value', gridIndex: index, min: 0, max: cycles,
    axisLabel: { ...basics.axis.axisLabel, show: shown, formatter: short }, splitLine: { show: false },
  });
  const most = view.peak && ((range) => Math.max(range.max, view.peak));
  return {
    ...basics,
    axisPointer: { link: [{ xAxisIndex: 'all' }] },
    legend: { ...basics.legend, top: 0, left: 0, data: view.lines.map(({ name }) => name), selectedMode: !view.stacked },
    grid: [{ left: 56, right: 20, top: 60, height: 250 }, { left: 56, right: 20, top: 340, height: 70 }],
    tooltip: { ...basics.tooltip, trigger: 'axis', formatter: hoverOf(figures, view) },
    dataZoom: [
      { type: 'inside', xAxisIndex: [0, 1], filterMode: 'none' },
      { type: 'slider', xAxisIndex: [0, 1], filterMode: 'none', bottom: 6, height: 18, labelFormatter: (v) => short(Math.round(v)) },
    ],
    xAxis: [x(0, false), { ...x(1, true), name: 'cycles', nameLocation: 'middle', nameGap: 24 }],
    yAxis: [
      { ...basics.axis, type: 'value', gridIndex: 0, min: 0, max: view.top ?? most, name: view.unit, nameTextStyle: { ...basics.axis.nameTextStyle, align: 'left' }, axisLabel: { ...basics.axis.axisLabel, formatter: view.axis } },
      { ...basics.axis, type: 'value', gridIndex: 1, name: 'draws in flight', nameTextStyle: { ...basics.axis.nameTextStyle, align: 'left' }, minInterval: 1, splitNumber: 2 },
    ],
    series: [
      ...seriesOf(view, steps),
      ...(view.peak ? [peakLine(view.peak)] : []),
      {
        name: 'draws in flight', type: 'line', step: 'end', symbol: 'none', xAxisIndex: 1, yAxisIndex: 1, silent: true,
        data: inFlight(figures.draws ?? []), lineStyle: { width: 1, color: colour('soft') }, areaStyle: { color: colour('line') },
      },
    ],
  };
}

export function timeline({ figures, plan }) {
  if (!figures.timeline || figures.timeline.slices < 2) return null;
  const views = viewsOf(figures, plan);
  if (views.length === 0) return null;
  let [shown] = views;
  const made = chart('timeline-chart', 470, 'What happened over the frame', (basics) => option(basics, figures, shown));
  const choose = choice('What of the frame', views, shown.value, (value) => {
    shown = views.find((view) => view.value === value);
    made.refresh();
  });
  return section('timeline', 'Over time',
    [term('slice', 'Slices'), ` of ${integer(figures.timeline.slice_cycles)} cycles; of each kind of unit, and of each class of links, the mean. Bytes of the clients are those between them and the L2 cache. The wheel, or the bar below, zooms.`],
    panel(null, choose.element, made.host));
}
