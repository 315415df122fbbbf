// What the simulation cost on the computer that ran it.
import { h } from '../dom.js';
import { decimal, integer, number, seconds, short } from '../format.js';
import { section } from '../layout.js';
import { explained } from '../terms.js';

export function host({ figures }) {
  const c = figures.host;
  const items = [
    [explained('load', 'Reading the scene and its textures'), c.load_s, seconds],
    [explained('build', 'Compiling shaders, placing data in simulated memory, building the machine'), c.build_s, seconds],
    [explained('unpack', 'Unpacking and tiling the textures that something sampled'), c.unpack_s, seconds],
    [explained('simulate', 'The run alone'), c.simulate_s, seconds],
    [explained('of the processor', 'Processor time of the run alone'), c.simulate_cpu_s, seconds],
    [explained('in all', 'The whole process until the files were written'), c.wall_s, seconds],
    ['GPU cycles a second', c.cycles_per_s, short], ['fragments a second', c.fragments_per_s, short],
    [explained('actions', 'Steps of units that were simulated'), c.actions, integer], ['memory, MiB', c.peak_rss_mib, decimal],
  ];
  return section('host', 'Host', 'What the simulation cost on the computer that ran it. All other figures are the same on every computer.',
    h('dl', { class: 'facts five' }, items.map(([name, value, format]) => h('div', null, h('dt', null, name), h('dd', null, number(value, format))))));
}
