// Numbers as people read them. What is shown short has the exact number in its title and in `data-value`.
import { h } from './dom.js';

const SPACE = '\u00a0'; // one that no line breaks at
const whole = new Intl.NumberFormat('en-GB', { maximumFractionDigits: 0 });

/** 1234567 -> "1,234,567" */
export const integer = (n) => whole.format(n);

/** Three digits that count: 0.0123, 4.56, 12.3, 1,234 */
export function decimal(n) {
  if (!Number.isFinite(n)) return '-';
  if (n === 0) return '0';
  const size = Math.abs(n);
  if (size >= 1000) return whole.format(n);
  const digits = size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : size >= 0.1 ? 3 : 4;
  return n.toFixed(digits);
}

/** 1234567 -> "1.23 M", for axes and cards */
export function short(n) {
  const size = Math.abs(n);
  for (const [scale, letter] of [[1e12, 'T'], [1e9, 'G'], [1e6, 'M'], [1e3, 'k']])
    if (size >= scale) return `${trim(n / scale)}${SPACE}${letter}`;
  return trim(n);
}

const trim = (n) => (Number.isInteger(n) ? String(n) : n.toPrecision(3).replace(/\.?0+$/, ''));

/** All digits while they are few. */
export const brief = (n) => (Math.abs(n) < 1e7 ? integer(n) : short(n));

/** Bytes, in thousands: "19.4 MB" */
export const bytes = (n) => (Math.abs(n) < 1000 ? `${integer(n)}${SPACE}B` : `${short(n)}B`);

/** A part of a whole: 0.123 -> "12.3 %" */
export function percent(part) {
  if (!Number.isFinite(part)) return '-';
  const of = 100 * part;
  if (of === 0) return `0${SPACE}%`;
  return Math.abs(of) < 0.05 ? `<0.1${SPACE}%` : `${of.toFixed(1)}${SPACE}%`;
}

/** a / b, or NaN where there is nothing to divide by */
export const ratio = (a, b) => (b > 0 ? a / b : NaN);

/** A number with its exact value behind it. */
export const number = (value, format = integer, id) =>
  h('span', { class: 'number', 'data-value': value, title: String(value), id }, format(value));

/** "triangle_setup" -> "triangle setup" */
export const words = (name) => String(name).replaceAll('_', ' ');

/** "core", or "link coarse to fine" of "link.coarse_to_fine" */
export const unitOrLink = (of) => words(of.replace(/^link\./, 'link '));

export function seconds(s) {
  if (s >= 100) return `${integer(s)}${SPACE}s`;
  if (s >= 1) return `${s.toFixed(2)}${SPACE}s`;
  return `${decimal(1000 * s)}${SPACE}ms`;
}
