// Where every unit's cycles went, and the ports it waited for.
import { chart, tip } from '../chart.js';
import { choice, h } from '../dom.js';
import { addedUp, kindOf, kindsOf, portKind, STATES, sum } from '../data.js';
import { integer, number, percent, words } from '../format.js';
import { panel, section, table } from '../layout.js';
import { colour } from '../theme.js';
import { counter, definition, explained, term } from '../terms.js';

/** A row of the chart: a unit, or all units of a kind together. */
const row = (name, units) => {
  const total = sum(units.map(([, u]) => u.cycles));
  return {
    name, units, kind: kindOf(units[0][0]), total,
    states: STATES.map((state) => sum(units.map(([, u]) => u[state]))),
    use: Math.max(...units.map(([, u]) => u.use)),
    waits: addedUp(units.map(([, u]) => u.waits), portKind),
  };
};

const rowsOf = (kinds, folded) =>
  folded ? kinds.map(([kind, units]) => row(units.length > 1 ? `${words(kind)} x${units.length}` : words(kind), units))
    : kinds.flatMap(([, units]) => units.map((unit) => row(words(unit[0]), [unit])));

function hover(r) {
  const rows = STATES.map((state, i) => [state, `${percent(r.states[i] / r.total)}`, colour(state)]);
  rows.push(['use', percent(r.use)]);
  const waits = r.waits.slice(0, 4).map(([port, cycles]) => `${port} ${percent(cycles / r.total)}`).join(', ');
  return tip(r.name, rows, waits && `Waited for: ${waits}`);
}

function option(basics, rows) {
  const shade = (state) => ({ color: colour(state), borderColor: colour('paper'), borderWidth: 1 });
  return {
    ...basics,
    grid: { left: 150, right: 24, top: 40, bottom: 28 },
    legend: { ...basics.legend, top: 0, left: 150, data: [...STATES, { name: 'use', icon: 'diamond' }] },
    tooltip: { ...basics.tooltip, trigger: 'axis', axisPointer: { type: 'shadow' }, formatter: ([first]) => hover(rows[first.dataIndex]) },
    xAxis: { ...basics.axis, type: 'value', max: 1, axisLabel: { ...basics.axis.axisLabel, formatter: (v) => `${Math.round(100 * v)} %` } },
    yAxis: { ...basics.axis, type: 'category', inverse: true, data: rows.map((r) => r.name), axisLabel: { ...basics.axis.axisLabel, color: colour('ink') }, splitLine: { show: false } },
    series: [
      ...STATES.map((state, i) => ({
        name: state, type: 'bar', stack: 'cycles', barWidth: '68%', itemStyle: shade(state), cursor: 'pointer',
        data: rows.map((r) => r.states[i] / r.total),
      })),
      {
        name: 'use', type: 'scatter', symbol: 'diamond', symbolSize: 11, z: 5, cursor: 'pointer',
        itemStyle: { color: colour('paper'), borderColor: colour('ink'), borderWidth: 1.5 }, data: rows.map((r) => r.use),
      },
    ],
  };
}

const share = (value, total) => h('span', { class: 'share' }, h('i', { style: `width:${Math.min(100, (100 * value) / total).toFixed(1)}%` }), h('b', null, percent(value / total)));

const RESOURCES = {
  rate: { key: 'least_cycles', text: ['rate', 'Cycles that the counted work takes at the peak rate'] },
  loss: { key: 'lost_cycles', text: ['loss', "Cycles in which a rate's resource could not work"] },
  places: { key: 'full_cycles', text: ['places', 'Cycles in which all of them were taken'] },
};

/** Resources of a kind, its units added up. */
function resourcesOf(units) {
  const all = new Map();
  for (const [, unit] of units) {
    for (const [name, { kind, ...cycles }] of Object.entries(unit.resources)) {
      const one = all.get(name) ?? { name, kind, cycles: 0, total: 0, units: 0 };
      all.set(name, { ...one, cycles: one.cycles + cycles[RESOURCES[kind].key], total: one.total + unit.cycles, units: one.units + 1 });
    }
  }
  return [...all.values()];
}

/** All that is known of a row: waits by port, resources, counters. */
function details(figures, r) {
  const resources = resourcesOf(r.units);
  const names = [...new Set(r.units.flatMap(([, u]) => Object.keys(u.counters)))];
  return [
    h('div', null, panel('Waited for', r.waits.length === 0 ? h('p', { class: 'soft' }, 'nothing') : table('unit-waits', [
      { title: 'port', of: ([port]) => port },
      { title: 'cycles', number: true, of: ([, cycles]) => number(cycles) },
      { title: 'of its cycles', of: ([, cycles]) => share(cycles, r.total) },
    ], r.waits)),
    panel('Resources', resources.length === 0 ? h('p', { class: 'soft' }, 'none that could limit it') : table('unit-resources', [
      { title: 'resource', of: (x) => words(x.name) },
      { title: 'what', of: (x) => explained(...RESOURCES[x.kind].text) },
      { title: r.units.length > 1 ? 'cycles, mean' : 'cycles', number: true, of: (x) => number(x.cycles / x.units) },
      { title: 'of its cycles', of: (x) => share(x.cycles, x.total) },
    ], resources))),
    panel('Counters', table('unit-counters', [
      { title: 'counter', of: (name) => counter(figures, r.kind, name) },
      { title: 'count', number: true, of: (name) => number(sum(r.units.map(([, u]) => u.counters[name] ?? 0)), integer) },
      { title: 'unit', of: (name) => figures.counter_definitions[r.kind]?.[name]?.unit ?? '' },
    ], names)),
  ];
}

export function units({ figures, order }) {
  const kinds = kindsOf(figures, order);
  const state = { rows: rowsOf(kinds, true) };
  const height = () => 26 * state.rows.length + 76;
  const made = chart('units-chart', height(), 'Cycles of every unit: busy, waiting, starved, blocked, idle', (basics) => option(basics, state.rows));
  const box = h('div', { class: 'panels', id: 'unit-details' });
  const select = h('select', { id: 'unit', onchange: () => look(select.selectedIndex) });
  const look = (i) => {
    select.selectedIndex = i;
    box.replaceChildren(...details(figures, state.rows[i]));
  };
  const list = (folded) => {
    state.rows = rowsOf(kinds, folded);
    select.replaceChildren(...state.rows.map((r) => h('option', null, r.name)));
    made.host.style.height = `${height()}px`;
    made.refresh();
    look(Math.max(0, state.rows.findIndex((r) => r.kind === figures.limit?.name)));
  };
  made.ready((instance) => instance.on('click', ({ dataIndex }) => look(dataIndex)));
  const folding = choice('Rows', [{ value: 'kinds', text: 'By kind' }, { value: 'all', text: 'Every unit' }], 'kinds', (value) => list(value === 'kinds'));
  list(true);
  const states = STATES.flatMap((s) => [explained(s, definition(s)), ', ']);
  return section('units', 'Where the time went',
    ['Every cycle of a unit is counted once: ', ...states.slice(0, -1), '. The diamond is its ', term('use'), ': at 100 % the unit could not be faster.'],
    folding.element, made.host,
    h('p', { class: 'pick' }, h('label', { for: 'unit' }, 'Details of '), select, h('span', { class: 'soft' }, ' or click a bar')), box);
}
