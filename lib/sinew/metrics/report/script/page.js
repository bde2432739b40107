// SPDX-License-Identifier: GPL-3.0-or-later
// Starts the page. window.sinewState describes what is shown, for tests.
"use strict";

function sayWithout(reason) {
  const message = byId("stage").querySelector(".message");
  message.textContent = `The 3D view needs WebGL, which this browser does not offer (${reason}). ` +
    "Everything else on this page works without.";
  message.hidden = false;
  byId("view").classList.add("without");
}

function begin() {
  document.documentElement.classList.add("scripted");
  const charts = drawCharts();
  makeSortable();
  let playback = null;
  if (byId("playback"))
    try {
      playback = startPlayback(JSON.parse(byId("playback").textContent));
    } catch (error) {
      sayWithout(error.message);
    }
  window.sinewState = () => ({
    charts: charts.length,
    timeRange: timeCharts.length ? [timeCharts[0].scales.x.min, timeCharts[0].scales.x.max] : null,
    heights: timeCharts.map((chart) => [chart.scales.y.min, chart.scales.y.max]),
    ticks: timeCharts.map((chart) => chart.scales.y.ticks.map((tick) => tick.label)),
    angleTicks: timeCharts.map((chart) => chart.scales.angle?.ticks.map((tick) => tick.label)),
    gaps: timeCharts.map((chart) => chart.getDatasetMeta(0).data.filter((point) => point.skip).length),
    pointed: timeCharts[0]?.tooltip.dataPoints?.map(({ dataset, parsed }) =>
      [dataset.label, parsed.x, parsed.y]) ?? [],
    machine: [...document.querySelectorAll("#machine select")].map((one) => one.selectedOptions[0].textContent),
    hidden: timeCharts[0]?.isDatasetVisible(0) === false,
    webgl: playback !== null,
    snapshot: playback?.player.snapshot ?? null,
    playing: Boolean(playback?.player.timer),
    field: playback?.view.playback.fields[Number(byId("field").value)]?.name ?? null,
    scale: byId("scale")?.textContent ?? null,
    legend: [...byId("bone-names")?.children ?? []].map((entry) => entry.textContent),
    places: playback ? [...playback.view.spheres.geometry.attributes.position.array] : [],
    tints: playback ? [...playback.view.spheres.geometry.attributes.tint.array] : [],
    skin: playback ? [...playback.view.skin.geometry.attributes.color.array] : [],
    corners: playback?.view.skin.geometry.index.count ?? 0,
    triangles: playback?.view.renderer.info.render.triangles ?? 0,
    points: playback?.view.renderer.info.render.points ?? 0,
  });
}

begin();
