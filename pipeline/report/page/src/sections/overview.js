// What one wants to know first: how long the frame took, what held it up, and how near that is to the best.
import { h } from '../dom.js';
import { brief, bytes, decimal, integer, number, percent, ratio } from '../format.js';
import { panel, section } from '../layout.js';
import { explained, term } from '../terms.js';

const card = (title, value, ...more) => h('div', { class: 'card' }, h('h3', null, title), h('div', { class: 'value' }, value), more);

/** A bar of which a part is filled. */
export const meter = (part, label) =>
  h('div', { class: 'meter', role: 'img', 'aria-label': label }, h('i', { style: `width:${Math.min(100, 100 * part).toFixed(2)}%` }));

function time({ cycles, clock_mhz, render_cycles, scan_out_cycles }) {
  return card(term('cycles', 'Time'), number(cycles, integer, 'cycles'),
    h('p', null, `cycles = ${decimal(cycles / clock_mhz / 1000)} ms at ${decimal(clock_mhz)} MHz`),
    h('p', { class: 'soft' }, `${integer(render_cycles)} until all passes are flushed, ${integer(scan_out_cycles)} of scan-out after that`));
}

function rate({ cycles, period_cycles, clock_mhz }) {
  const a_second = (n) => (clock_mhz * 1e6) / n;
  return card('Frames a second', number(a_second(cycles), decimal, 'frames-per-second'),
    h('p', null, term('one after another')),
    h('p', { class: 'soft' }, `${decimal(a_second(period_cycles))} where `, term('overlapped', 'scan-out overlaps'), ' the next frame'));
}

function best({ cycles, least_cycles }) {
  const part = least_cycles / cycles;
  return card(term('speed of light', 'Speed of light'), number(part, percent, 'speed-of-light'),
    meter(part, `${percent(part)} of the speed of light`),
    h('p', null, number(least_cycles, integer, 'least-cycles'), ' cycles at peak rates'),
    h('p', { class: 'soft' }, `the frame takes ${decimal(cycles / least_cycles)} times that`));
}

function limit({ limit: found }) {
  const gains = Object.entries(found.gains).sort((a, b) => b[1] - a[1]);
  const worth = gains.length > 0 && gains[0][1] >= 0.05; // else the frame waits, and the text says for whom
  const [name, gain] = worth ? gains[0] : [found.name, 0];
  const others = gains.slice(worth ? 1 : 0, 3).map(([other, part]) => `${other} ${percent(part)}`);
  return card(term('limit', 'Limit'), h('span', { class: 'name-value', id: 'limit', 'data-value': name }, name),
    h('p', null, worth ? `twice as much is expected to save ${percent(gain)} of the frame` : found.text),
    others.length > 0 && h('p', { class: 'soft' }, `${worth ? 'next' : 'twice as much would save'}: ${others.join(', ')}`));
}

function holds({ checks }) {
  const good = checks.filter((law) => law.holds).length;
  return card(term('law', 'Laws'), h('span', { id: 'laws-held', 'data-value': good, class: good === checks.length ? null : 'bad' }, `${good} of ${checks.length}`),
    h('p', null, good === checks.length ? 'every count has its counterpart' : 'the figures contradict each other'),
    h('p', { class: 'soft' }, h('a', { href: '#laws' }, 'see each of them')));
}

/** What went in, and what became of it. */
function work({ frame }) {
  const pixels = frame.width * frame.height;
  const items = [
    ['draws', frame.draws], ['triangles', frame.triangles],
    ['vertices shaded', frame.vertices, `${decimal(ratio(frame.vertices, frame.triangles))} a triangle`],
    [term('covered', 'fragments covered'), frame.fragments_covered, `${decimal(frame.fragments_covered / pixels)} a pixel`],
    [term('shaded', 'fragments shaded'), frame.fragments_shaded, `${decimal(frame.fragments_shaded / pixels)} a pixel`],
    [term('written', 'fragments written'), frame.fragments_written, ['', term('overdraw'), ` ${decimal(frame.fragments_written / pixels)}`]],
    [term('helper lanes'), frame.helper_lanes, `${percent(ratio(frame.helper_lanes, frame.executed_lanes))} of lanes executed`],
    [explained('bytes of memory', 'Read and written by the memory channels.'), frame.memory_bytes, `${decimal(ratio(frame.memory_bytes, pixels))} a pixel`, bytes],
  ];
  return h('dl', { class: 'facts' }, items.map(([name, value, more, format]) =>
    h('div', null, h('dt', null, name), h('dd', null, number(value, format ?? brief), more && h('small', null, more)))));
}

export function overview({ figures }) {
  const { frame } = figures;
  return section('overview', 'The frame', null,
    h('div', { class: 'cards' }, time(frame), rate(frame), limit(figures), best(frame), holds(figures)),
    figures.notes.length > 0 && panel('To note', h('ul', null, figures.notes.map((note) => h('li', null, note)))),
    work(figures));
}
