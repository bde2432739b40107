// SPDX-License-Identifier: GPL-3.0-or-later
// The page's data, with its numbers decoded from base64.
"use strict";

const byId = (id) => document.getElementById(id);

const data = JSON.parse(byId("data").textContent);

const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

/** Each text decoded; null stands for the one before. */
function repeated(texts, decode) {
  let last = null;
  return texts.map((text) => (text === null ? last : last = decode(text)));
}

/** Playback arrays as typed arrays; positions in meters from the center of the playback's cube. */
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
    forces: places(playback.forces),
    bone: new Int16Array(bytesOf(playback.bone).buffer),
    material: new Int16Array(bytesOf(playback.material).buffer),
    mark: new Int16Array(bytesOf(playback.mark).buffer),
    ids: new Uint32Array(bytesOf(playback.ids).buffer),
    corners: new Uint32Array(bytesOf(playback.corners).buffer),
    held: new Uint32Array(bytesOf(playback.held).buffer),
    obstacles: repeated(playback.obstacles, places),
    levelColors: levelColorsOf(playback.colors),
    fields: playback.fields.map((field) => ({ ...field, levels: bytesOf(field.levels) })),
  };
}

/** Four significant digits, for display. */
function readable(value) {
  if (value === null || Number.isNaN(value)) return "–";
  const number = Number(value.toPrecision(4)), size = Math.abs(number);
  const plain = number === 0 || (size >= 1e-4 && size < 1e6);
  return (plain ? String(number) : number.toExponential()).replaceAll("-", "−").replace("+", "");
}

/** The prefix of the SI and the factor with which a number of that size is written in few digits. */
function prefixOf(value, unit) {
  const size = Math.abs(value) * 1.0005; // 999.7 is 1.00 of the next
  if (value === null || !Number.isFinite(size) || !["Pa", "N", "J", "W", "m", "s", "m/s"].includes(unit) || size === 0 || (size >= 0.01 && size < 1000)) return ["", 1];
  const power = Math.min(4, Math.max(-4, Math.floor(Math.log10(size) / 3)));
  return [power < 0 ? "mµnp"[-power - 1] : ["", "k", "M", "G", "T"][power], 1000 ** power];
}

/** "2.37 kPa" */
function quantityText(value, unit) {
  const [prefix, size] = prefixOf(value, unit);
  return value === null ? readable(value) : `${readable(value / size)} ${prefix}${unit}`.trim();
}

// Okabe and Ito's colors, which color-blind readers can distinguish; the pale ones last.
const palette = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#4d4d4d", "#e69f00", "#56b4e9", "#b8ad00"];

const colorOf = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function element(tag, properties = {}, children = []) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}
