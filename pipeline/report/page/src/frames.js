// The page of a row of frames: the curve, every frame with what limits it, the slowest.
import { chart, tip } from './chart.js';
import { greatest, least, sum } from './data.js';
import { h } from './dom.js';
import { bytes, decimal, integer, number, percent, ratio } from './format.js';
import { grid, numberColumn, textColumn } from './grid.js';
import { panel, section, showPage } from './layout.js';
import { machineName, shortName } from './report.js';
import { term } from './terms.js';
import { colour } from './theme.js';

const MOST_SLOW = 5;

const cyclesOf = (f) => f.figures.cycles;
const momentOf = (f) => [f.time_s !== null && `${decimal(f.time_s)} s`, f.turn !== null && `${percent(f.turn)} of the turn`].filter(Boolean).join(', ');
const limitOf = (f) => f.limit.name;

function card(title, value, format, ...more) {
  return h('div', { class: 'card' }, h('h3', null, title), h('div', { class: 'value' }, number(value, format)), more.map((text) => text && h('p', { class: 'soft' }, text)));
}

function overview(d, slowest) {
  const { frames, cycles } = d;
  const fps = (all) => ratio(1e6 * cycles.clock_mhz * frames.length, all);
  return section('overview', 'The frames', null,
    h('div', { class: 'cards' },
      card('Frames', frames.length, integer, d.animation_s !== null ? `of ${decimal(d.animation_s)} s of animation` : frames[0].turn !== null ? 'around the scene' : 'of a capture'),
      card('Mean cycles of a frame', sum(frames.map(cyclesOf)) / frames.length, integer, `${integer(least(frames.map(cyclesOf)))} to ${integer(greatest(frames.map(cyclesOf)))}`),
      card('Slowest frame', slowest.frame, integer, `${integer(cyclesOf(slowest))} cycles`, momentOf(slowest)),
      card(term('one after another', 'Frames a second, one after another'), fps(cycles.one_after_another), decimal),
      card(term('overlapped', 'Frames a second, overlapped'), fps(cycles.overlapped), decimal)),
    d.notes.length > 0 && panel('To note', h('ul', null, d.notes.map((note) => h('li', null, note)))));
}

/** Cycles of every frame: drawing, and scan-out after it. */
function curve(d, look) {
  const { frames } = d;
  const made = chart('frames-chart', 320, 'Cycles of every frame', (basics) => ({
    ...basics,
    grid: { left: 80, right: 20, top: 36, bottom: 78 },
    legend: { ...basics.legend, top: 0, left: 0 },
    tooltip: {
      ...basics.tooltip, trigger: 'axis', axisPointer: { type: 'shadow' },
      formatter: ([{ dataIndex }]) => {
        const f = frames[dataIndex];
        return tip(`Frame ${f.frame}`, [['cycles', integer(cyclesOf(f))], ['drawing', integer(f.figures.render_cycles), colour('busy')], ['scan-out', integer(f.figures.scan_out_cycles), colour('accent')], ['limit', limitOf(f)]], momentOf(f));
      },
    },
    dataZoom: [{ type: 'inside' }, { type: 'slider', bottom: 6, height: 18 }],
    xAxis: { ...basics.axis, type: 'category', data: frames.map((f) => f.frame), name: 'frame', nameLocation: 'middle', nameGap: 26, splitLine: { show: false } },
    yAxis: { ...basics.axis, type: 'value', name: 'cycles', nameTextStyle: { ...basics.axis.nameTextStyle, align: 'right' } },
    series: [
      { name: 'drawing', type: 'bar', stack: 'cycles', barCategoryGap: '8%', cursor: 'pointer', itemStyle: { color: colour('busy') }, data: frames.map((f) => f.figures.render_cycles) },
      { name: 'scan-out', type: 'bar', stack: 'cycles', cursor: 'pointer', itemStyle: { color: colour('accent') }, data: frames.map((f) => f.figures.scan_out_cycles) },
    ],
  }));
  made.ready((instance) => instance.on('click', ({ dataIndex }) => look(dataIndex)));
  return made.host;
}

/** A frame's picture, and what to type to see all of it. */
function details(d, f) {
  const picture = d.pictures[f.frame];
  return [
    h('h3', { id: 'frame-name' }, `Frame ${f.frame}${momentOf(f) ? `: ${momentOf(f)}` : ''}`),
    picture ? h('img', { id: 'frame-picture', alt: `Frame ${f.frame}`, src: picture, style: 'max-width:100%' }) : h('p', { class: 'soft' }, 'The picture of this frame is not in the page, which would be too large.'),
    h('p', null, f.limit.text),
    f.notes.length > 0 && h('ul', null, f.notes.map((note) => h('li', null, note))),
    f.time_s !== null && f.turn === null && h('p', { class: 'soft' }, 'All that is known of it: ', h('code', null, `quadrille render ${d.scene} --time ${f.time_s} --report frame.html`)),
  ];
}

function table(d, look) {
  const rows = d.frames.map((f, at) => ({
    number: f.frame, moment: momentOf(f), cycles: cyclesOf(f), drawing: f.figures.render_cycles, scan: f.figures.scan_out_cycles, draws: f.figures.draws,
    triangles: f.figures.triangles, shaded: f.figures.fragments_shaded, memory: f.figures.memory_bytes, limit: limitOf(f), share: f.limit.share, at,
  }));
  const made = grid('frames-table', [
    numberColumn('#', 'number', integer, { width: 70, headerFilter: false }), textColumn('moment', 'moment', { width: 150 }),
    numberColumn('cycles', 'cycles', integer, { width: 120 }), numberColumn('drawing', 'drawing', integer, { width: 120, headerFilter: false }), numberColumn('scan-out', 'scan', integer, { width: 110, headerFilter: false }),
    numberColumn('draws', 'draws', integer, { width: 90 }), numberColumn('triangles', 'triangles', integer, { width: 110 }), numberColumn('shaded', 'shaded', integer, { width: 120 }),
    numberColumn('memory bytes', 'memory', bytes, { width: 130, headerFilter: false }), textColumn('limit', 'limit', { width: 220 }), numberColumn('part', 'share', percent, { width: 90, headerFilter: false }),
  ], rows, Math.min(520, 130 + 32 * rows.length), { selectableRows: 1, layout: 'fitData' });
  made.onMade = (created) => created.on('rowSelected', (row) => look(row.getData().at));
  return made.host;
}

export function showFrames(d) {
  const slow = [...d.frames].sort((a, b) => cyclesOf(b) - cyclesOf(a)).slice(0, MOST_SLOW);
  const box = h('div', { id: 'frame-details' });
  const look = (at) => box.replaceChildren(...details(d, d.frames[at]).filter(Boolean));
  look(d.frames.indexOf(slow[0]));
  const link = (f) => h('li', null, h('a', { href: '#one', onclick: () => look(d.frames.indexOf(f)) }, `frame ${f.frame}`), `: ${integer(cyclesOf(f))} cycles${momentOf(f) ? `, ${momentOf(f)}` : ''}, ${limitOf(f)}`);
  const { width, height } = d.frames[0].figures;
  showPage(h('span', { title: d.scene }, shortName(d.scene)), `${d.frames.length} frames of ${width} x ${height} · machine ${machineName(d.machine)} · ${d.fidelity}`, [
    overview(d, slow[0]),
    section('curve', 'Cycles of every frame', 'Each frame is simulated by itself. Click a bar, or a row below, to see the frame.', curve(d, look)),
    section('slowest', 'The slowest', null, h('ol', { id: 'slowest-list' }, slow.map(link))),
    section('one', 'One frame', null, box),
    section('frames', 'All frames', 'Click a heading to sort, type below it to filter, click a row to see the frame.', table(d, look)),
  ]);
}
