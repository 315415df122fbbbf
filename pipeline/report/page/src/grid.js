// Tables that sort and filter, by Tabulator. Cells are built as elements, so that a name is never read as HTML.
import {
  ColumnCalcsModule, EditModule, FilterModule, FormatModule, FrozenColumnsModule, InteractionModule, KeybindingsModule,
  ResizeColumnsModule, ResizeTableModule, SelectRowModule, SortModule, Tabulator, TooltipModule,
} from 'tabulator-tables';
import { h } from './dom.js';
import { integer } from './format.js';
import { definition } from './terms.js';

Tabulator.registerModule([
  ColumnCalcsModule, EditModule, FilterModule, FormatModule, FrozenColumnsModule, InteractionModule, KeybindingsModule,
  ResizeColumnsModule, ResizeTableModule, SelectRowModule, SortModule, TooltipModule,
]);

export const tables = new Map(); // by id: what tests and curious readers ask for

const cell = (format) => (c) => {
  const value = c.getValue();
  return h('span', { 'data-value': value ?? '', title: value === undefined || value === null ? null : String(value) },
    value === undefined || value === null ? '-' : format(value));
};

/** A column of text. */
export const textColumn = (title, field, more = {}) => ({
  title, field, formatter: cell(String), headerTooltip: definition(title) ?? false,
  headerFilter: 'input', headerFilterPlaceholder: 'has ...', headerFilterFunc: 'like', ...more,
});

/** A column of numbers; its filter is the least that is shown. */
export const numberColumn = (title, field, format = integer, more = {}) => ({
  title, field, formatter: cell(format), headerTooltip: definition(title) ?? false, hozAlign: 'right', headerHozAlign: 'right', sorter: 'number',
  headerSortStartingDir: 'desc', headerFilter: 'number', headerFilterPlaceholder: '>=', headerFilterFunc: '>=', ...more,
});

/** A row below the table that adds the column up over the rows that pass the filters. */
export const added = (format = integer) => ({ bottomCalc: 'sum', bottomCalcFormatter: cell(format) });

/** A table of the rows; `height` in pixels. */
export function grid(id, columns, rows, height, options = {}) {
  const host = h('div', { id, class: 'grid' });
  const made = { host, table: null };
  tables.set(id, made);
  // It measures its host, which has a size only once it stands in the page.
  new ResizeObserver((_, observer) => {
    if (host.clientWidth === 0) return;
    observer.disconnect();
    made.table = new Tabulator(host, {
      data: rows, columns, height, layout: 'fitDataFill', columnDefaults: { resizable: true }, columnHeaderVertAlign: 'bottom', placeholder: 'Nothing passes the filters',
      ...options,
    });
    made.onMade?.(made.table);
  }).observe(host);
  return made;
}
