// Energy by unit and by draw, and area: every figure with the range of its sources.
import { chart, tip } from '../chart.js';
import { choice, h } from '../dom.js';
import { decimal, integer, number, percent, ratio, words } from '../format.js';
import { grid, numberColumn, textColumn } from '../grid.js';
import { panel, section, table } from '../layout.js';
import { explained } from '../terms.js';
import { colour } from '../theme.js';

const MICROJOULE = 1e6; // in pJ
const SQUARE_MILLIMETRE = 1e6; // in um2
const MOST_DRAWS = 2000;

/** "1.2 (0.9 to 1.5)" */
const rangeText = (r, unit) => `${decimal(r.typical / unit)} (${decimal(r.low / unit)} to ${decimal(r.high / unit)})`;

/** What is shown: energy by unit, or area by unit. */
const views = (energy) => ({
  energy: { unit: MICROJOULE, name: 'µJ', units: energy.units, total: energy.total, parts: energy.events.map((e) => ({ ...e, value: e.pj })), each: 'pJ', count: (e) => e.count },
  area: { unit: SQUARE_MILLIMETRE, name: 'mm²', units: energy.area.units, total: energy.area.total, parts: energy.area.parts.map((p) => ({ ...p, value: p.um2 })), each: 'µm²', count: (p) => p.units },
});

function option(basics, { unit, name, units, total }) {
  const rows = Object.entries(units);
  const part = (r) => percent(ratio(r.typical, total.typical));
  // A line from low to high over each bar, by a bar without colour that carries one with.
  return {
    ...basics,
    legend: { show: false },
    grid: { left: 150, right: 70, top: 8, bottom: 40 },
    tooltip: {
      ...basics.tooltip, trigger: 'axis', axisPointer: { type: 'shadow' },
      formatter: ([{ dataIndex }]) => {
        const [kind, r] = rows[dataIndex];
        return tip(words(kind), [['low', `${decimal(r.low / unit)} ${name}`], ['typical', `${decimal(r.typical / unit)} ${name}`], ['high', `${decimal(r.high / unit)} ${name}`], ['of all', part(r)]]);
      },
    },
    xAxis: { ...basics.axis, type: 'value', name, nameLocation: 'middle', nameGap: 26 },
    yAxis: [
      { ...basics.axis, type: 'category', inverse: true, data: rows.map(([kind]) => words(kind)), axisLabel: { ...basics.axis.axisLabel, color: colour('ink') }, splitLine: { show: false } },
      { type: 'category', inverse: true, show: false, data: rows.map(([kind]) => kind) },
    ],
    series: [
      { name: 'typical', type: 'bar', barWidth: '60%', itemStyle: { color: colour('busy') }, data: rows.map(([, r]) => r.typical / unit) },
      { name: 'low', type: 'bar', stack: 'range', yAxisIndex: 1, barWidth: 3, silent: true, itemStyle: { color: 'transparent' }, data: rows.map(([, r]) => r.low / unit) },
      {
        name: 'low to high', type: 'bar', stack: 'range', yAxisIndex: 1, barWidth: 3, silent: true, z: 5, itemStyle: { color: colour('ink') },
        data: rows.map(([, r]) => (r.high - r.low) / unit),
        label: { show: true, position: 'right', color: colour('soft'), fontSize: 12, formatter: ({ dataIndex }) => part(rows[dataIndex][1]) },
      },
    ],
  };
}

function partsTable(energy, { unit, name, parts, each, count }) {
  const cost = (p) => explained(words(p.constant), energy.constants[p.constant]?.source ?? `An access of 64 bits to a memory of ${integer(p.array_bytes)} bytes, between the sizes of the file`);
  const column = (title, of) => ({ title, number: true, of });
  return table('energy-parts', [
    { title: 'unit', of: (p) => words(p.unit) }, { title: 'what', of: (p) => p.what }, { title: 'cost', of: cost },
    column('how many', (p) => number(count(p))), column(`${each} each`, (p) => rangeText(p.each, 1)),
    column('low', (p) => number(p.value.low, (v) => decimal(v / unit))), column(name, (p) => number(p.value.typical, (v) => decimal(v / unit))), column('high', (p) => number(p.value.high, (v) => decimal(v / unit))),
  ], parts.filter((p) => p.value.high > 0).sort((a, b) => b.value.typical - a.value.typical));
}

/** The draws that take most. */
function byDraw({ energy, draws }) {
  if (!energy.draws || !draws?.length) return null;
  const micro = (value) => decimal(value / MICROJOULE);
  const rows = energy.draws.map((r, i) => ({ number: i, label: draws[i].label, ...r, share: ratio(r.typical, energy.total.typical) }))
    .sort((a, b) => b.typical - a.typical).slice(0, MOST_DRAWS);
  const made = grid('energy-draws', [
    numberColumn('#', 'number', integer, { width: 64, headerFilter: false }), textColumn('draw', 'label', { width: 320 }),
    numberColumn('low, µJ', 'low', micro, { width: 110, headerFilter: false }), numberColumn('typical, µJ', 'typical', micro, { width: 120, headerFilter: false }),
    numberColumn('high, µJ', 'high', micro, { width: 110, headerFilter: false }), numberColumn('of all', 'share', percent, { width: 100, headerFilter: false }),
  ], rows, Math.min(420, 90 + 32 * rows.length), { initialSort: [{ column: 'typical', dir: 'desc' }], layout: 'fitData' });
  return panel('By draw', h('p', { class: 'soft' }, `${energy.draws.length > MOST_DRAWS ? `The ${integer(MOST_DRAWS)} dearest of ${integer(energy.draws.length)} draws; ` : ''}outside of draws: ${rangeText(energy.outside_draws, MICROJOULE)} µJ. Together they are the frame's.`), made.host);
}

export function energy({ figures }) {
  const of = figures.energy;
  if (!of) return null;
  const all = views(of);
  let shown = all.energy;
  const box = h('div', null, partsTable(of, shown));
  const height = () => 30 * Object.keys(shown.units).length + 60;
  const made = chart('energy-chart', height(), 'Energy or area by unit, with the range of their sources', (basics) => option(basics, shown));
  const total = h('p', null);
  const show = (value) => {
    shown = all[value];
    made.host.style.height = `${height()}px`;
    made.refresh();
    box.replaceChildren(partsTable(of, shown));
    total.replaceChildren(number(shown.total.typical, (v) => decimal(v / shown.unit), 'energy-total'), ` ${shown.name} in all, ${decimal(shown.total.low / shown.unit)} to ${decimal(shown.total.high / shown.unit)}`);
  };
  const pick = choice('What is shown', [{ value: 'energy', text: 'Energy' }, { value: 'area', text: 'Area', title: 'Arrays of memory and arithmetic alone' }], 'energy', show);
  show('energy');
  return section('energy', 'Energy and area',
    [`Counts of events times what each costs, by ${of.file}: relative, for comparing units, draws and machines, and without `,
      explained('what nobody counted', 'Leakage, clock trees, wires between units, links, control, and refresh and idling of DRAM'),
      '. The dark line over a bar is the range of its sources.'],
    pick.element, total, made.host, panel('What it is made of', box), byDraw({ energy: of, draws: figures.draws }));
}
