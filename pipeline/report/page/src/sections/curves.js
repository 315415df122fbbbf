// What the chart of the frame over time can show: use of resources, bytes of the clients, tokens in the links.
// A view has lines with a value a slice; `tell` says of a line and a slice what stands beside the pointer.
import { kindOf, sum } from '../data.js';
import { decimal, integer, percent, short, words } from '../format.js';

const MOST_LINES = 8;
const RESOURCES = [
  { value: 'rate', text: 'Use', title: 'Part of the slice that the work takes at the peak rate' },
  { value: 'places', text: 'Places all taken', title: 'Part of the slice in which all places were taken' },
  { value: 'loss', text: 'Lost', title: "Part of the slice in which a rate's resource could not work" },
];

const most = (lines) => lines.filter(({ values }) => values.some((v) => v > 0)).sort((a, b) => sum(b.values) - sum(a.values));

/** Curves of one kind of resource: the mean over the units of each kind, those with the most first. */
export function curvesOf(figures, kind) {
  const all = new Map();
  for (const [unit, resources] of Object.entries(figures.timeline.units)) {
    for (const [resource, share] of Object.entries(resources)) {
      if (figures.units[unit].resources[resource].kind !== kind) continue;
      const name = `${kindOf(unit)}.${resource}`;
      if (!all.has(name)) all.set(name, []);
      all.get(name).push(share);
    }
  }
  return most([...all].map(([name, shares]) => ({ name, values: shares[0].map((_, s) => sum(shares.map((of) => of[s])) / shares.length) })));
}

/** Cycles of a slice; the last one of what moves goes on until nothing moves any more. */
export function movingCycles(figures, s) {
  const { slice_cycles: slice, slices } = figures.timeline;
  return s + 1 < slices ? slice : figures.frame.moving_cycles - s * slice;
}

/** Bytes of slices as bytes a cycle, and the bytes themselves. */
const bytesLine = (figures, name, counts) => ({ name, counts, values: counts.map((n, s) => n / movingCycles(figures, s)) });

/** By client: what it asked of the L2 cache and wrote to it. */
export const askedOf = (figures) => most(Object.entries(figures.timeline.bandwidth ?? {}).map(([client, { read_bytes, write_bytes }]) =>
  bytesLine(figures, words(client), read_bytes.map((n, s) => n + write_bytes[s]))));

/** By client: what the memory channels moved. */
export const movedOf = (figures) => most(Object.entries(figures.timeline.memory ?? {}).map(([client, counts]) => bytesLine(figures, words(client), counts)));

/** By class of links: the part of its places that held a token. */
export const filledOf = (figures) => most(Object.entries(figures.timeline.links ?? {}).map(([name, tokens]) =>
  ({ name, tokens, values: tokens.map((held) => held / figures.links[name].depth) })));

/** Everything that this frame has to show over time. */
export function viewsOf(figures, plan) {
  const perSecond = figures.frame.clock_mhz * 1e6;
  const part = { axis: (v) => `${Math.round(100 * v)} %`, top: 1 };
  const bytes = {
    stacked: true, unit: 'bytes a cycle', axis: short,
    tell: ({ counts, values }, s) => `${decimal(values[s])} B a cycle · ${decimal(values[s] * perSecond / 1e9)} GB/s · ${integer(counts[s])} B`,
  };
  return [
    ...RESOURCES.map((of) => ({ ...of, ...part, lines: curvesOf(figures, of.value).slice(0, MOST_LINES), tell: ({ values }, s) => percent(values[s]) })),
    { value: 'asked', text: 'Bytes of clients', title: 'Bytes a cycle that each client asked of the L2 cache and wrote to it', ...bytes, lines: askedOf(figures) },
    { value: 'moved', text: 'Bytes of the memory', title: 'Bytes a cycle that the memory channels moved for each client', ...bytes, lines: movedOf(figures), peak: plan.peak_memory_bytes_per_cycle },
    {
      value: 'links', text: 'Links filled', title: 'Part of the places of each class of links that held a token, in the mean', ...part, lines: filledOf(figures).slice(0, MOST_LINES),
      tell: ({ name, tokens, values }, s) => `${percent(values[s])} · ${decimal(tokens[s])} of ${figures.links[name].depth} tokens`,
    },
  ].filter(({ lines }) => lines.length > 0);
}
