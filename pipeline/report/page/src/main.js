// Shows what the program put into the page: the figures of a frame, two of them beside each other, a row of frames, or a sweep over machines.
import 'tabulator-tables/dist/css/tabulator.min.css';
import './style.css';
import { block } from './data.js';
import { charts } from './chart.js';
import { showFrames } from './frames.js';
import { showComparison } from './comparison.js';
import { tables } from './grid.js';
import { showReport } from './report.js';
import { showSweep } from './sweep.js';
import { startTheme } from './theme.js';

startTheme();
const figures = block('figures');
const comparison = block('comparison');
const frames = block('frames');
const sweep = block('sweep');
if (figures) showReport(figures, block('plan'), block('pictures'), block('squares'));
if (comparison) showComparison(comparison);
if (frames) showFrames(frames);
if (sweep) showSweep(sweep);
window.quadrille = { figures, squares: block('squares'), comparison, frames, sweep, charts, tables };
