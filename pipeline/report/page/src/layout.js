// The frame of the page: a bar on top, the list of sections beside them.
import { h } from './dom.js';
import { themeButton } from './theme.js';

/** A section: heading, a line that says what to look for, and what it shows. */
export function section(id, title, lead, ...content) {
  return h('section', { id, 'aria-labelledby': `${id}-title` },
    h('h2', { id: `${id}-title` }, title),
    lead && h('p', { class: 'lead' }, lead),
    ...content);
}

/** A part of a section with a heading of its own. */
export const panel = (title, ...content) => h('div', { class: 'panel' }, title && h('h3', null, title), ...content);

/** Puts the sections into the page. `title` and `subtitle` are of the page. */
export function showPage(title, subtitle, sections) {
  const links = sections.map((s) => h('a', { href: `#${s.id}` }, s.querySelector('h2').textContent));
  const nav = h('nav', { 'aria-label': 'Sections' }, links);
  document.getElementById('page').replaceChildren(
    h('a', { class: 'skip', href: '#content' }, 'To the figures'),
    h('header', null, h('div', { class: 'name' }, h('h1', null, title), h('p', null, subtitle)), themeButton()),
    nav,
    h('main', { id: 'content', tabindex: -1 }, sections,
      h('footer', null, 'Written by Quadrille. Every number is one of its figures, or computed from them where a hover says so.')));
  const observer = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      for (const link of links) link.toggleAttribute('aria-current', link.hash === `#${entry.target.id}`);
    }
  }, { rootMargin: '-15% 0px -75% 0px' });
  for (const s of sections) observer.observe(s);
}

/** A plain table. Columns: { title, of(row), number } ; `of` returns text, an element, or a list of them. */
export function table(id, columns, rows, footer) {
  const cell = (tag) => (column, content) => h(tag, { class: column.number ? 'right' : null, scope: tag === 'th' ? 'col' : null }, content);
  return h('div', { class: 'scroll' }, h('table', { id, class: 'plain' },
    h('thead', null, h('tr', null, columns.map((c) => cell('th')(c, c.title)))),
    h('tbody', null, rows.map((row) => h('tr', null, columns.map((c) => cell('td')(c, c.of(row)))))),
    footer && h('tfoot', null, h('tr', null, columns.map((c) => cell('td')(c, c.of(footer)))))));
}
