// SPDX-License-Identifier: GPL-3.0-or-later
// The page's data, and its numbers unpacked from base64.
"use strict";

const data = JSON.parse(document.getElementById("data").textContent);

const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

/** Playback arrays as typed arrays; places in meters from the middle of the playback's cube. */
function unpackedPlayback(playback) {
  const places = (text) => {
    const whole = new Uint16Array(bytesOf(text).buffer);
    return Float32Array.from(whole, (q) => (q / 65535 - 0.5) * playback.edge);
  };
  return {
    ...playback,
    particles: places(playback.particles),
    surface: places(playback.surface),
    bones: places(playback.bones),
    bone: new Int16Array(bytesOf(playback.bone).buffer),
    ids: new Uint32Array(bytesOf(playback.ids).buffer),
    corners: new Uint32Array(bytesOf(playback.corners).buffer),
    fields: playback.fields.map((field) => ({ ...field, levels: bytesOf(field.levels) })),
  };
}

/** Four significant digits, for people. */
function readable(value) {
  if (value === null || Number.isNaN(value)) return "–";
  return String(Number(Number(value).toPrecision(4))).replace("-", "−");
}

const colorOf = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

const whenDarkChanges = (job) =>
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", job);

function element(tag, properties = {}, children = []) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}
