// Charts by ECharts, in the page's colours, and drawn again when those change.
import * as echarts from 'echarts/core';
import { BarChart, HeatmapChart, LineChart, ParallelChart, ScatterChart } from 'echarts/charts';
import {
  AriaComponent, DataZoomComponent, GridComponent, LegendComponent, MarkLineComponent, ParallelComponent,
  TooltipComponent, VisualMapComponent,
} from 'echarts/components';
import { CanvasRenderer } from 'echarts/renderers';
import { h } from './dom.js';
import { colour, onTheme } from './theme.js';

echarts.use([
  BarChart, HeatmapChart, LineChart, ParallelChart, ScatterChart, AriaComponent, DataZoomComponent, GridComponent, LegendComponent,
  MarkLineComponent, ParallelComponent, TooltipComponent, VisualMapComponent, CanvasRenderer,
]);

export const charts = new Map(); // by id: what tests and curious readers ask for

/** Colours that the colour-blind tell apart [P: Okabe, Ito 2008]; states of units have theirs in the style sheet. */
export const PALETTE = ['#0072b2', '#e69f00', '#009e73', '#cc79a7', '#56b4e9', '#d55e00', '#f0e442', '#8c8c8c'];

/** Numbers as colours, light to dark alike for all eyes: cividis [P: Nuñez, Anderton, Renslow 2018], thinned out. */
export const CIVIDIS = ['#00224e', '#123570', '#3b496c', '#575d6d', '#707173', '#8a8678', '#a59c74', '#c3b369', '#e1cc55', '#fee838'];

/** What every chart shares: letters, lines, tooltip. */
export function basics() {
  const ink = colour('ink');
  const soft = colour('soft');
  const line = colour('line');
  return {
    animation: false,
    textStyle: { color: ink, fontFamily: colour('font') },
    aria: { enabled: true },
    tooltip: {
      confine: true,
      backgroundColor: colour('raised'),
      borderColor: line,
      textStyle: { color: ink, fontSize: 13 },
      extraCssText: 'max-width: 28rem; white-space: normal; box-shadow: var(--shadow);',
    },
    axis: {
      axisLine: { lineStyle: { color: line } },
      axisTick: { show: false },
      axisLabel: { color: soft, fontSize: 12 },
      splitLine: { lineStyle: { color: line } },
      nameTextStyle: { color: soft, fontSize: 12 },
    },
    legend: { textStyle: { color: ink, fontSize: 12 }, icon: 'roundRect', itemWidth: 12, itemHeight: 12, itemGap: 16 },
  };
}

/** A chart of the height given. `option(basics)` is asked again for each theme; `label` says what it shows. */
export function chart(id, height, label, option) {
  const host = h('div', { class: 'chart', id, role: 'img', 'aria-label': label, style: `height:${height}px` });
  const made = { host, instance: null, refresh() { made.instance?.setOption(option(basics()), true); } };
  charts.set(id, made);
  // ECharts measures its host, which has a size only once it stands in the page.
  new ResizeObserver(() => {
    if (host.clientWidth === 0) return;
    if (made.instance) made.instance.resize();
    else {
      made.instance = echarts.init(host, null, { renderer: 'canvas' });
      made.refresh();
      for (const then of made.whenReady ?? []) then(made.instance);
    }
  }).observe(host);
  onTheme(() => made.refresh());
  made.ready = (then) => (made.instance ? then(made.instance) : (made.whenReady ??= []).push(then));
  return made;
}

/** A tooltip as rows of a name and a number, under a heading. ECharts takes the element as it is. */
export function tip(heading, rows, note) {
  return h('div', { class: 'tip' },
    h('strong', null, heading),
    h('table', null, rows.map(([name, value, mark]) =>
      h('tr', null, h('td', null, mark && h('i', { class: 'mark', style: `background:${mark}` }), name), h('td', null, value)))),
    note && h('p', null, note));
}
