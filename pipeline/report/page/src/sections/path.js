// The chain of waits that the frame's end hangs on, by unit and link, of the frame or of one draw.
import { chart, tip } from '../chart.js';
import { h } from '../dom.js';
import { decimal, integer, number, percent, unitOrLink } from '../format.js';
import { panel, section, table } from '../layout.js';
import { colour } from '../theme.js';
import { explained, term } from '../terms.js';

const PARTS = [
  { part: 'busy', state: 'busy', text: "A unit's initiation slot was in use" },
  { part: 'waiting', state: 'waiting', text: 'A unit waited for its own latency, or a timer' },
  { part: 'link', state: 'blocked', text: 'A token, or the room that one left, was on its way' },
];
/** Rows below this share of the path are only in the table. */
const LEAST = 0.002;

/** By unit or link: cycles of each part, the longest first. */
function rowsOf(path) {
  const rows = new Map();
  for (const { of, part, cycles } of path.parts) {
    const row = rows.get(of) ?? { of, name: unitOrLink(of), cycles: 0, parts: {} };
    row.parts[part] = (row.parts[part] ?? 0) + cycles;
    row.cycles += cycles;
    rows.set(of, row);
  }
  return [...rows.values()].sort((a, b) => b.cycles - a.cycles);
}

function option(basics, { rows, cycles }) {
  const shown = rows.filter((row) => row.cycles >= LEAST * cycles);
  const hover = (row) => tip(row.name, PARTS.filter(({ part }) => row.parts[part])
    .map(({ part, state }) => [part, `${integer(row.parts[part])} cycles, ${percent(row.parts[part] / cycles)}`, colour(state)]));
  return {
    ...basics,
    grid: { left: 210, right: 24, top: 40, bottom: 28 },
    legend: { ...basics.legend, top: 0, left: 210, data: PARTS.map(({ part }) => part) },
    tooltip: { ...basics.tooltip, trigger: 'axis', axisPointer: { type: 'shadow' }, formatter: ([first]) => hover(shown[first.dataIndex]) },
    xAxis: { ...basics.axis, type: 'value', axisLabel: { ...basics.axis.axisLabel, formatter: (v) => `${Math.round(100 * v)} %` } },
    yAxis: { ...basics.axis, type: 'category', inverse: true, data: shown.map((row) => row.name), axisLabel: { ...basics.axis.axisLabel, color: colour('ink') }, splitLine: { show: false } },
    series: PARTS.map(({ part, state }) => ({
      name: part, type: 'bar', stack: 'path', barWidth: '68%', itemStyle: { color: colour(state), borderColor: colour('paper'), borderWidth: 1 },
      data: shown.map((row) => (row.parts[part] ?? 0) / cycles),
    })),
  };
}

const rowsTable = ({ rows, cycles }) => table('path-parts', [
  { title: 'unit or link', of: (row) => row.name },
  ...PARTS.map(({ part, text }) => ({ title: explained(part, text), number: true, of: (row) => number(row.parts[part] ?? 0, decimal) })),
  { title: 'of the path', number: true, of: (row) => percent(row.cycles / cycles) },
], rows);

export function path({ figures }) {
  const whole = figures.critical_path;
  if (!whole || whole.cycles === 0) return null;
  const draws = whole.draws.filter(({ draw }) => draw !== null && figures.draws);
  const label = ({ draw }) => `${draw}: ${figures.draws[draw].label}`;
  const state = { rows: rowsOf(whole), cycles: whole.cycles };
  const made = chart('path-chart', 420, 'Cycles of the critical path by unit and link', (basics) => option(basics, state));
  const box = h('div', { id: 'path-box' }, rowsTable(state));
  const total = h('span', { class: 'soft', id: 'path-cycles' });
  const look = (of) => {
    Object.assign(state, { rows: rowsOf(of), cycles: of.cycles });
    total.textContent = `${integer(of.cycles)} cycles, ${percent(of.cycles / whole.cycles)} of the frame`;
    made.refresh();
    box.replaceChildren(rowsTable(state));
  };
  const select = h('select', { id: 'path-of', onchange: () => look([whole, ...draws][select.selectedIndex]) },
    h('option', null, 'the frame'), draws.map((of) => h('option', null, `draw ${label(of)} (${percent(of.cycles / whole.cycles)})`)));
  look(whole);
  return section('path', 'What the end waited for',
    ["From the frame's last cycle back to its first: a unit that worked, the token it waited for, the unit that sent it, and so on. Each cycle is counted once, so the ", term('critical path'),
      ' adds up to the frame. A part is how long the frame waited for that; what it would gain if that were faster is at most as much.'],
    h('p', { class: 'pick' }, h('label', { for: 'path-of' }, 'Path of '), select, total), made.host,
    panel('All units and links on it', box));
}
