// Bytes that each client asked of the L2 cache, and what the memory channels moved.
import { chart, tip } from '../chart.js';
import { h } from '../dom.js';
import { counted, sum } from '../data.js';
import { bytes, decimal, number, percent, ratio, words } from '../format.js';
import { section, table } from '../layout.js';
import { explained } from '../terms.js';
import { colour } from '../theme.js';

export function bandwidth({ figures, plan }) {
  const { cycles } = figures.frame;
  const memory = Object.entries(figures.units).filter(([path]) => path.startsWith('memory_') || path === 'memory');
  const clients = Object.entries(figures.bandwidth).map(([name, { read_bytes, write_bytes }]) => ({ name: words(name), read: read_bytes, write: write_bytes }));
  const channels = { name: 'memory', read: counted(memory, 'read_bytes'), write: counted(memory, 'write_bytes') };
  const rows = [...clients, channels];
  if (sum(rows.map((r) => r.read + r.write)) === 0) return null;
  const peak = plan.peak_memory_bytes_per_cycle * cycles;
  const made = chart('bandwidth-chart', 34 * rows.length + 70, 'Bytes read and written by client', (basics) => ({
    ...basics,
    grid: { left: 110, right: 70, top: 34, bottom: 26 },
    legend: { ...basics.legend, top: 0, left: 0 },
    tooltip: {
      ...basics.tooltip, trigger: 'axis', axisPointer: { type: 'shadow' },
      formatter: ([{ dataIndex }]) => {
        const r = rows[dataIndex];
        return tip(r.name, [['read', bytes(r.read)], ['written', bytes(r.write)], ['a cycle', `${decimal((r.read + r.write) / cycles)} B`]]);
      },
    },
    xAxis: { ...basics.axis, type: 'value', axisLabel: { ...basics.axis.axisLabel, formatter: (v) => bytes(v) } },
    yAxis: { ...basics.axis, type: 'category', inverse: true, data: rows.map((r) => r.name), axisLabel: { ...basics.axis.axisLabel, color: colour('ink') }, splitLine: { show: false } },
    series: [
      { name: 'read', type: 'bar', stack: 'bytes', barWidth: '60%', itemStyle: { color: colour('busy') }, data: rows.map((r) => r.read) },
      {
        name: 'written', type: 'bar', stack: 'bytes', itemStyle: { color: colour('accent') }, data: rows.map((r) => r.write),
        label: { show: true, position: 'right', color: colour('soft'), fontSize: 12, formatter: ({ dataIndex }) => bytes(rows[dataIndex].read + rows[dataIndex].write) },
      },
    ],
  }));
  const moved = channels.read + channels.write;
  const column = (title, of) => ({ title, number: true, of });
  return section('bandwidth', 'Bandwidth',
    ['What each client asked of the L2 cache and wrote to it; the last row is what the memory channels moved: ',
      h('strong', null, percent(ratio(moved, peak))), ' of their ',
      explained('peak', 'Bytes a cycle that all memory channels move together at their best, times the cycles of the frame'), ` of ${decimal(plan.peak_memory_bytes_per_cycle)} bytes a cycle.`],
    h('div', { class: 'halves' }, made.host, table('bandwidth-table', [
      { title: 'client', of: (r) => r.name },
      column('read', (r) => number(r.read, bytes)), column('written', (r) => number(r.write, bytes)),
      column('bytes a cycle', (r) => number((r.read + r.write) / cycles, decimal)),
      column('of all clients', (r) => (r === channels ? '' : percent(ratio(r.read + r.write, sum(clients.map((c) => c.read + c.write)))))),
    ], rows)));
}
