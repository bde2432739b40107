// SPDX-License-Identifier: GPL-3.0-or-later
// The page's data, and its numbers unpacked from base64.
"use strict";

const data = JSON.parse(document.getElementById("data").textContent);

const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

/** Film arrays as typed arrays; places in metres from the middle of the film's cube. */
function unpackedFilm(film) {
  const places = (text) => {
    const whole = new Uint16Array(bytesOf(text).buffer);
    return Float32Array.from(whole, (q) => (q / 65535 - 0.5) * film.edge);
  };
  return {
    ...film,
    particles: places(film.particles),
    surface: places(film.surface),
    bones: places(film.bones),
    bone: new Int16Array(bytesOf(film.bone).buffer),
    ids: new Uint32Array(bytesOf(film.ids).buffer),
    corners: new Uint32Array(bytesOf(film.corners).buffer),
    fields: film.fields.map((field) => ({ ...field, levels: bytesOf(field.levels) })),
  };
}

/** Four significant digits, for people. */
function readable(value) {
  if (value === null || Number.isNaN(value)) return "–";
  return String(Number(Number(value).toPrecision(4))).replace("-", "−");
}

const colourOf = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

const whenDarkChanges = (job) =>
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", job);

function element(tag, properties = {}, children = []) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}
