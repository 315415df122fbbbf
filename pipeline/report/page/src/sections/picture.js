// The frame, its depth, and heat maps over it: where on the screen the work was.
import { chart, CIVIDIS, tip } from '../chart.js';
import { greatest } from '../data.js';
import { choice, h } from '../dom.js';
import { bytes, decimal, integer, number, percent, ratio } from '../format.js';
import { section } from '../layout.js';
import { explained, term } from '../terms.js';

const MAPS = {
  fragments_shaded: { text: 'Shaded', per: 'shaded a pixel', what: 'Fragments shaded in the square' },
  fragments_written: { text: 'Overdraw', per: 'written a pixel', what: 'Fragments written in the square' },
  fragments_killed_early: { text: 'Depth kills', per: 'killed a pixel', what: 'Fragments that the depth test removed before they were shaded' },
  tiles_hidden: { text: 'Hi-Z kills', what: 'Tiles of 8x8 pixels of triangles that Hi-Z dropped. Nobody counted their fragments' },
  texture_cache_misses: { text: 'Texture misses', per: 'misses a pixel', what: 'Look-ups that missed the first-level texture cache' },
  simd_cycles: { text: 'Cycles', per: 'cycles a pixel', what: 'Cycles in which SIMD units of the cores computed for fragment warps whose first quad lies in the square' },
  quads: { text: 'Quads', per: 'quads a pixel', what: 'Quads of 2x2 pixels shaded in the square, each in four lanes' },
  bytes: { text: 'Bytes', per: 'bytes a pixel', what: 'Bytes of depth and colour between their units and the L2 cache', format: bytes },
};
/** Maps of parts, made of two counts. Where there is nothing to divide by there is no square. */
const PARTS = {
  quad_efficiency: {
    text: 'Quad efficiency', of: ['fragments_shaded', 'quads'], times: 4,
    what: 'Fragments shaded, as a part of the lanes of their quads: the others are helper lanes, which ran for derivatives alone',
  },
};
Object.assign(MAPS, Object.fromEntries(Object.entries(PARTS).map(([key, part]) => [key, { ...part, format: percent }])));
const partOf = (key, tiles, at) => ratio(tiles[PARTS[key].of[0]][at], PARTS[key].times * tiles[PARTS[key].of[1]][at]);
/** What a map shows in each square. */
const valuesOf = (key, tiles) => (PARTS[key] ? tiles.quads.map((_, at) => partOf(key, tiles, at)) : tiles[key] ?? []);
const formatOf = (key) => MAPS[key]?.format ?? integer;
const textOf = (key) => MAPS[key]?.text ?? key.replaceAll('_', ' ');

/** Pixels of the frame in a square; those at the right and lower edge are smaller. */
function pixelsOf(tiles, frame, at) {
  const side = tiles.tile_pixels;
  const x = (at % tiles.width) * side;
  const y = Math.floor(at / tiles.width) * side;
  return Math.max(0, Math.min(side, frame.width - x)) * Math.max(0, Math.min(side, frame.height - y));
}

/** The draws that cover a sample of the square, the first few by name; a click leads to all that is known of one. */
function drawsHere(draws, here) {
  if (!here || !draws) return null;
  const shown = here.slice(0, 14);
  const link = (i) => h('li', null, h('a', { href: '#draws', title: draws[i].label, onclick: () => {
    const pick = document.getElementById('draw');
    pick.value = i;
    pick.dispatchEvent(new Event('change'));
  } }, `${i}: ${draws[i].label}`));
  return [
    h('h3', null, explained(`Draws: ${integer(here.length)}`, 'Draws of this pass that cover a sample of the square, before any test, in the order of the commands. Found by drawing the frame once more without time.')),
    h('ul', { class: 'here', id: 'draws-here', 'data-draws': here.join(' ') }, shown.map(link)),
    here.length > shown.length && h('p', { class: 'soft' }, `and ${integer(here.length - shown.length)} more`),
  ];
}

/** What the square under the pointer holds. */
function readout(tiles, frame, keys, at) {
  const x = (at % tiles.width) * tiles.tile_pixels;
  const y = Math.floor(at / tiles.width) * tiles.tile_pixels;
  const pixels = pixelsOf(tiles, frame, at);
  const value = (key) => (PARTS[key] ? partOf(key, tiles, at) : tiles[key][at]);
  const killed = ratio(value('fragments_killed_early') ?? 0, (value('fragments_killed_early') ?? 0) + (value('fragments_shaded') ?? 0));
  return [
    h('h3', null, `Square at ${x}, ${y}`),
    h('p', { class: 'soft' }, `${Math.min(tiles.tile_pixels, frame.width - x)} x ${Math.min(tiles.tile_pixels, frame.height - y)} pixels`),
    h('table', { class: 'plain' }, keys.map((key) => h('tr', { 'data-key': key },
      h('td', null, explained(textOf(key), MAPS[key]?.what ?? key)),
      h('td', { class: 'right' }, number(value(key), formatOf(key))),
      h('td', { class: 'right soft' }, MAPS[key]?.per && pixels > 0 ? `${decimal(value(key) / pixels)} / px` : '')))),
    Number.isFinite(killed) && h('p', { class: 'soft' }, `${percent(killed)} of the fragments tested early were killed`),
  ];
}

/** The squares as a chart that lies over the picture; calls back with the square under the pointer. */
function heatMap(tiles, frame, state, hovered) {
  const made = chart('heat-map', 100, 'Heat map over the picture: counts by squares of the screen', (basics) => {
    const key = state.shown;
    const counts = tiles[key] || PARTS[key] ? valuesOf(key, tiles) : [];
    const most = PARTS[key] ? 1 : greatest(counts, 1);
    return {
      ...basics,
      // A canvas of thousands of squares needs no description of each.
      aria: { enabled: false },
      grid: { left: 0, top: 0, right: 0, bottom: 0 },
      xAxis: { type: 'category', show: false, data: Array.from({ length: tiles.width }, (_, i) => i) },
      yAxis: { type: 'category', show: false, inverse: true, data: Array.from({ length: tiles.height }, (_, i) => i) },
      tooltip: {
        ...basics.tooltip,
        formatter: ({ data }) => {
          const at = data[1] * tiles.width + data[0];
          const pixels = pixelsOf(tiles, frame, at);
          return tip(`${textOf(key)}: ${formatOf(key)(data[2])}`,
            MAPS[key]?.per && pixels > 0 ? [[MAPS[key].per, decimal(data[2] / pixels)]] : []);
        },
      },
      visualMap: {
        type: 'continuous', min: 0, max: most, dimension: 2, show: false,
        inRange: { color: CIVIDIS },
      },
      series: [{
        type: 'heatmap', progressive: 0,
        itemStyle: { opacity: state.strength, borderWidth: 0 },
        emphasis: { itemStyle: { opacity: 1, borderColor: '#fff', borderWidth: 2 } },
        data: counts.map((value, at) => [at % tiles.width, Math.floor(at / tiles.width), Number.isNaN(value) ? '-' : value]),
      }],
    };
  });
  made.ready((instance) => {
    instance.on('mouseover', ({ data }) => data && hovered(data[1] * tiles.width + data[0]));
    instance.on('mousemove', ({ data }) => data && hovered(data[1] * tiles.width + data[0]));
    instance.on('click', ({ data }) => data && hovered(data[1] * tiles.width + data[0]));
  });
  return made;
}

/** The colours of a map and the counts at its ends. */
function scale() {
  const least = h('span', null, '0');
  const most = h('span', { id: 'map-most' });
  const total = h('span', { id: 'map-total' });
  const bar = h('i', { style: `background:linear-gradient(to right, ${CIVIDIS.join(', ')})` });
  return {
    element: h('div', { class: 'scale' }, least, bar, most, total),
    show(key, tiles) {
      if (PARTS[key]) {
        const all = (name) => tiles[name].reduce((a, b) => a + b, 0);
        most.replaceChildren(number(1, percent));
        return total.replaceChildren(number(ratio(all(PARTS[key].of[0]), PARTS[key].times * all(PARTS[key].of[1])), percent), ' of all squares together');
      }
      const outside = tiles.outside_tiles[key] ?? 0;
      const all = tiles[key].reduce((a, b) => a + b, 0);
      most.replaceChildren(number(greatest(tiles[key], 0), formatOf(key)), ' a square');
      total.replaceChildren(number(all, formatOf(key)), ' in all squares',
        outside > 0 ? `, ${formatOf(key)(outside)} that have no place on the screen` : '');
    },
  };
}

export function picture({ figures, pictures, squares }) {
  const { frame, tiles } = figures;
  const counts = tiles ? Object.keys(tiles).filter((key) => Array.isArray(tiles[key])) : [];
  const keys = [...counts, ...Object.keys(PARTS).filter((key) => PARTS[key].of.every((name) => counts.includes(name)))];
  const state = { shown: 'frame', strength: 0.75, at: 0 };
  const image = h('img', { id: 'frame-picture', alt: 'The frame that the machine drew', src: pictures.frame });
  const info = h('aside', { id: 'readout', 'aria-live': 'polite' });
  const colours = scale();
  const marker = h('i', { class: 'marker', hidden: true });
  const strength = h('label', { class: 'strength' }, 'Strength ',
    h('input', { type: 'range', min: 0.2, max: 1, step: 0.05, value: state.strength, oninput: (e) => { state.strength = Number(e.target.value); map.refresh(); } }));
  const look = (at) => {
    state.at = at;
    const side = tiles.tile_pixels;
    marker.style.cssText = `left:${(100 * (at % tiles.width) * side) / frame.width}%; top:${(100 * Math.floor(at / tiles.width) * side) / frame.height}%;` +
      `width:${(100 * side) / frame.width}%; height:${(100 * side) / frame.height}%`;
    marker.hidden = false;
    info.replaceChildren(...[readout(tiles, frame, keys, at), drawsHere(figures.draws, squares?.[at])].flat().filter(Boolean));
  };
  const map = tiles ? heatMap(tiles, frame, state, look) : null;
  const show = (value) => {
    state.shown = value;
    const isMap = keys.includes(value);
    image.src = value === 'depth' ? pictures.depth : pictures.frame;
    image.classList.toggle('under-map', isMap);
    if (!map) return;
    map.host.hidden = colours.element.hidden = strength.hidden = !isMap;
    if (isMap) {
      colours.show(value, tiles);
      map.refresh();
    }
  };
  const options = [{ value: 'frame', text: 'Frame', title: 'The picture as scan-out read it from memory' }];
  if (pictures.depth) options.push({ value: 'depth', text: 'Depth', title: 'Depths as grey, the nearest white' });
  for (const key of keys) options.push({ value: key, text: textOf(key), title: MAPS[key]?.what });
  const chosen = choice('What is shown', options, 'frame', show);
  const canvas = h('div', {
    class: 'canvas', id: 'canvas', tabindex: tiles ? 0 : null, role: tiles ? 'application' : null,
    'aria-label': 'The picture in squares: arrow keys move from one to the next, and what it holds stands beside it',
    style: `aspect-ratio:${frame.width}/${frame.height}`,
  }, image, map && map.host, marker);
  if (map) {
    // The squares at the right and lower edge reach beyond the picture.
    const side = tiles.tile_pixels;
    map.host.style.cssText = `width:${(100 * tiles.width * side) / frame.width}%; height:${(100 * tiles.height * side) / frame.height}%`;
    canvas.addEventListener('keydown', (event) => {
      const step = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1] }[event.key];
      if (!step) return;
      event.preventDefault();
      const x = Math.min(tiles.width - 1, Math.max(0, (state.at % tiles.width) + step[0]));
      const y = Math.min(tiles.height - 1, Math.max(0, Math.floor(state.at / tiles.width) + step[1]));
      look(y * tiles.width + x);
    });
    canvas.addEventListener('focus', () => canvas.matches(':focus-visible') && look(state.at));
    canvas.addEventListener('mousemove', (event) => {
      const box = canvas.getBoundingClientRect();
      const x = Math.floor((((event.clientX - box.left) / box.width) * frame.width) / side);
      const y = Math.floor((((event.clientY - box.top) / box.height) * frame.height) / side);
      if (x >= 0 && y >= 0 && x < tiles.width && y < tiles.height) look(y * tiles.width + x);
    });
  }
  info.append(h('p', { class: 'soft' }, tiles ? 'Point at the picture, or move over it with the arrow keys: what the machine did in that square stands here.' : ''));
  show('frame');
  return section('picture', 'Where on the screen',
    ['The picture as the machine left it in memory; heat maps count by squares of ', tiles ? `${tiles.tile_pixels} pixels` : 'pixels', '. ', term('Hi-Z'), ' and ', term('killed early', 'depth kills'), ' are work that was saved.'],
    chosen.element,
    h('div', { class: 'viewer' }, h('div', null, canvas, h('div', { class: 'under' }, map && colours.element, map && strength)), info));
}
