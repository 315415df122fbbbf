// Every parameter of the machine, those changed marked.
import { choice, h } from '../dom.js';
import { integer } from '../format.js';
import { grid, textColumn } from '../grid.js';
import { section } from '../layout.js';

export function parameters({ figures, plan }) {
  const { changed, parameters: all, base } = figures.machine;
  const rows = Object.entries(all).map(([path, value]) => ({
    path, value: String(value), base: path in changed ? String(changed[path].base) : '', unit: plan.parameters[path]?.unit ?? '',
    legal: plan.parameters[path]?.legal ?? '', reason: plan.parameters[path]?.reason ?? '', changed: path in changed,
  }));
  const count = Object.keys(changed).length;
  const made = grid('parameters-table', [
    textColumn('parameter', 'path', { width: 240 }), textColumn('value', 'value', { width: 92, hozAlign: 'right', headerHozAlign: 'right' }),
    textColumn(`in ${base}`, 'base', { width: 98, headerFilter: false, headerTooltip: 'The value of the machine that this one was made from, where it differs' }),
    textColumn('unit', 'unit', { width: 98, headerFilter: false }), textColumn('legal', 'legal', { width: 150, headerFilter: false }),
    textColumn('what and why', 'reason', { minWidth: 200, widthGrow: 1 }),
  ], rows, 420, { layout: 'fitColumns', rowFormatter: (row) => row.getElement().classList.toggle('changed', row.getData().changed) });
  const show = choice('Which', [{ value: 'all', text: `All (${integer(rows.length)})` }, { value: 'changed', text: `Changed (${integer(count)})` }], 'all', (value) => {
    if (value === 'changed') made.table.setFilter('changed', '=', true);
    else made.table.clearFilter();
  });
  const list = Object.entries(changed).map(([path, { value, base: was }]) => h('li', null, h('code', null, path), ` = ${value}`, h('span', { class: 'soft' }, ` instead of ${was}`)));
  return section('parameters', 'Parameters',
    count === 0 ? `The machine is ${base} as it comes with the program.` : `What differs from ${base}:`,
    count > 0 && h('ul', { id: 'changed', class: 'changes' }, list),
    show.element, made.host);
}
