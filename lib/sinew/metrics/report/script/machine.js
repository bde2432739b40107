// SPDX-License-Identifier: GPL-3.0-or-later
// The testing machine: any column of supports.csv and probes.csv over any other.
"use strict";

const titleOf = ({ name, unit }) => (unit ? `${name} (${unit})` : name);

/** Both columns as points in the order of time. */
const pairs = (across, up) => across.values.map((x, i) => ({ x: x ?? NaN, y: up.values[i] ?? NaN }));

function columnChoice(label, columns, chosen) {
  const select = element("select", { ariaLabel: label },
    columns.map((column, i) => element("option", { value: String(i), textContent: titleOf(column) })));
  select.value = String(chosen);
  return select;
}

/** Draws the chart with its two choices; null for a scene without a machine. */
function machineChart() {
  if (!data.machine) return null;
  const { columns, across, up } = data.machine;
  const [overX, overY] = [columnChoice("across", columns, across), columnChoice("up", columns, up)];
  byId("machine").append(element("div", { className: "choices" }, [
    element("label", {}, ["up ", overY]), element("label", {}, ["across ", overX])]));
  const scales = { x: { ...plainScale(""), type: "linear" }, y: plainScale("") };
  const settings = options(scales, "");
  Object.assign(settings, { normalized: false, interaction: { mode: "nearest", axis: "xy", intersect: false } });
  settings.plugins.legend = { display: false };
  const color = palette[0];
  const chart = new Chart(canvasIn(byId("machine"), { title: "Load over displacement", note: "" }),
    { type: "line", options: settings, data: { datasets: [{ data: [], borderColor: color,
      backgroundColor: color, borderWidth: 2, pointRadius: 1.5, pointHoverRadius: 4 }] } });
  const show = () => {
    const [x, y] = [columns[Number(overX.value)], columns[Number(overY.value)]];
    const heading = `${y.name} over ${x.name}`;
    Object.assign(chart.data.datasets[0], { label: y.name, data: pairs(x, y), yAxisID: "y" });
    chart.options.scales.x.title = { display: true, text: titleOf(x) };
    chart.options.scales.y.title = { display: true, text: titleOf(y) };
    chart.canvas.closest("figure").querySelector("h3").textContent = heading;
    chart.canvas.ariaLabel = heading;
    chart.update("none");
  };
  for (const select of [overX, overY]) select.addEventListener("change", show);
  show();
  return chart;
}
