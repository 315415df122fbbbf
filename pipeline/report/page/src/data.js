// The blocks of JSON that the program put into the page, and what many sections ask of them.

/** The document of a block; null where the page has none of that name. */
export function block(id) {
  const element = document.getElementById(id);
  return element ? JSON.parse(element.textContent) : null;
}

/** `core_3` is a `core`. */
export const kindOf = (path) => path.replace(/_\d+$/, '');

/** Units by kind, in the order of the pipeline: [kind, [[path, unit], ...]] */
export function kindsOf(figures, order) {
  const kinds = new Map(order.map((kind) => [kind, []]));
  for (const [path, unit] of Object.entries(figures.units)) {
    const kind = kindOf(path);
    if (!kinds.has(kind)) kinds.set(kind, []);
    kinds.get(kind).push([path, unit]);
  }
  return [...kinds].filter(([, units]) => units.length > 0);
}

export const STATES = ['busy', 'waiting', 'starved', 'blocked', 'idle'];

export const sum = (values) => values.reduce((total, value) => total + value, 0);

/** The least and the greatest of a list of any length, or what is given with it. */
export const least = (values, start = Infinity) => values.reduce((a, b) => Math.min(a, b), start);
export const greatest = (values, start = -Infinity) => values.reduce((a, b) => Math.max(a, b), start);

/** Sum of a counter over units. */
export const counted = (units, name) => sum(units.map(([, unit]) => unit.counters[name] ?? 0));

/** Adds up numbers by name: waits of several units, say, with `core_in_0` and `core_in_1` as `core_in`. */
export function addedUp(objects, name = (key) => key) {
  const all = new Map();
  for (const object of objects)
    for (const [key, value] of Object.entries(object)) all.set(name(key), (all.get(name(key)) ?? 0) + value);
  return [...all].sort((a, b) => b[1] - a[1]);
}

/** The client that a port's name tells of: `texture_in_2` -> `texture_in` */
export const portKind = (port) => port.replace(/_\d+$/, '');
