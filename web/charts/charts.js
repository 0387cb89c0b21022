// The charts of reports: an option in, as C++ writes it (sessions/charts/chart_option.h), a chart out. The same code runs in
// the page and, for pictures, in Duktape: so it keeps to ECMAScript 5.
import * as echarts from 'echarts/core';
import { CustomChart, LineChart, ScatterChart } from 'echarts/charts';
import { DataZoomComponent, GridComponent, LegendComponent, MarkAreaComponent, MarkLineComponent, TooltipComponent } from 'echarts/components';
import { SVGRenderer } from 'echarts/renderers';
import { named } from './named_functions.js';

echarts.use([CustomChart, LineChart, ScatterChart, DataZoomComponent, GridComponent, LegendComponent, MarkAreaComponent,
  MarkLineComponent, TooltipComponent, SVGRenderer]);

// JSON has no functions: where the option says "@bar", the function `bar` of named_functions.js stands afterwards.
function withFunctions(value) {
  if (typeof value === 'string' && value.charAt(0) === '@') return named[value.slice(1)];
  if (value === null || typeof value !== 'object') return value;
  for (var key in value) {
    // Data are numbers and texts of others: no function is named there.
    if (key !== 'data' && key !== 'name' && key !== 'told') value[key] = withFunctions(value[key]);
  }
  return value;
}

// The chart as SVG text.
export function drawSvg(optionJson, width, height) {
  var chart = echarts.init(null, null, { renderer: 'svg', ssr: true, width: width, height: height });
  chart.setOption(withFunctions(JSON.parse(optionJson)));
  var svg = chart.renderToSVGString();
  chart.dispose();
  return svg;
}

// The chart in the page, with tooltips, and with a zoom along x where the option asks for one.
export function mount(element, option, height) {
  var chart = echarts.init(element, null, { renderer: 'svg', height: height });
  var shown = withFunctions(option);
  if (shown.zooms) shown.dataZoom = [{ type: 'inside', xAxisIndex: 'all', filterMode: 'none', zoomOnMouseWheel: 'ctrl', moveOnMouseWheel: false }];
  chart.setOption(shown);
  return chart;
}
