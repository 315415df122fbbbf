// The machine as a block diagram: kinds of units and links of the machine plan, laid out by dagre, coloured by use.
import { graphlib, layout } from '@dagrejs/dagre';
import { choice, h, svg } from '../dom.js';
import { kindsOf, STATES, sum } from '../data.js';
import { integer, percent, words } from '../format.js';
import { panel, section, table } from '../layout.js';
import { explained, term } from '../terms.js';

const BOX = { width: 158, height: 50 };
// Releases and answers lead back; drawn on demand, since they hide the way of the work.
const WAYS = { onward: 'work', ahead: 'what is to come', back: 'answers and releases' };

/** Links between the same two kinds of units, in the same way, as one arrow. */
function arrows(links, ways, present) {
  const all = new Map();
  for (const link of links) {
    if (!ways.includes(link.way) || !present.has(link.from) || !present.has(link.to)) continue;
    const key = `${link.from} ${link.to} ${link.way}`;
    if (!all.has(key)) all.set(key, { ...link, names: new Set(), tokens: new Set() });
    all.get(key).names.add(link.name);
    all.get(key).tokens.add(link.token);
  }
  return [...all.values()];
}

function laidOut(units, edges) {
  const graph = new graphlib.Graph({ multigraph: true });
  graph.setGraph({ rankdir: 'TB', nodesep: 30, ranksep: 30, edgesep: 18 });
  graph.setDefaultEdgeLabel(() => ({}));
  for (const unit of units) graph.setNode(unit.kind, { ...BOX });
  edges.forEach((edge, i) => graph.setEdge(edge.from, edge.to, { weight: edge.way === 'onward' ? 4 : 1 }, String(i)));
  layout(graph);
  return graph;
}

/** A smooth line through the points that the layout chose. */
function path(points) {
  let d = `M${points[0].x},${points[0].y}`;
  for (let i = 1; i < points.length - 1; ++i) {
    const to = { x: (points[i].x + points[i + 1].x) / 2, y: (points[i].y + points[i + 1].y) / 2 };
    const end = i === points.length - 2 ? points[i + 1] : to;
    d += ` Q${points[i].x},${points[i].y} ${end.x},${end.y}`;
  }
  return points.length === 2 ? `${d} L${points[1].x},${points[1].y}` : d;
}

/** The rectangle that all boxes and points lie in, with a margin. */
function bounds(nodes, points) {
  const margin = 8;
  const xs = [...nodes.flatMap((n) => [n.x - BOX.width / 2, n.x + BOX.width / 2]), ...points.map((p) => p.x)];
  const ys = [...nodes.flatMap((n) => [n.y - BOX.height / 2, n.y + BOX.height / 2]), ...points.map((p) => p.y)];
  const left = Math.min(...xs) - margin;
  const top = Math.min(...ys) - margin;
  return { left, top, width: Math.max(...xs) + margin - left, height: Math.max(...ys) + margin - top };
}

/** What the colour of a kind tells: a part of 1. */
const MEASURES = {
  use: { text: 'Use', of: (units) => Math.max(...units.map(([, u]) => u.use)) },
  ...Object.fromEntries(STATES.slice(0, 4).map((state) => [state, {
    text: state[0].toUpperCase() + state.slice(1), of: (units) => sum(units.map(([, u]) => u[state])) / sum(units.map(([, u]) => u.cycles)),
  }])),
};

function box(node, unit, units, measure) {
  const name = words(unit.kind) + (unit.count > 1 ? ` x${unit.count}` : '');
  const value = units ? MEASURES[measure].of(units) : null;
  const go = () => {
    const select = document.getElementById('unit');
    const at = [...select.options].findIndex((option) => option.text === name || option.text.startsWith(`${words(unit.kind)} `));
    if (at < 0) return;
    select.selectedIndex = at;
    select.dispatchEvent(new Event('change'));
    document.getElementById('units').scrollIntoView();
  };
  const text = units ? `${name}: ${MEASURES[measure].text.toLowerCase()} ${percent(value)}` : `${name}: not built, since the frame does not need it`;
  return svg('g', {
    class: units ? 'unit' : 'unit absent', 'data-kind': unit.kind, 'data-value': value, tabindex: units ? 0 : null, role: units ? 'button' : 'img', 'aria-label': text,
    transform: `translate(${node.x - BOX.width / 2},${node.y - BOX.height / 2})`,
    onclick: units ? go : null, onkeydown: (event) => units && event.key === 'Enter' && go(),
  },
  svg('title', null, text),
  svg('rect', { width: BOX.width, height: BOX.height, rx: 7 }),
  units && svg('rect', { class: `level ${measure}`, width: BOX.width * Math.min(1, value), height: BOX.height, rx: 7 }),
  svg('text', { x: BOX.width / 2, y: 20 }, name),
  svg('text', { class: 'small', x: BOX.width / 2, y: 38 }, units ? percent(value) : 'left out'));
}

function diagram(known, state) {
  const { figures, plan, order } = known;
  const kinds = new Map(kindsOf(figures, order));
  const present = new Set(plan.units.map((unit) => unit.kind));
  const edges = arrows(plan.links, state.ways, present);
  const graph = laidOut(plan.units, edges);
  const frame = bounds(plan.units.map((unit) => graph.node(unit.kind)), graph.edges().flatMap((e) => graph.edge(e).points));
  const use = (name) => figures.limit?.uses[`link.${name}`];
  const lines = graph.edges().map((e) => {
    const edge = edges[Number(e.name)];
    const uses = [...edge.names].map((name) => (use(name) === undefined ? name : `${name}: use ${percent(use(name))}`));
    const busiest = Math.max(0, ...[...edge.names].map((name) => use(name) ?? 0));
    return svg('g', { class: `link ${edge.way}` },
      svg('title', null, `${words(edge.from)} to ${words(edge.to)}: ${[...edge.tokens].join(', ')}\n${uses.join('\n')}`),
      svg('path', { class: 'hit', d: path(graph.edge(e).points) }),
      svg('path', { class: 'line', d: path(graph.edge(e).points), 'stroke-width': 1.4 + 5 * busiest, 'marker-end': 'url(#arrow)' }));
  });
  return svg('svg', { id: 'diagram', viewBox: `${frame.left} ${frame.top} ${frame.width} ${frame.height}`, width: frame.width, height: frame.height, role: 'group', 'aria-label': 'Block diagram of the machine' },
    svg('defs', null, svg('marker', { id: 'arrow', viewBox: '0 0 8 8', refX: 7, refY: 4, markerWidth: 8, markerHeight: 8, markerUnits: 'userSpaceOnUse', orient: 'auto' }, svg('path', { d: 'M0,0 L8,4 L0,8 z' }))),
    lines, plan.units.map((unit) => box(graph.node(unit.kind), unit, kinds.get(unit.kind), state.measure)));
}

export function machine(known) {
  const { figures, plan } = known;
  const state = { measure: 'use', ways: ['onward', 'ahead'] };
  const host = h('div', { class: 'diagram scroll' });
  const draw = () => host.replaceChildren(diagram(known, state));
  const measures = choice('What the colour tells', Object.entries(MEASURES).map(([value, { text }]) => ({ value, text })), 'use', (value) => { state.measure = value; draw(); });
  const back = h('label', { class: 'check' }, h('input', { type: 'checkbox', id: 'back-links', onchange: (event) => {
    state.ways = event.target.checked ? Object.keys(WAYS) : ['onward', 'ahead'];
    draw();
  } }), ' answers and releases too');
  draw();
  const links = Object.entries(figures.limit?.uses ?? {}).filter(([name]) => name.startsWith('link.')).map(([name, value]) => {
    const wires = plan.links.filter((link) => `link.${link.name}` === name);
    return { name: name.slice(5), value, from: [...new Set(wires.map((w) => words(w.from)))].join(', '), to: [...new Set(wires.map((w) => words(w.to)))].join(', '), token: [...new Set(wires.map((w) => w.token))].join(', ') };
  });
  return section('machine', 'The machine',
    ['Every kind of unit and the links between them, as the machine plan has them. A box is filled as far as its ', term('use'), ' goes; a line is as thick as its link was used. Enter or a click leads to the unit.'],
    h('div', { class: 'bar' }, measures.element, back),
    h('div', { class: 'beside' }, host, links.length > 0 && panel(`Links with a use of 1 % and more (${integer(links.length)})`, table('links-table', [
      { title: 'link', of: (l) => h('span', { title: `from ${l.from} to ${l.to}` }, words(l.name)) },
      { title: explained('token', 'What it carries'), of: (l) => l.token }, { title: 'use', number: true, of: (l) => percent(l.value) },
    ], links))));
}
