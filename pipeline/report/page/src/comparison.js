// The page of two frames: what differs, the largest first.
import { chart, tip } from './chart.js';
import { greatest } from './data.js';
import { choice, h } from './dom.js';
import { brief, bytes, decimal, integer, number, percent, ratio, unitOrLink, words } from './format.js';
import { grid, numberColumn, textColumn } from './grid.js';
import { section, showPage, table } from './layout.js';
import { colour } from './theme.js';
import { explained, term } from './terms.js';

const OURS = ['#0072b2', '#e69f00']; // A and B, which the colour-blind tell apart

const signed = (format) => (n) => (n > 0 ? `+${format(n)}` : format(n));
const part = ({ a, difference }) => (a === 0 ? (difference === 0 ? '' : 'new') : signed(percent)(difference / Math.abs(a)));

/** Columns of a pair of numbers: A, B, the difference, and its part of A. */
const pairColumns = (of, format = integer) => [
  { title: 'A', number: true, of: (row) => number(of(row).a, format) },
  { title: 'B', number: true, of: (row) => number(of(row).b, format) },
  { title: 'difference', number: true, of: (row) => number(of(row).difference, signed(format)) },
  { title: 'of A', number: true, of: (row) => part(of(row)) },
];

function card(title, pair, format, id) {
  return h('div', { class: 'card' }, h('h3', null, title),
    h('div', { class: 'value', id, 'data-value': pair.difference }, part(pair) || 'equal'),
    h('p', null, `${format(pair.a)} → ${format(pair.b)}`),
    h('p', { class: 'soft' }, signed(format)(pair.difference)));
}

function overview(c) {
  const side = (letter, s) => h('p', null, h('b', { class: `side ${letter}` }, letter.toUpperCase()), ` ${s.file}: ${s.scene}, ${s.width} x ${s.height}, machine ${s.machine}, ${s.fidelity}`);
  const { frame } = c;
  return section('overview', 'What differs', null, side('a', c.a), side('b', c.b),
    c.notes.length > 0 && h('ul', { class: 'soft' }, c.notes.map((note) => h('li', null, note))),
    h('div', { class: 'cards' },
      card(term('cycles', 'Time in cycles'), frame.cycles, integer, 'cycles'),
      card(term('speed of light', 'Least cycles'), frame.least_cycles, integer),
      card('Bytes of memory', frame.memory_bytes, bytes),
      frame.fragments_shaded && card(term('shaded', 'Fragments shaded'), frame.fragments_shaded, brief),
      frame.vertices && card('Vertices shaded', frame.vertices, brief)),
    h('p', null, h('b', { class: 'side a' }, 'A'), ' ', term('limit'), `: ${c.a.limit}`), h('p', null, h('b', { class: 'side b' }, 'B'), ' ', term('limit'), `: ${c.b.limit}`));
}

function parameters(c) {
  return section('parameters', 'Parameters that differ', c.parameters.length === 0 ? 'The machines have the same parameters.' : null,
    c.parameters.length > 0 && table('parameters-table', [
      { title: 'parameter', of: (p) => h('code', null, p.path) },
      { title: 'A', number: true, of: (p) => String(p.a ?? '-') }, { title: 'B', number: true, of: (p) => String(p.b ?? '-') },
    ], c.parameters));
}

function unitsChart(rows) {
  const states = [['own', 'own time'], ['starved', 'starved'], ['blocked', 'blocked'], ['idle', 'idle']];
  const shade = { own: 'busy', starved: 'starved', blocked: 'blocked', idle: 'idle' };
  return chart('units-chart', 42 * rows.length + 76, 'Mean cycles of every kind of unit in A and in B', (basics) => ({
    ...basics,
    grid: { left: 150, right: 24, top: 40, bottom: 28 },
    legend: { ...basics.legend, top: 0, left: 150, data: states.map(([, name]) => name) },
    tooltip: {
      ...basics.tooltip, trigger: 'axis', axisPointer: { type: 'shadow' },
      formatter: ([{ dataIndex }]) => tip(words(rows[dataIndex].kind), [['', 'A → B'], ...states.map(([key, name]) => [name, `${integer(rows[dataIndex][key].a)} → ${integer(rows[dataIndex][key].b)}`, colour(shade[key])])], 'The upper bar is A, the lower one B.'),
    },
    xAxis: { ...basics.axis, type: 'value', axisLabel: { ...basics.axis.axisLabel, formatter: brief } },
    yAxis: { ...basics.axis, type: 'category', inverse: true, data: rows.map((r) => words(r.kind)), axisLabel: { ...basics.axis.axisLabel, color: colour('ink') }, splitLine: { show: false } },
    series: ['a', 'b'].flatMap((side) => states.map(([key, name]) => ({
      name, type: 'bar', stack: side, barGap: '12%', barCategoryGap: '28%', itemStyle: { color: colour(shade[key]), opacity: side === 'a' ? 0.62 : 1 }, data: rows.map((r) => r[key][side]),
    }))),
  }));
}

function units(c) {
  const many = ({ units: n }) => (n.a === n.b ? `x${n.a}` : `x${n.a}, x${n.b}`);
  const change = (key) => ({ title: term(key), number: true, of: (u) => number(u[key].difference, signed(integer)) });
  return section('units', 'By unit',
    ['Mean cycles of a unit, by the change of its ', explained('own time', 'Busy and waiting: what the unit works, and waits for itself. Starved and blocked follow from other units.'), ', largest first. Of each pair of bars the pale one is A, the full one B.'],
    unitsChart(c.units).host,
    table('units-table', [
      { title: 'unit', of: (u) => [words(u.kind), h('span', { class: 'soft' }, ` ${many(u)}`)] },
      { title: 'own time', number: true, of: (u) => [number(u.own.a), ' → ', number(u.own.b)] },
      { title: 'difference', number: true, of: (u) => number(u.own.difference, signed(integer)) },
      ...['busy', 'waiting', 'starved', 'blocked', 'idle'].map(change),
      { title: term('use'), number: true, of: (u) => `${percent(u.use.a)} → ${percent(u.use.b)}` },
    ], c.units));
}

const path = (c) => !c.critical_path?.length ? null : section('path', 'What the ends waited for',
  ['Both ', term('critical path'), 's add up to their frames, so the differences add up to that of the cycles.'],
  table('path-table', [{ title: 'unit or link', of: (p) => unitOrLink(p.of) }, { title: 'part', of: (p) => p.part },
    { title: 'who waited', of: (p) => (p.of === p.by ? '' : words(p.by)) }, ...pairColumns((p) => p.cycles, integer)], c.critical_path));

function resources(c) {
  const rows = c.resources.slice(0, 16);
  if (rows.length === 0) return null;
  const made = chart('uses-chart', 34 * rows.length + 60, 'Use of resources in A and B', (basics) => ({
    ...basics,
    grid: { left: 210, right: 50, top: 34, bottom: 8 },
    legend: { ...basics.legend, top: 0, left: 0 },
    tooltip: { ...basics.tooltip, trigger: 'axis', axisPointer: { type: 'shadow' }, formatter: ([{ dataIndex }]) => tip(rows[dataIndex].name, [['A', percent(rows[dataIndex].use.a), OURS[0]], ['B', percent(rows[dataIndex].use.b), OURS[1]]]) },
    xAxis: { ...basics.axis, type: 'value', min: 0, max: 1, axisLabel: { show: false } },
    yAxis: { ...basics.axis, type: 'category', inverse: true, data: rows.map((r) => r.name), axisLabel: { ...basics.axis.axisLabel, color: colour('ink') }, splitLine: { show: false } },
    series: ['a', 'b'].map((side, i) => ({
      name: side.toUpperCase(), type: 'bar', barGap: '8%', itemStyle: { color: OURS[i] }, data: rows.map((r) => r.use[side]),
      label: { show: true, position: 'right', color: colour('soft'), fontSize: 11, formatter: ({ value }) => percent(value) },
    })),
  }));
  return section('resources', 'Use of resources', [term('use'), ' of rates and links, by the change.'], made.host);
}

const bandwidth = (c) => section('bandwidth', 'Bytes by client', null,
  table('bandwidth-table', [{ title: 'client', of: (b) => words(b.client) }, ...pairColumns((b) => b.bytes, bytes)], c.bandwidth));

function draws(c) {
  if (!c.draws?.length) return null;
  const rows = c.draws.map((d) => ({
    number: d.number.a ?? d.number.b, label: d.label, a: d.cycles.a, b: d.cycles.b, difference: d.cycles.difference, size: Math.abs(d.cycles.difference),
    change: ratio(d.cycles.difference, d.cycles.a), least: d.least.difference, shaded: d.shaded.difference, memory: d.memory.difference,
    limiter: d.limiter.a === d.limiter.b ? d.limiter.a : `${d.limiter.a || '-'} → ${d.limiter.b || '-'}`,
  }));
  const made = grid('draws-table', [
    numberColumn('#', 'number', integer, { width: 64, headerFilter: false }), textColumn('draw', 'label', { width: 300 }),
    numberColumn('in flight, A', 'a', integer, { width: 120 }), numberColumn('in flight, B', 'b', integer, { width: 120 }),
    numberColumn('difference', 'difference', signed(integer), { width: 124, headerFilter: false }), numberColumn('size', 'size', integer, { width: 110, headerTooltip: 'Size of the difference' }),
    numberColumn('of A', 'change', signed(percent), { width: 92, headerFilter: false }), numberColumn('least time', 'least', signed(decimal), { width: 118, headerFilter: false, headerTooltip: 'Change of the least time of its work' }),
    numberColumn('shaded', 'shaded', signed(integer), { width: 110, headerFilter: false }), numberColumn('memory bytes', 'memory', signed(integer), { width: 136, headerFilter: false }),
    textColumn('limiter', 'limiter', { width: 180 }),
  ], rows, Math.min(520, 90 + 32 * rows.length), { initialSort: [{ column: 'size', dir: 'desc' }], layout: 'fitData' });
  return section('draws', 'By draw', ['By the change of the cycles ', term('in flight'), '. Draws overlap, so the changes do not add up to that of the frame.'], made.host);
}

/** Squares that shrank, stayed, and grew: blue and orange, which the colour-blind tell apart. */
const CHANGE = { light: ['#00429d', '#73a2c6', '#f4f4f4', '#e4976c', '#93003a'], dark: ['#5aa9ff', '#2c5f8f', '#20262f', '#96502c', '#ffa05a'] };

function tiles(c) {
  if (!c.tiles) return null;
  const { width, height, tile_pixels: side, counts } = c.tiles;
  const keys = Object.keys(counts);
  const state = { shown: keys[0] };
  const total = h('p', { id: 'tiles-total' });
  const made = chart('tiles-chart', 100, 'Difference by squares of the screen', (basics) => {
    const { squares } = counts[state.shown];
    const most = greatest(squares.map(Math.abs), 1);
    return {
      ...basics, aria: { enabled: false }, grid: { left: 0, top: 0, right: 0, bottom: 0 },
      xAxis: { type: 'category', show: false, data: Array.from({ length: width }, (_, i) => i) },
      yAxis: { type: 'category', show: false, inverse: true, data: Array.from({ length: height }, (_, i) => i) },
      visualMap: { type: 'continuous', min: -most, max: most, dimension: 2, show: false, inRange: { color: CHANGE[document.documentElement.dataset.theme] } },
      tooltip: { ...basics.tooltip, formatter: ({ data }) => tip(signed(integer)(data[2]), [], `${words(state.shown)}, square at ${data[0] * side}, ${data[1] * side}`) },
      series: [{ type: 'heatmap', progressive: 0, data: squares.map((value, at) => [at % width, Math.floor(at / width), value]) }],
    };
  });
  made.host.style.cssText = `aspect-ratio:${width}/${height}; height:auto; max-width:60rem`;
  const show = (key) => {
    state.shown = key;
    const { total: pair } = counts[key];
    total.replaceChildren(number(pair.a), ' → ', number(pair.b), ' in all squares: ', number(pair.difference, signed(integer)), ` (${part(pair)})`);
    made.refresh();
  };
  const pick = choice('Count', keys.map((key) => ({ value: key, text: words(key) })), keys[0], show);
  show(keys[0]);
  return section('tiles', 'By square of the screen', 'Orange squares have more in B, blue ones less.', pick.element, total, made.host);
}

function counters(c) {
  if (c.counters.length === 0) return null;
  const rows = c.counters.map((x) => ({ path: `${x.kind}.${x.name}`, a: x.a, b: x.b, difference: x.difference, change: ratio(x.difference, x.a) }));
  const made = grid('counters-table', [
    textColumn('counter', 'path', { width: 340 }), numberColumn('A', 'a', integer, { width: 150 }), numberColumn('B', 'b', integer, { width: 150 }),
    numberColumn('difference', 'difference', signed(integer), { width: 150, headerFilter: false }), numberColumn('of A', 'change', signed(percent), { width: 110, headerFilter: false }),
  ], rows, Math.min(460, 90 + 32 * rows.length), { layout: 'fitData' });
  return section('counters', 'Counters that differ', 'All units of a kind together; those first that changed by the greatest factor.', made.host);
}

const rest = (c) => section('frame', 'Counts of the frame', null,
  table('frame-table', [{ title: 'count', of: ([key]) => words(key) }, ...pairColumns(([, pair]) => pair, brief)], Object.entries(c.frame)));

export function showComparison(c) {
  showPage('Two frames compared', `${c.a.file} and ${c.b.file}`,
    [overview, parameters, path, units, draws, tiles, bandwidth, resources, counters, rest].map((make) => make(c)).filter(Boolean));
}
