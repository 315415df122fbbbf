// The page of a sweep: every machine by what it came to, the fronts, what each parameter does, and one machine in full.
import { chart, CIVIDIS, PALETTE, tip } from './chart.js';
import { greatest, least, sum } from './data.js';
import { h } from './dom.js';
import { decimal, integer, number, percent, seconds } from './format.js';
import { grid, numberColumn, textColumn } from './grid.js';
import { section, showPage, table } from './layout.js';
import { colour } from './theme.js';

const MOST_LEVELS = 32; // beyond it a parameter is shown as a cloud, not as a mean a value

/** Whole numbers with all digits, others short. */
const shown = (value) => (Number.isInteger(value) ? integer(value) : decimal(value));
const titled = (objective) => (objective.unit ? `${objective.name} [${objective.unit}]` : objective.name);
const asNumber = (text) => (text !== '' && Number.isFinite(Number(text)) ? Number(text) : NaN);

/** Which machine is chosen, and which pass the filters of the parallel coordinates. */
class State {
  constructor(machines) {
    this.chosen = Math.max(0, machines.findIndex((m) => m.front));
    this.passing = machines.map(() => true);
    this.listeners = [];
  }
  onChange(listener) { this.listeners.push(listener); }
  change(values) {
    Object.assign(this, values);
    for (const listener of this.listeners) listener();
  }
}

/** Differences within the noise of every objective are none. */
export const equal = (objectives, a, b) => objectives.every((o, i) =>
  Math.abs(a.objectives[i] - b.objectives[i]) <= o.noise * Math.max(Math.abs(a.objectives[i]), Math.abs(b.objectives[i])));

/** How a machine stands to the front. Those equal to one of it are told apart by noise alone. */
function standing(s, machine, front) {
  if (machine.front) return 'front';
  if (!machine.holds) return 'beyond a limit';
  return front.some((other) => equal(s.objectives, machine, other)) ? 'equal to the front' : '';
}

const named = (s, machine) => s.dimensions.map((d, i) => `${d.name}=${machine.values[i]}`).join(' ') || machine.machine;

function overview(s) {
  const holding = s.machines.filter((m) => m.holds);
  const card = (title, value, id, below) => h('div', { class: 'card' }, h('h3', null, title), h('div', { class: 'value', id, 'data-value': value }, shown(value)), below && h('p', null, below));
  const best = s.objectives.map((o, i) => {
    if (holding.length === 0) return null;
    const values = holding.map((m) => m.objectives[i]);
    return card(`${o.most ? 'Most' : 'Least'} ${titled(o)}`, o.most ? greatest(values) : least(values), `best-${o.name}`, 'of the machines that hold the limits');
  });
  const limits = s.objectives.filter((o) => o.at_most !== null || o.at_least !== null).map((o) =>
    `${o.name} ${o.at_most !== null ? `at most ${o.at_most}` : `at least ${o.at_least}`}`);
  return section('overview', 'What was drawn', `${s.scenes.map((x) => x.name).join(', ')}; design ${s.design}, seed ${s.seed}; ${s.versions.join(', ')}`,
    h('div', { class: 'cards' },
      card('Machines', s.machines.length, 'machines'), card('On the front', s.machines.filter((m) => m.front).length, 'on-front'),
      card('Points that failed', s.failed.length, 'failed'), best),
    limits.length > 0 && h('p', null, `Limits: ${limits.join('; ')}. ${holding.length} of ${s.machines.length} machines hold them.`),
    s.failed.length > 0 && table('failed-table', [
      { title: 'scene', of: (f) => f.scene }, { title: 'machine', of: (f) => f.machine }, { title: 'ended', of: (f) => f.status }, { title: 'reason', of: (f) => f.reason },
    ], s.failed),
    s.excluded.length > 0 && h('details', null, h('summary', null, `${sum(s.excluded.map((e) => e.count))} combinations were left out`),
      table('excluded-table', [{ title: 'combinations', number: true, of: (e) => integer(e.count) }, { title: 'reason', of: (e) => e.reason }], s.excluded)));
}

const select = (id, label, options, chosen, choose) => h('label', null, `${label} `, h('select', { id, onchange: (event) => choose(Number(event.target.value)) },
  options.map((text, i) => h('option', { value: i, selected: i === chosen }, text))));

/** Objectives against each other; with one, it against the first dimension that has numbers. */
function front(s, state) {
  const axes = s.objectives.map((o, i) => ({ title: titled(o), of: (m) => m.objectives[i] }));
  s.dimensions.forEach((d, i) => {
    if (s.machines.every((m) => Number.isFinite(asNumber(m.values[i])))) axes.push({ title: d.name, of: (m) => asNumber(m.values[i]) });
  });
  if (axes.length < 2) return null;
  let [x, y] = [0, 1];
  const made = chart('front-chart', 460, 'Every machine by two of its objectives, the front as a line', (basics) => {
    const data = (filter) => s.machines.map((m, i) => ({ value: [axes[x].of(m), axes[y].of(m)], machine: i })).filter(({ machine }) => state.passing[machine] && filter(s.machines[machine]));
    const axis = (a) => ({ ...basics.axis, type: 'value', scale: true, name: a.title, nameLocation: 'middle', nameGap: 32 });
    return {
      ...basics,
      grid: { left: 90, right: 30, top: 40, bottom: 60 },
      legend: { ...basics.legend, top: 0 },
      tooltip: { ...basics.tooltip, formatter: ({ data: { machine } }) => tip(named(s, s.machines[machine]), s.objectives.map((o, i) => [titled(o), shown(s.machines[machine].objectives[i])])) },
      xAxis: axis(axes[x]),
      yAxis: { ...axis(axes[y]), nameGap: 70 },
      series: [
        { name: 'beyond a limit', type: 'scatter', symbolSize: 7, itemStyle: { color: 'transparent', borderColor: colour('idle-mark') }, data: data((m) => !m.holds) },
        { name: 'machines', type: 'scatter', symbolSize: 8, itemStyle: { color: PALETTE[4], opacity: 0.75 }, data: data((m) => m.holds && !m.front) },
        { name: 'front', type: 'line', symbol: 'circle', symbolSize: 10, itemStyle: { color: PALETTE[5] }, lineStyle: { width: 1, type: 'dashed' }, data: data((m) => m.front).sort((a, b) => a.value[0] - b.value[0]) },
        { name: 'chosen', type: 'scatter', symbolSize: 20, silent: true, itemStyle: { color: 'transparent', borderColor: colour('ink'), borderWidth: 2 }, data: [s.machines[state.chosen]].map((m) => [axes[x].of(m), axes[y].of(m)]) },
      ],
    };
  });
  made.ready((instance) => instance.on('click', ({ data }) => data?.machine !== undefined && state.change({ chosen: data.machine })));
  state.onChange(() => made.refresh());
  const titles = axes.map((a) => a.title);
  return section('front', 'Front', 'No machine is better than one on the front in one objective without being worse in another. Click on a machine to see it below.',
    h('div', { class: 'pick' }, select('front-x', 'across', titles, x, (i) => { x = i; made.refresh(); }), select('front-y', 'up', titles, y, (i) => { y = i; made.refresh(); })),
    made.host);
}

/** All dimensions and objectives beside each other; dragging along an axis filters the page. */
function parallel(s, state) {
  if (s.dimensions.length + s.objectives.length < 2 || s.machines.length === 0) return null;
  const axes = [
    ...s.dimensions.map((d, i) => {
      const numbers = s.machines.map((m) => asNumber(m.values[i]));
      return numbers.every(Number.isFinite) && !d.levels ? { name: d.name, type: 'value', of: (m) => asNumber(m.values[i]) }
        : { name: d.name, type: 'category', data: d.levels ?? [...new Set(s.machines.map((m) => m.values[i]))], of: (m) => m.values[i] };
    }),
    ...s.objectives.map((o, i) => ({ name: titled(o), type: 'value', of: (m) => m.objectives[i] })),
  ];
  const first = s.machines.map((m) => m.objectives[0]);
  const made = chart('parallel-chart', 420, 'Every machine as a line over its parameters and objectives', (basics) => ({
    ...basics,
    legend: { show: false },
    parallel: { left: 60, right: 90, top: 60, bottom: 30, parallelAxisDefault: { ...basics.axis, nameLocation: 'end', nameTextStyle: { color: colour('ink'), fontSize: 12 }, scale: true, axisLine: { lineStyle: { color: colour('soft') } }, nameTruncate: { maxWidth: 150 } } },
    parallelAxis: axes.map((a, dim) => ({ dim, name: a.name, type: a.type, data: a.data, nameRotate: axes.length > 7 ? 12 : 0 })),
    visualMap: { show: false, dimension: s.dimensions.length, min: least(first), max: greatest(first), inRange: { color: CIVIDIS } },
    series: [{ name: 'machines', type: 'parallel', lineStyle: { width: 1.4, opacity: s.machines.length > 150 ? 0.35 : 0.7 }, inactiveOpacity: 0.03, data: s.machines.map((m) => axes.map((a) => a.of(m))) }],
  }));
  const count = h('strong', { id: 'passing' }, integer(s.machines.length));
  made.ready((instance) => instance.on('axisareaselected', () => {
    const active = new Set(instance.getModel().getSeries()[0].getRawIndicesByActiveState('active'));
    const any = instance.getOption().parallelAxis.some((_, i) => (instance.getModel().getComponent('parallelAxis', i).activeIntervals ?? []).length > 0);
    const passing = s.machines.map((_, i) => !any || active.has(i));
    count.textContent = integer(passing.filter(Boolean).length);
    state.change({ passing });
  }));
  return section('parallel', 'Parallel coordinates', ['A line is a machine; its colour is its ', h('code', null, s.objectives[0].name), ' (dark is less). Drag along an axis to filter, click the axis to let go: ', count, ` of ${s.machines.length} pass, and the front and the table show those alone.`], made.host);
}

/** Mean of an objective at each level of each dimension, and the range. */
function effects(s) {
  if (s.dimensions.length === 0 || s.design === 'search') return null;
  let objective = 0;
  const made = [];
  const panels = s.dimensions.map((d, i) => {
    const numbers = s.machines.map((m) => asNumber(m.values[i]));
    const values = new Set(s.machines.map((m) => m.values[i]));
    if (values.size > MOST_LEVELS && numbers.every(Number.isFinite)) {
      const cloud = chart(`effect-${i}`, 210, `The objective by ${d.name}`, (basics) => ({
        ...basics,
        legend: { show: false },
        grid: { left: 78, right: 14, top: 30, bottom: 40 },
        xAxis: { ...basics.axis, type: 'value', scale: true, name: d.name, nameLocation: 'middle', nameGap: 24 },
        yAxis: { ...basics.axis, type: 'value', scale: true },
        series: [{ name: 'machines', type: 'scatter', symbolSize: 5, itemStyle: { color: PALETTE[0], opacity: 0.6 }, data: s.machines.map((m, k) => [numbers[k], m.objectives[objective]]) }],
      }));
      made.push(cloud);
      return cloud.host;
    }
    const levels = (d.levels ?? [...new Set(s.machines.map((m) => m.values[i]))].sort((a, b) => asNumber(a) - asNumber(b)))
      .map((level) => [level, s.machines.filter((m) => m.values[i] === level)]).filter(([, machines]) => machines.length > 0);
    const one = chart(`effect-${i}`, 210, `Mean of the objective by ${d.name}`, (basics) => {
      const of = levels.map(([, machines]) => machines.map((m) => m.objectives[objective]));
      const line = (name, values, more) => ({ name, type: 'line', symbolSize: 6, data: values, ...more });
      const soft = { lineStyle: { width: 1, type: 'dotted', color: colour('soft') }, itemStyle: { color: colour('soft') }, symbolSize: 3 };
      return {
        ...basics,
        legend: { ...basics.legend, top: 0 },
        grid: { left: 78, right: 14, top: 30, bottom: 40 },
        tooltip: { ...basics.tooltip, trigger: 'axis', formatter: ([{ dataIndex }]) => tip(`${d.name} = ${levels[dataIndex][0]}`, [['most', shown(greatest(of[dataIndex]))], ['mean', shown(sum(of[dataIndex]) / of[dataIndex].length)], ['least', shown(least(of[dataIndex]))]], `${of[dataIndex].length} machines`) },
        xAxis: { ...basics.axis, type: 'category', data: levels.map(([level]) => level), name: d.name, nameLocation: 'middle', nameGap: 24 },
        yAxis: { ...basics.axis, type: 'value', scale: true },
        series: [
          line('mean', of.map((v) => sum(v) / v.length), { itemStyle: { color: PALETTE[0] }, lineStyle: { width: 2 } }),
          line('least', of.map((v) => least(v)), soft), line('most', of.map((v) => greatest(v)), soft),
        ],
      };
    });
    made.push(one);
    return one.host;
  });
  return section('effects', 'Main effects', 'The mean of an objective over all machines that have a value, with the least and the greatest as dots. Where nearly every machine has a value of its own, each is a dot. Flat lines: the parameter does little by itself.',
    h('div', { class: 'pick' }, select('effect-objective', 'of', s.objectives.map(titled), 0, (i) => { objective = i; for (const one of made) one.refresh(); })),
    h('div', { class: 'halves' }, panels));
}

/** Sobol indices, and pairs. */
function indices(s) {
  const known = s.objectives.map((o, i) => i).filter((i) => s.indices[i]);
  if (known.length === 0) return null;
  let objective = known[0];
  const names = s.dimensions.map((d) => d.name);
  const bars = chart('indices-chart', 40 * names.length + 90, 'Sobol indices by parameter', (basics) => {
    const { first, total } = s.indices[objective];
    return {
      ...basics,
      grid: { left: 170, right: 60, top: 36, bottom: 30 },
      legend: { ...basics.legend, top: 0, left: 160 },
      tooltip: { ...basics.tooltip, trigger: 'axis', axisPointer: { type: 'shadow' }, formatter: ([{ dataIndex: i }]) => tip(names[i], [['alone', percent(first[i])], ['with all others', percent(total[i])]]) },
      xAxis: { ...basics.axis, type: 'value', max: (v) => Math.max(1, v.max), axisLabel: { ...basics.axis.axisLabel, formatter: (v) => percent(v) } },
      yAxis: { ...basics.axis, type: 'category', inverse: true, data: names, axisLabel: { ...basics.axis.axisLabel, color: colour('ink') } },
      series: [
        { name: 'alone', type: 'bar', stack: 'index', barWidth: '60%', itemStyle: { color: PALETTE[0] }, data: first },
        { name: 'together with others', type: 'bar', stack: 'index', itemStyle: { color: PALETTE[1] }, data: total.map((t, i) => Math.max(0, t - first[i])) },
      ],
    };
  });
  const pairs = chart('pairs-chart', 34 * names.length + 130, 'Interactions of two parameters', (basics) => {
    const data = names.flatMap((_, i) => names.map((__, j) => [j, i, s.indices[objective].pairs[i][j]])).filter(([j, i]) => j < i);
    return {
      ...basics,
      legend: { show: false },
      grid: { left: 170, right: 20, top: 10, bottom: 110 },
      tooltip: { ...basics.tooltip, formatter: ({ data: [j, i, v] }) => tip(`${names[i]} x ${names[j]}`, [['part of the variance', percent(v)]]) },
      xAxis: { ...basics.axis, type: 'category', data: names, axisLabel: { ...basics.axis.axisLabel, rotate: 30 } },
      yAxis: { ...basics.axis, type: 'category', inverse: true, data: names },
      visualMap: { show: false, min: 0, max: Math.max(0.01, greatest(data.map(([, , v]) => v))), inRange: { color: CIVIDIS } },
      series: [{ name: 'pairs', type: 'heatmap', data, label: { show: true, formatter: ({ data: [, , v] }) => (v >= 0.001 ? percent(v) : '') } }],
    };
  });
  const explained = h('strong', { id: 'explained' });
  const say = () => { explained.textContent = percent(s.indices[objective].explained); };
  say();
  return section('indices', 'Sobol indices', ['Which part of the variance of an objective a parameter explains: alone, and together with others. From a polynomial fit that explains ', explained, ' of the variance of machines it was not given; below 90 % take it as a hint.'],
    h('div', { class: 'pick' }, select('index-objective', 'of', known.map((i) => titled(s.objectives[i])), 0, (i) => { objective = known[i]; bars.refresh(); pairs.refresh(); say(); })),
    h('div', { class: 'halves' }, bars.host, names.length > 1 && pairs.host));
}

function machines(s, state) {
  const front = s.machines.filter((m) => m.front);
  const rows = s.machines.map((m, i) => ({
    machine: i, standing: standing(s, m, front),
    ...Object.fromEntries(s.dimensions.map((_, d) => [`v${d}`, Number.isFinite(asNumber(m.values[d])) ? asNumber(m.values[d]) : m.values[d]])),
    ...Object.fromEntries(m.objectives.map((value, o) => [`o${o}`, value])), seconds: m.seconds,
  }));
  const columns = [
    textColumn('stands', 'standing'),
    ...s.dimensions.map((d, i) => (s.machines.every((m) => Number.isFinite(asNumber(m.values[i]))) ? numberColumn(d.name, `v${i}`, String) : textColumn(d.name, `v${i}`))),
    ...s.objectives.map((o, i) => numberColumn(titled(o), `o${i}`, shown)),
    numberColumn('seconds', 'seconds', seconds),
  ];
  const made = grid('machines-table', columns, rows, Math.min(420, 90 + 30 * rows.length), { selectableRows: 1, initialSort: [{ column: 'o0', dir: s.objectives[0].most ? 'desc' : 'asc' }] });
  made.onMade = (instance) => {
    instance.on('rowClick', (_, row) => state.change({ chosen: row.getData().machine }));
    instance.on('tableBuilt', () => state.onChange(() => instance.setFilter((row) => state.passing[row.machine])));
  };
  return section('machines', 'Machines', 'Sorts by a click on a head; the fields below filter. A click on a row shows the machine below.', made.host);
}

function chosen(s, state) {
  const host = h('div', { id: 'chosen' });
  const show = () => {
    const m = s.machines[state.chosen];
    const same = s.machines.filter((other) => other !== m && equal(s.objectives, m, other));
    host.replaceChildren(
      h('h3', { id: 'chosen-name' }, named(s, m)),
      same.length > 0 ? h('p', { id: 'same' }, `${same.length} other ${same.length === 1 ? 'machine is' : 'machines are'} equal to it within the noise of every objective: ${same.slice(0, 5).map((x) => named(s, x)).join('; ')}${same.length > 5 ? ' …' : ''}`) : h('p', { class: 'soft', id: 'same' }, 'No other machine is equal to it.'),
      table('chosen-table', [
        { title: 'objective', of: ([o]) => titled(o) }, { title: 'over the scenes', number: true, of: ([, i]) => number(m.objectives[i], shown) },
        ...s.scenes.map((scene, k) => ({ title: scene.name, number: true, of: ([, i]) => number(m.by_scene[k][i], shown) })),
      ], s.objectives.map((o, i) => [o, i])),
      h('p', null, 'Set: ', h('code', null, `${m.machine} ${m.settings.join(' ')}`)),
      h('div', { class: 'halves' }, s.scenes.map((scene, k) => h('figure', null,
        s.pictures[m.pictures[k]] && h('img', { src: s.pictures[m.pictures[k]], alt: `${scene.name} as this machine draws it`, style: 'max-width:100%' }),
        h('figcaption', null, `${scene.name}. Its own report: `, h('code', null, `quadrille render ${scene.arguments} --machine ${m.machine}${m.settings.map((x) => ` --set ${x}`).join('')} --report point.html`))))));
  };
  state.onChange(show);
  show();
  return section('chosen-machine', 'One machine', 'What it comes to by scene, the pictures that it draws, and the command that draws it again with a report of its own.', host);
}

export function showSweep(s) {
  const state = new State(s.machines);
  const some = s.machines.length > 0;
  showPage(s.title, `${s.machines.length} machines x ${s.scenes.length} scenes`,
    [overview(s), some && front(s, state), some && parallel(s, state), some && effects(s), some && indices(s), some && machines(s, state), some && chosen(s, state)].filter(Boolean));
}
