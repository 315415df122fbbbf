// What a word means, shown where the pointer or the keyboard's focus is. Definitions of counters come with the figures.
import { h } from './dom.js';
import { words } from './format.js';

const TERMS = {
  cycles: 'Cycles of the GPU clock, from the first command until scan-out has read the last pixel.',
  busy: 'Cycles in which the unit begins work.',
  waiting: 'Cycles in which the unit waits for something of its own that is under way: its latencies.',
  starved: 'Cycles in which an input was missing.',
  blocked: 'Cycles in which an output was full.',
  idle: 'Cycles in which no work was in flight that could reach the unit.',
  use: 'The least time in which the unit could do the counted work at its peak rates, as a part of its cycles. 100 % is its speed of light.',
  limit: 'The resource of which twice as much is expected to shorten the frame most. The expectation comes from this one run.',
  'critical path': 'The chain of work and waits from the last cycle of the frame back to its first. What is not on it would shorten nothing by itself.',
  'speed of light': 'The least time of the counted work at its peak rates: no order of the same work could be faster on this machine.',
  gain: 'The part of the frame that twice as much of this resource is expected to save, by itself.',
  'one after another': 'Frames a second if the next frame begins when the last pixel of this one has been read.',
  overlapped: 'Frames a second where scan-out reads one frame while the next one is drawn.',
  covered: 'Samples of triangles that Hi-Z did not drop, before any depth test.',
  shaded: 'Live lanes of fragment warps.',
  written: 'Fragments that reached the target.',
  'helper lanes': 'Lanes that run only so that a quad of 2x2 pixels has derivatives.',
  'killed early': 'Fragments that the depth test removed before they were shaded.',
  'killed late': 'Fragments that the depth test removed after they were shaded.',
  discarded: 'Fragments that their program, a mask or alpha to coverage took away.',
  overdraw: 'Fragments written for each pixel.',
  'Hi-Z': 'Depth by tile of 8x8 pixels: the coarse rasteriser drops a tile of a triangle that lies wholly behind what is there.',
  'in flight': 'Cycles from the issue of the draw until every partition had retired it. Draws overlap.',
  limiter: 'The kind of unit with the most work for the draw; "latency" where that fills less than half of the time in flight.',
  share: "Work of the draw's limiting unit at its peak rates, as a part of the cycles in flight: how near the draw is to its speed of light.",
  'SIMDs held': 'Cycles in which the SIMD units of the cores computed for the draw, as a part of all their cycles while it was in flight.',
  'most warps': "Warps of the draw's fragments that a core can hold at a time, if it holds no others.",
  'kept out by': 'The parameter that allows no more of them: slots for warps, rows of registers, or the reorder buffers of the warp packers.',
  'least time': "GPU cycles that the draw's limiting unit needs for its work at peak rates.",
  texels: 'Texels read by the filters.',
  'cache misses': 'Look-ups of a line that had to ask the next level.',
  merged: 'Look-ups that found their line on its way already.',
  'row hit': 'A request whose row was open in its bank.',
  'row miss': 'A request whose bank had no open row.',
  'row conflict': 'A request whose bank had another row open, which had to be closed first.',
  refresh: 'Cycles in which a request waited because its bank was refreshed.',
  'turn-around': 'Cycles in which the data bus changed between reads and writes while a request waited.',
  activation: 'Cycles in which a request waited for its row to be opened.',
  spacing: 'Cycles in which a request waited for the least distance between commands.',
  'in queue': 'Mean number of requests that a memory controller holds.',
  law: 'Two counts of the same thing, taken by different units. A run in which one does not hold fails.',
  'left out': 'What this frame does not need and was therefore not built or computed. Neither picture nor cycles change.',
  slice: 'The frame is cut into up to 256 parts of equal length; units note at the end of each what they have taken of their resources, and what they have moved.',
  full: 'The part of the time in which all places of this kind were taken.',
};

let bubble = null;

function show(anchor, text) {
  bubble ??= document.body.appendChild(h('div', { id: 'bubble', role: 'tooltip' }));
  bubble.textContent = text;
  bubble.hidden = false;
  const at = anchor.getBoundingClientRect();
  const size = bubble.getBoundingClientRect();
  const left = Math.max(8, Math.min(at.left, window.innerWidth - size.width - 8));
  const above = at.bottom + size.height + 8 > window.innerHeight;
  bubble.style.left = `${left + window.scrollX}px`;
  bubble.style.top = `${(above ? at.top - size.height - 6 : at.bottom + 6) + window.scrollY}px`;
}

function hide() {
  if (bubble) bubble.hidden = true;
}

/** A word that tells on hover or focus what it means. */
export function explained(text, definition) {
  const word = h('span', { class: 'term', tabindex: 0, 'data-definition': definition, 'aria-describedby': 'bubble' }, text);
  word.addEventListener('mouseenter', () => show(word, definition));
  word.addEventListener('focus', () => show(word, definition));
  word.addEventListener('mouseleave', hide);
  word.addEventListener('blur', hide);
  word.addEventListener('keydown', (event) => event.key === 'Escape' && hide());
  return word;
}

export const definition = (name) => TERMS[name];

/** A word of the list above; one that is not there stays plain. */
export const term = (name, text = name) => (TERMS[name] ? explained(text, TERMS[name]) : document.createTextNode(text));

/** A counter of a kind of unit, with the definition that the figures carry. */
export function counter(figures, kind, name, text = words(name)) {
  const known = figures.counter_definitions[kind]?.[name];
  return known ? explained(text, `${known.definition}. Unit: ${known.unit}. (${kind}.${name})`) : text;
}
