// Conservation laws: the two sides of each, counted by different units.
import { h } from '../dom.js';
import { number } from '../format.js';
import { section, table } from '../layout.js';

export function laws({ figures }) {
  const { checks } = figures;
  if (checks.length === 0) return null;
  const broken = checks.filter((law) => !law.holds);
  const columns = [
    { title: '', of: (law) => h('span', { class: law.holds ? 'good' : 'bad', title: law.holds ? 'holds' : 'broken' }, law.holds ? '=' : '≠') },
    { title: 'law', of: (law) => law.law },
    { title: 'one side', of: (law) => law.left.name }, { title: '', number: true, of: (law) => number(law.left.value) },
    { title: 'the other', of: (law) => law.right.name }, { title: '', number: true, of: (law) => number(law.right.value) },
  ];
  return section('laws', 'Laws checked', 'What goes in comes out, or is counted where it ended. The two sides of each law are counted by different units.',
    broken.length > 0 && table('broken-laws', columns, broken),
    h('details', { open: broken.length > 0 }, h('summary', null, `${checks.length - broken.length} of ${checks.length} hold`), table('laws-table', columns, checks)));
}
