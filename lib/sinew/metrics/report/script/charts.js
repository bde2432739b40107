// SPDX-License-Identifier: GPL-3.0-or-later
// The charts: hover for values, drag for a part of the time, double-click for all of it.
"use strict";

const dashes = [[], [], [], [7, 4], [2, 4], [9, 3, 2, 3]];
const timeCharts = [];
const marked = { time: null, go: null }; // the 3D view's time, and the way to change it

const asXY = (points) => points.map(([x, y]) => ({ x, y: y === null ? NaN : y }));

function lineSet(line, i) {
  return {
    label: line.name,
    data: asXY(line.points),
    yAxisID: "y",
    slot: i % 6,
    borderWidth: 2,
    borderDash: dashes[i % 6],
    pointRadius: 0,
    pointHitRadius: 8,
    pointHoverRadius: 4,
    borderJoinStyle: "round",
  };
}

function angleSet() {
  return { label: "bones", data: asXY(data.angles), yAxisID: "angle", fill: "origin",
    slot: "angle", borderWidth: 1, pointRadius: 0, pointHoverRadius: 3 };
}

function paint(chart) {
  const [ink, quiet, rule] = ["--ink", "--quiet", "--rule"].map(colorOf);
  for (const set of chart.data.datasets) {
    const own = set.slot === "angle" ? quiet : colorOf(`--c${set.slot + 1}`);
    Object.assign(set, { borderColor: own, pointBackgroundColor: own,
      backgroundColor: set.slot === "angle" ? `${quiet}40` : own });
  }
  for (const scale of Object.values(chart.options.scales)) {
    scale.ticks.color = scale.title.color = quiet;
    scale.grid.color = scale.grid.borderColor = rule;
  }
  Object.assign(chart.options.plugins.tooltip, { backgroundColor: colorOf("--card"),
    titleColor: ink, bodyColor: ink, borderColor: rule, borderWidth: 1 });
  chart.update("none");
}

/** A vertical line at the 3D view's time, and the range being dragged. */
const marks = {
  id: "marks",
  afterDatasetsDraw(chart) {
    const { ctx, chartArea: area, scales } = chart;
    ctx.save();
    if (marked.time !== null && chart.ofTime) {
      const x = scales.x.getPixelForValue(marked.time);
      ctx.fillStyle = colorOf("--ink");
      if (x >= area.left && x <= area.right) ctx.fillRect(x - 0.5, area.top, 1, area.height);
    }
    if (chart.dragged) {
      const [from, to] = chart.dragged;
      ctx.fillStyle = `${colorOf("--c1")}30`;
      ctx.fillRect(Math.min(from, to), area.top, Math.abs(to - from), area.height);
    }
    ctx.restore();
  },
};

/** Shows the times between low and high (s; undefined: all) in every chart. */
function showTimes(low, high) {
  for (const chart of timeCharts) {
    Object.assign(chart.options.scales.x, { min: low ?? chart.wholeTime[0],
      max: high ?? chart.wholeTime[1] });
    chart.update("none");
  }
}

const leastDrag = 6; // pixels; less is a click

function endDrag(chart) {
  if (!chart.dragged) return;
  const [from, to] = [...chart.dragged].sort((a, b) => a - b);
  const at = (x) => chart.scales.x.getValueForPixel(x);
  chart.dragged = null;
  if (to - from >= leastDrag) showTimes(at(from), at(to));
  else if (marked.go) marked.go(at(to));
  chart.draw();
}

function listen(chart) {
  const canvas = chart.canvas;
  const within = (event) =>
    Math.min(Math.max(event.offsetX, chart.chartArea.left), chart.chartArea.right);
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    chart.dragged = [within(event), within(event)];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!chart.dragged) return;
    chart.dragged[1] = within(event);
    chart.draw();
  });
  canvas.addEventListener("pointerup", () => endDrag(chart));
  canvas.addEventListener("pointercancel", () => { chart.dragged = null; });
  canvas.addEventListener("dblclick", () => showTimes());
}

const plainScale = (text) => ({ ticks: { maxTicksLimit: 6, maxRotation: 0, callback: readable },
  grid: {}, title: { display: Boolean(text), text } });

/** The bones' angle lies in a strip beneath; its one text stands within it. */
const angleScale = () => ({ ...plainScale(""), axis: "y", position: "left", stack: "all",
  stackWeight: 1, min: 0, ticks: { maxTicksLimit: 2, mirror: true, labelOffset: 9,
    callback: (value) => (value > 0 ? `bones ${readable(value)}°` : "") } });

function timeScales(chart, [low, high]) {
  const ends = (chart.baselines.length ? chart.baselines : [NaN]);
  const scales = data.angles.length ? { angle: angleScale() } : {};
  scales.y = { ...plainScale(chart.unit), axis: "y", position: "left", stack: "all", stackWeight: 5,
    suggestedMin: Math.min(...ends), suggestedMax: Math.max(...ends) };
  scales.x = { ...plainScale(""), type: "linear", min: low, max: high };
  scales.x.ticks.callback = (value, i, ticks) =>
    readable(value) + (i === ticks.length - 1 ? " s" : "");
  return scales;
}

const tooltip = {
  callbacks: {
    title: (items) => (items.length ? `${readable(items[0].parsed.x)} s` : ""),
    label: (item) => ` ${item.dataset.label}: ${readable(item.parsed.y)}` +
      (item.dataset.slot === "angle" ? "°" : ""),
  },
};

function options(scales) {
  return { animation: false, responsive: true, maintainAspectRatio: false, normalized: true,
    interaction: { mode: "nearest", axis: "x", intersect: false }, scales,
    plugins: { legend: { display: false }, tooltip: { boxPadding: 4 } } };
}

/** A canvas in the place of the figure's drawing. */
function canvasIn(figure, label) {
  const canvas = element("canvas", { role: "img", ariaLabel: label });
  figure.querySelector("svg, noscript")?.remove();
  figure.append(element("div", { className: "plot" }, [canvas]));
  return canvas;
}

function wholeTime(chart) {
  const times = chart.lines.flatMap((line) => line.points.map((point) => point[0]));
  return times.length ? [Math.min(...times), Math.max(...times)] : [0, 1];
}

function timeChart(figure, plan) {
  const whole = wholeTime(plan);
  const settings = options(timeScales(plan, whole));
  settings.plugins.tooltip = { ...settings.plugins.tooltip, ...tooltip };
  const datasets = plan.lines.map(lineSet);
  if (data.angles.length) datasets.push(angleSet());
  const chart = new Chart(canvasIn(figure, `${plan.title} against time`),
    { type: "line", data: { datasets }, options: settings, plugins: [marks] });
  Object.assign(chart, { ofTime: true, wholeTime: whole });
  timeCharts.push(chart);
  listen(chart);
  return chart;
}

function curveChart(figure, curve) {
  const settings = options({ x: { ...plainScale(curve.across), type: "linear" },
    y: plainScale(curve.up) });
  settings.plugins.legend = { display: curve.lines.length > 1,
    labels: { boxHeight: 0, color: colorOf("--quiet") } };
  settings.plugins.tooltip.callbacks = { title: (items) => readable(items[0].parsed.x),
    label: (item) => ` ${item.dataset.label}: ${readable(item.parsed.y)}` };
  return new Chart(canvasIn(figure, curve.title),
    { type: "line", data: { datasets: curve.lines.map(lineSet) }, options: settings });
}

function drawCharts() {
  const figures = [...document.querySelectorAll("figure.chart")];
  const curves = [...document.querySelectorAll("figure.curve")];
  const all = [...figures.map((figure, i) => timeChart(figure, data.charts[i])),
    ...curves.map((figure, i) => curveChart(figure, data.curves[i]))];
  const paintAll = () => all.forEach(paint);
  paintAll();
  whenDarkChanges(paintAll);
  return all;
}

/** Marks a time in all charts, s. */
function markTime(time) {
  marked.time = time;
  for (const chart of timeCharts) chart.draw();
}
