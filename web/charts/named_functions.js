// Functions that options name by "@NAME". ECMAScript 5, as charts.js.
import { graphic } from 'echarts/core';

function escaped(text) {
  return String(text).replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/>/g, '&gt;').replace(/"/g, '&quot;').replace(/'/g, '&#39;');
}

function number(value) {
  return String(Math.round(value * 100) / 100);
}

function clipped(shape, params) {
  return graphic.clipRectByRect(shape, params.coordSys);
}

// A bar on a lane: value = [from, to, lane, share of the lane's height]; a bar of no width is 2 px wide.
function bar(params, api) {
  var from = api.coord([api.value(0), api.value(2)]), to = api.coord([api.value(1), api.value(2)]);
  var height = api.size([0, 1])[1] * api.value(3);
  var shape = clipped({ x: from[0], y: from[1] - height / 2, width: Math.max(to[0] - from[0], 2), height: height }, params);
  return shape && { type: 'rect', shape: shape, style: { fill: api.visual('color'), stroke: 'none' } };
}

// The frame of a bar, with its number above where it fits.
function frame(params, api) {
  var drawn = bar(params, api);
  if (!drawn) return drawn;
  drawn.style = { fill: 'transparent', stroke: api.visual('color'), lineWidth: 1 };
  drawn.shape.r = 2;
  return drawn;
}

// An area between two curves: value = [x, low, high], all of them in one polygon, in pieces where a value is missing.
function band(params, api) {
  if (params.dataIndexInside !== 0) return null;
  var pieces = [], piece = { low: [], high: [] };
  function close() {
    if (piece.low.length > 0) pieces.push(piece.low.concat(piece.high.reverse()));
    piece = { low: [], high: [] };
  }
  for (var i = 0; i < params.dataInsideLength; ++i) {
    var x = api.value(0, i), low = api.value(1, i), high = api.value(2, i);
    if (isNaN(low) || isNaN(high)) { close(); continue; }
    piece.low.push(api.coord([x, low]));
    piece.high.push(api.coord([x, high]));
  }
  close();
  var children = [];
  for (var k = 0; k < pieces.length; ++k)
    children.push({ type: 'polygon', shape: { points: pieces[k] }, style: { fill: api.visual('color'), opacity: 0.3, stroke: api.visual('color'), lineWidth: 0.7 } });
  return { type: 'group', children: children };
}

// A segment with ends: value = [x, low, high].
function whisker(params, api) {
  var low = api.coord([api.value(0), api.value(1)]), high = api.coord([api.value(0), api.value(2)]), style = { stroke: api.visual('color'), lineWidth: 1.2 };
  function line(x1, y1, x2, y2) {
    return { type: 'line', shape: { x1: x1, y1: y1, x2: x2, y2: y2 }, style: style };
  }
  return { type: 'group', children: [line(low[0], low[1], high[0], high[1]), line(low[0] - 4, low[1], low[0] + 4, low[1]), line(high[0] - 4, high[1], high[0] + 4, high[1])] };
}

// Of a bar: the text that comes with it.
function told(params) {
  return params.data && params.data.told ? escaped(params.data.told) : '';
}

// Of lines along x: each one's value there.
function values(params) {
  var list = params.length === undefined ? [params] : params;
  if (list.length === 0) return '';
  var text = number(list[0].value[0]) + ' ' + escaped(list[0].axisUnit || '');
  for (var i = 0; i < list.length; ++i) {
    var value = list[i].value, unit = list[i].dimensionNames && list[i].dimensionNames[list[i].dimensionNames.length - 1];
    if (!value || value[1] === null || value[1] === undefined) continue;
    text += '<br>' + escaped(list[i].seriesName) + ': ' + number(value[1]) + (value.length > 2 && value[2] !== null ? ' to ' + number(value[2]) : '') + (unit === 'mm' ? ' mm' : '');
  }
  return text;
}

export var named = { band: band, bar: bar, frame: frame, told: told, values: values, whisker: whisker };
