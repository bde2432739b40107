// SPDX-License-Identifier: GPL-3.0-or-later
// Begins everything. window.sinewState tells what is shown, to whoever wants to test the page.
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
  let playback = null;
  if (data.playback)
    try {
      playback = startPlayback(data.playback);
    } catch (error) {
      sayWithout(error.message);
    }
  window.sinewState = () => ({
    charts: charts.length,
    timeRange: timeCharts.length ? [timeCharts[0].scales.x.min, timeCharts[0].scales.x.max] : null,
    heights: timeCharts.map((chart) => [chart.scales.y.min, chart.scales.y.max]),
    webgl: playback !== null,
    snapshot: playback?.player.snapshot ?? null,
    places: playback ? [...playback.view.spheres.geometry.attributes.position.array] : [],
    tints: playback ? [...playback.view.spheres.geometry.attributes.tint.array] : [],
    triangles: playback?.view.renderer.info.render.triangles ?? 0,
    points: playback?.view.renderer.info.render.points ?? 0,
  });
}

begin();
