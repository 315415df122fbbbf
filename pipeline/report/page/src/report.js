// The page of one frame: its sections, in the order in which one asks.
import { h } from './dom.js';
import { showPage } from './layout.js';
import { overview } from './sections/overview.js';
import { picture } from './sections/picture.js';
import { units } from './sections/units.js';
import { path } from './sections/path.js';
import { timeline } from './sections/timeline.js';
import { light } from './sections/light.js';
import { draws } from './sections/draws.js';
import { bandwidth } from './sections/bandwidth.js';
import { caches } from './sections/caches.js';
import { dram } from './sections/dram.js';
import { energy } from './sections/energy.js';
import { machine } from './sections/machine.js';
import { parameters } from './sections/parameters.js';
import { leftOut } from './sections/left_out.js';
import { laws } from './sections/laws.js';
import { host } from './sections/host.js';

// A section takes all that is known and returns its element, or null where the figures have nothing for it.
const SECTIONS = [overview, picture, units, path, timeline, light, draws, bandwidth, caches, dram, energy, machine, parameters, leftOut, laws, host];

/** How a scene is called in a heading: the last part of its path. */
export const shortName = (scene) => scene.split('/').pop() || scene;

/** "default", or with what was changed */
export function machineName({ name, base, changed }) {
  const count = Object.keys(changed).length;
  const own = name === base ? name : `${name} (${base})`;
  return count === 0 ? own : `${own}, ${count} parameter${count === 1 ? '' : 's'} changed`;
}

export function showReport(figures, plan, pictures, squares) {
  const known = { figures, plan, pictures, squares, order: plan.units.map((unit) => unit.kind) };
  const { frame } = figures;
  const subtitle = `${frame.width} x ${frame.height} · machine ${machineName(figures.machine)} · ${figures.fidelity}` +
    (figures.window_cycles > 0 ? ` (window of ${figures.window_cycles} cycles)` : '');
  showPage(h('span', { title: figures.scene }, shortName(figures.scene)), subtitle,
    SECTIONS.map((make) => make(known)).filter(Boolean));
}
