// What the frame does not need and was therefore not built or computed.
import { section, table } from '../layout.js';

export function leftOut({ figures }) {
  if (figures.left_out.length === 0) return null;
  return section('left-out', 'Left out', 'What this frame does not need was not built or computed. Neither picture nor cycles change by that.',
    table('left-out-table', [{ title: 'what', of: (l) => l.what }, { title: 'why', of: (l) => l.why }, { title: 'saved', of: (l) => l.saved }], figures.left_out));
}
