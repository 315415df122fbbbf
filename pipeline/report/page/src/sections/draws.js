// Every draw of the frame: a table to sort and filter, and all that is known of the draw chosen.
import { h } from '../dom.js';
import { sum } from '../data.js';
import { decimal, integer, number, percent, ratio, unitOrLink, words } from '../format.js';
import { added, grid, numberColumn, textColumn } from '../grid.js';
import { panel, section, table } from '../layout.js';
import { explained, term } from '../terms.js';

/** Draws as flat rows. */
function rowsOf(figures) {
  const { parameters } = figures.machine;
  const simds = parameters['gpu.cores'] * parameters['core.simds'];
  return figures.draws.map((draw, number_) => ({
    number: number_, label: draw.label, shader: draw.shaders.fragment, pass: draw.pass, cycles: draw.cycles_in_flight, issued: draw.issued,
    triangles: draw.triangles.in, drawn: draw.triangles.drawn, vertices: draw.vertices.shaded,
    covered: draw.fragments.covered, killed_early: draw.fragments.killed_early, shaded: draw.fragments.shaded,
    written: draw.fragments.written, texels: draw.texture.texels, misses: draw.texture.cache_misses,
    l2_bytes: sum(Object.entries(draw.bytes).filter(([name]) => name !== 'memory').map(([, n]) => n)), memory: draw.bytes.memory,
    limiter: draw.limiter.kind, unit: draw.limiter.unit, least: draw.limiter.work_cycles, share: draw.limiter.share,
    simds: ratio(draw.busy.core ?? 0, simds * draw.cycles_in_flight), most: draw.occupancy.fragment.most_warps, keeps: draw.occupancy.fragment.limit, draw,
  }));
}

/** A filter of a column by one of the words in it. */
function wordFilter(words_) {
  return (_cell, _rendered, success) => {
    const select = h('select', { 'aria-label': 'limiter', onchange: () => success(select.value) },
      h('option', { value: '' }, 'all'), words_.map((word) => h('option', { value: word }, word)));
    return select;
  };
}

function columns(figures, rows) {
  const kinds = [...new Set(rows.map((row) => row.limiter))].sort();
  const passes = new Set(rows.map((row) => row.pass)).size;
  const all = [
    { ...numberColumn('#', 'number', integer, { width: 64, headerFilter: false, headerTooltip: 'Number of the draw, in the order of the commands' }), frozen: true },
    textColumn('draw', 'label', { width: 280, frozen: true, bottomCalc: () => 'sum of those shown', headerTooltip: 'As the scene or the trace names it' }),
    numberColumn('in flight', 'cycles', integer, { width: 104 }),
    textColumn('limiter', 'limiter', { width: 136, headerFilter: wordFilter(kinds), headerFilterFunc: '=', headerFilterEmptyCheck: (value) => !value }),
    numberColumn('share', 'share', percent, { width: 84, headerFilter: false }),
    numberColumn('least time', 'least', integer, { width: 112 }),
    numberColumn('triangles', 'triangles', integer, { width: 108, headerTooltip: 'Assembled', ...added() }),
    numberColumn('drawn', 'drawn', integer, { width: 96, headerTooltip: 'Triangles handed to the rasteriser, pieces of cut ones counted each', ...added() }),
    numberColumn('vertices', 'vertices', integer, { width: 104, headerTooltip: 'Vertices shaded', ...added() }),
    numberColumn('covered', 'covered', integer, { width: 108, ...added() }),
    numberColumn('killed early', 'killed_early', integer, { width: 118, ...added() }),
    numberColumn('shaded', 'shaded', integer, { width: 104, ...added() }),
    numberColumn('written', 'written', integer, { width: 104, ...added() }),
    numberColumn('texels', 'texels', integer, { width: 116, ...added() }),
    numberColumn('cache misses', 'misses', integer, { width: 122, headerTooltip: 'Look-ups that missed the first-level texture cache', ...added() }),
    numberColumn('L2 bytes', 'l2_bytes', integer, { width: 116, headerTooltip: 'Bytes asked of the L2 cache and written to it', ...added() }),
    numberColumn('memory bytes', 'memory', integer, { width: 130, headerTooltip: "Bytes read by the memory channels because of the draw's misses in the L2 cache", ...added() }),
    numberColumn('SIMDs held', 'simds', percent, { width: 112, headerFilter: false }),
    numberColumn('most warps', 'most', integer, { width: 116, headerFilter: false }),
    textColumn('fragment shader', 'shader', { width: 190, headerTooltip: 'As the scene or the trace names it' }),
    textColumn('kept out by', 'keeps', { width: 186 }),
    numberColumn('issued', 'issued', integer, { width: 106, headerFilter: false, headerTooltip: 'GPU cycle at which the command processor issued it' }),
  ];
  if (passes > 1) all.splice(2, 0, numberColumn('pass', 'pass', integer, { width: 64, headerFilterFunc: '=' }));
  return all;
}

/** The units that worked for a draw, and every count of it. */
function details({ draw, number: at }) {
  const kinds = Object.keys(draw.work).sort((a, b) => draw.work[b] - draw.work[a]);
  const counts = Object.entries(draw).filter(([, value]) => typeof value === 'object')
    .filter(([group]) => !['shaders', 'busy', 'work', 'limiter', 'occupancy', 'path'].includes(group))
    .flatMap(([group, of]) => Object.entries(of).map(([name, value]) => ({ name: `${words(group)}: ${words(name)}`, value })));
  return [
    h('h3', { id: 'draw-name' }, `${at}: ${draw.label}`),
    h('p', { class: 'soft' }, `issued at ${integer(draw.issued)}, retired at ${integer(draw.retired)}: ${integer(draw.cycles_in_flight)} cycles in flight`),
    h('p', { class: 'soft', id: 'draw-shaders' }, `shaders ${draw.shaders.vertex} and ${draw.shaders.fragment}`),
    h('p', { class: 'soft', id: 'draw-occupancy' }, term('most warps', 'Warps that a core can hold'), `: ${integer(draw.occupancy.fragment.most_warps)} of its fragments (${draw.occupancy.fragment.limit}) or ${integer(draw.occupancy.vertex.most_warps)} of its vertices (${draw.occupancy.vertex.limit})`),
    h('div', { class: 'panels' },
      panel('Work by unit', table('draw-work', [
        { title: 'kind', of: (kind) => words(kind) },
        { title: explained('least time', 'GPU cycles that the busiest unit of the kind needs for the work at peak rates'), number: true, of: (kind) => number(draw.work[kind], decimal) },
        { title: explained('busy', 'Cycles, summed over the units of the kind; of cores those of their SIMD units'), number: true, of: (kind) => number(draw.busy[kind] ?? 0) },
        { title: 'of the time in flight', of: (kind) => h('span', { class: 'share' }, h('i', { style: `width:${Math.min(100, 100 * ratio(draw.work[kind], draw.cycles_in_flight) || 0).toFixed(1)}%` }), h('b', null, percent(ratio(draw.work[kind], draw.cycles_in_flight)))) },
      ], kinds)),
      draw.path && panel('What its end waited for', table('draw-path', [
        { title: 'unit or link', of: ([of]) => unitOrLink(of) },
        { title: 'cycles', number: true, of: ([, cycles]) => number(cycles) },
        { title: 'of the time in flight', number: true, of: ([, cycles]) => percent(ratio(cycles, draw.cycles_in_flight)) },
      ], Object.entries(draw.path).filter(([, cycles]) => cycles > 0).sort(([, a], [, b]) => b - a))),
      panel('Counts', table('draw-counts', [{ title: 'what', of: (c) => c.name }, { title: 'count', number: true, of: (c) => number(c.value) }], counts))),
  ];
}

/** What belongs to no draw. */
function outside(figures) {
  const groups = Object.entries(figures.outside_draws).filter(([name]) => name !== 'busy');
  const counts = groups.flatMap(([group, of]) => Object.entries(of).filter(([, n]) => n > 0).map(([name, n]) => `${words(group)} ${words(name)} ${integer(n)}`));
  return counts.length === 0 ? null
    : h('p', { class: 'soft' }, explained('Outside of draws', 'Clears, bounds of passes, scan-out, what the L2 cache writes back to memory'), ': ', counts.join(' · '));
}

export function draws({ figures }) {
  if (!figures.draws?.length) return null;
  const rows = rowsOf(figures);
  const box = h('div', { id: 'draw-details' });
  const count = h('span', { class: 'soft', id: 'draws-shown' });
  const made = grid('draws-table', columns(figures, rows), rows, Math.min(560, 130 + 32 * rows.length), {
    initialSort: [{ column: 'cycles', dir: 'desc' }], selectableRows: 1, columnCalcs: 'table', layout: 'fitData',
  });
  made.onMade = (created) => {
    created.on('rowSelected', (row) => box.replaceChildren(...details(row.getData())));
    created.on('dataFiltered', (_filters, shown) => { count.textContent = `${integer(shown.length)} of ${integer(rows.length)} draws`; });
    created.on('tableBuilt', () => created.getRows('active')[0]?.select());
  };
  count.textContent = `${integer(rows.length)} of ${integer(rows.length)} draws`;
  const clear = h('button', { type: 'button', class: 'quiet', onclick: () => made.table.clearHeaderFilter() }, 'Clear filters');
  const pick = h('label', null, 'Draw ', h('input', { type: 'number', id: 'draw', min: 0, max: rows.length - 1, value: 0, onchange: (event) => {
    const row = rows[Number(event.target.value)];
    if (row) box.replaceChildren(...details(row));
  } }));
  return section('draws', 'Draws',
    ['Click a heading to sort, type below it to filter, click a row for all that is known of it. Draws overlap, so their cycles ', term('in flight'), ' are more than those of the frame.'],
    h('p', { class: 'pick' }, count, clear, pick), made.host, outside(figures), box);
}
