// SPDX-License-Identifier: GPL-3.0-or-later
// The charts: hover for values, drag for a part of the time, double-click for all of it.
"use strict";

// Later lines are drawn over earlier ones, which show between their dashes where both coincide.
const dashes = [[], [9, 4], [3, 3], [12, 3, 3, 3], [6, 2], [2, 5]];
const timeCharts = [];
const marked = { time: null, go: null }; // the 3D view's time, and the function that changes it

const asXY = (points) => points.map(([x, y]) => ({ x, y: y === null ? NaN : y }));

/** Whether a point has no neighbor to draw a line to. */
const alone = ({ dataset, dataIndex: i }) =>
  [i - 1, i + 1].every((k) => Number.isNaN(dataset.data[k]?.y ?? NaN));

function lineSet(line, i) {
  const color = palette[i % palette.length];
  return { label: line.name, data: asXY(line.points), yAxisID: "y", order: -i,
    borderColor: color, backgroundColor: color, borderWidth: 2, borderDash: dashes[i % dashes.length],
    borderJoinStyle: "round", pointRadius: (context) => (alone(context) ? 2.5 : 0),
    pointHoverRadius: 4 };
}

function angleSet() {
  const color = colorOf("--quiet");
  return { label: "bones", data: asXY(data.angles), yAxisID: "angle", fill: "origin",
    borderColor: color, backgroundColor: `${color}40`, borderWidth: 1, pointRadius: 0,
    pointHoverRadius: 3 };
}

/** A vertical line at the 3D view's time, and the range being dragged. */
const marks = {
  id: "marks",
  afterDatasetsDraw(chart) {
    const { ctx, chartArea: area, scales } = chart;
    ctx.save();
    if (marked.time !== null) {
      const x = scales.x.getPixelForValue(marked.time);
      ctx.fillStyle = colorOf("--ink");
      if (x >= area.left && x <= area.right) ctx.fillRect(x - 0.5, area.top, 1, area.height);
    }
    if (chart.dragged) {
      const [from, to] = chart.dragged;
      ctx.fillStyle = `${palette[0]}30`;
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
    if (event.button !== 0 || event.offsetY < chart.chartArea.top) return; // above: the legend
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

/** Decimals needed to distinguish ticks, which are multiples of 1, 2 or 5 times a power of ten. */
function tickText(value, _, ticks) {
  if (value === 0) return "0";
  const largest = Math.max(...ticks.map((tick) => Math.abs(tick.value)));
  const power = largest >= 1e5 || largest < 1e-3 ? Math.floor(Math.log10(largest)) : 0;
  const step = ticks.length > 1 ? Math.abs(ticks[1].value - ticks[0].value) : largest;
  const decimals = Math.max(0, Math.ceil(power - Math.log10(step) - 1e-9));
  const text = (value / 10 ** power).toFixed(decimals) + (power ? `e${power}` : "");
  return text.replaceAll("-", "−");
}

/** size: the factor of the unit's prefix, by which values are divided. */
const plainScale = (text, size = 1) => ({ ticks: { maxTicksLimit: 6, maxRotation: 0, includeBounds: false,
  callback: (value, k, ticks) => tickText(value / size, k, ticks.map((tick) => ({ value: tick.value / size }))) },
  title: { display: Boolean(text), text } });

const valuesOf = (chart) => chart.lines.flatMap((line) => line.points.map((point) => point[1]))
  .filter((value) => value !== null);

/** The scale of a chart's values, in the unit in which its largest takes few digits. */
function valueScale(chart) {
  const [prefix, size] = prefixOf(Math.max(0, ...valuesOf(chart).map(Math.abs)), chart.unit);
  return plainScale(chart.unit && `in ${prefix}${chart.unit}`, size);
}

const leastSpan = 1e-3; // of the values' size: below it a line is flat, not noise

/** Limits that the scale always includes: the baselines, and a margin around a flat line. */
function shownEnds(chart) {
  const values = valuesOf(chart).concat(chart.baselines);
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const [middle, size] = [(low + high) / 2, Math.max(Math.abs(low), Math.abs(high))];
  const range = Math.max(high - low, leastSpan * size), half = range / 2;
  if (chart.span > range)  // from the baseline on, where all lies above it
    return { suggestedMin: low, suggestedMax: low + chart.span };
  return { suggestedMin: middle - half, suggestedMax: size === 0 ? 1 : middle + half };
}

/** The bones' angle is in a strip beneath, as high as the largest angle, which is its one label. */
function angleScale() {
  const most = Math.max(...data.angles.map((point) => point[1] ?? 0));
  return { axis: "y", position: "left", stack: "all", stackWeight: 1, min: 0, max: most || 1,
    afterBuildTicks: (scale) => { scale.ticks = [{ value: scale.max }]; },
    ticks: { mirror: true, labelOffset: 9, callback: () => `bones ${readable(most)}°` } };
}

function timeScales(chart, [low, high]) {
  const scales = data.angles.length ? { angle: angleScale() } : {};
  scales.y = { ...valueScale(chart), ...shownEnds(chart), axis: "y", position: "left",
    stack: "all", stackWeight: 5 };
  scales.x = { ...plainScale("time (s)"), type: "linear", min: low, max: high };
  return scales;
}

const asListed = (one, other) => one.datasetIndex - other.datasetIndex;

/** unit: of what is across; valueUnit: of the values. */
function options(scales, unit, valueUnit = "") {
  return { animation: false, maintainAspectRatio: false, normalized: true, scales,
    interaction: { mode: "nearest", axis: "x", intersect: false },
    plugins: {
      legend: { align: "start", labels: { boxHeight: 0, boxWidth: 30, padding: 10,
        sort: asListed } },
      tooltip: { boxPadding: 4, itemSort: asListed, callbacks: {
        title: (items) => (items.length ? `${readable(items[0].parsed.x)} ${unit}` : ""),
        label: ({ dataset, parsed }) => ` ${dataset.label}: ` + (dataset.yAxisID === "angle"
          ? `${readable(parsed.y)}°` : quantityText(parsed.y, valueUnit)),
      } },
    } };
}

/** A figure with its heading and a canvas, added to the section. */
function canvasIn(section, { title, note }) {
  const canvas = element("canvas", { role: "img", ariaLabel: title });
  section.append(element("figure", {}, [
    element("figcaption", {}, [element("h3", { textContent: title }),
      element("p", { textContent: note })]),
    element("div", { className: "plot" }, [canvas])]));
  return canvas;
}

function wholeTime(chart) {
  const times = chart.lines.flatMap((line) => line.points.map((point) => point[0]));
  const [low, high] = [Math.min(...times), Math.max(...times)];
  return low < high ? [low, high] : [low - 0.5, low + 0.5];
}

function timeChart(plan) {
  const whole = wholeTime(plan);
  const datasets = plan.lines.map(lineSet);
  const settings = options(timeScales(plan, whole), "s", plan.unit ?? "");
  settings.plugins.legend.labels.filter = (item) => item.text !== "bones";
  if (data.angles.length) datasets.push(angleSet());
  const chart = new Chart(canvasIn(byId(plan.folded ? "quiet-charts" : "charts"), plan),
    { type: "line", data: { datasets }, options: settings, plugins: [marks] });
  chart.wholeTime = whole;
  timeCharts.push(chart);
  listen(chart);
  return chart;
}

const curveChart = (curve) => new Chart(canvasIn(byId("curves"), curve),
  { type: "line", data: { datasets: curve.lines.map(lineSet) },
    options: options({ x: { ...plainScale(curve.across), type: "linear" },
      y: plainScale(curve.up) }, "") });

/** In print, two charts are placed side by side, in higher resolution than on a screen. */
function followPrinting(charts) {
  const size = (ratio, ...widthAndHeight) => charts.forEach((chart) => {
    chart.options.devicePixelRatio = ratio;
    chart.resize(...widthAndHeight);
  });
  addEventListener("beforeprint", () => size(3, 360, 230));
  addEventListener("afterprint", () => size(devicePixelRatio));
}

function drawCharts() {
  const { defaults } = Chart;
  Object.assign(defaults, { color: colorOf("--ink"), borderColor: colorOf("--rule") });
  defaults.font.family = getComputedStyle(document.body).fontFamily;
  const quiet = byId("quiet"); // none on a page without charts over time
  if (quiet) {
    quiet.hidden = !data.charts.some((chart) => chart.folded);
    quiet.open = true; // a chart that is drawn while it is folded has no size
  }
  const charts = [...data.charts.map(timeChart), ...data.curves.map(curveChart)];
  const machine = machineChart();
  if (machine) charts.push(machine);
  if (quiet) quiet.open = false;
  followPrinting(charts);
  return charts;
}

/** Marks a time in all charts, s. */
function markTime(time) {
  marked.time = time;
  for (const chart of timeCharts) chart.draw();
}
