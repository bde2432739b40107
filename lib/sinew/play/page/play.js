// SPDX-License-Identifier: GPL-3.0-or-later
// The page of a session. window.sinew drives it from scripts, with and without WebGL.
"use strict";

const live = { view: null, more: null, names: [], categories: [] };

/** Places of a frame, from the middle of the playback's cube, m. */
function places(whole, { low, edge }, playback) {
  const from = low.map((l, k) => l - playback.low[k] - playback.edge / 2), scale = edge / 65535;
  const out = new Float32Array(whole.length);
  for (let i = 0; i < whole.length; ++i) out[i] = from[i % 3] + scale * whole[i];
  return out;
}

/** The body as it is, in the middle. */
function wholeView(view) {
  const { surface, particles, bones } = view.playback;
  const box = new THREE.Box3().setFromArray(view.skin.visible && surface.length ? surface : particles);
  aim(view, box.union(new THREE.Box3().setFromArray(bones)));
}

function takeFrame({ header, bones, skin, particles, obstacles, levels }) {
  showFigures(header);
  const { view } = live;
  if (!view) return;
  const { playback } = view;
  if (view.slow && Boolean(view.pixelRatio) !== header.playing) {
    view.pixelRatio = header.playing ? 2 / 3 : null; // sharp where nothing moves
    resize(view);
  }
  playback.bones = places(bones, header, playback);
  if (skin.length) playback.surface = places(skin, header, playback);
  if (particles.length) playback.particles = places(particles, header, playback);
  if (obstacles.length) {
    playback.obstacles[0] = places(obstacles, header, playback);
    byId("has-obstacles").hidden = false;
  }
  const field = playback.fields.find(({ name }) => name === header.field?.name);
  if (field) Object.assign(field, { low: header.field.low, high: header.field.high, levels });
  if (!view.isAimed) wholeView(view);
  view.isAimed = true;
  draw();
}

const colored = () => {
  const number = Number(byId("field").value);
  return { field: live.view.playback.fields[number] ?? null, category: live.categories[-1 - number] ?? null };
};

function draw() {
  const { view } = live;
  const cut = byId("cut").checked, particles = byId("show-particles").checked;
  view.spheres.visible = particles || cut;
  view.skin.visible = byId("show-surface").checked;
  dress(view, { cut, sheer: particles && !cut });
  view.obstacles.visible = byId("show-obstacles").checked;
  const shown = byId("show-bones").checked;
  view.bones.forEach((bone, k) => { bone.visible = shown && !(cut && isBoneGone(view, k)); });
  showScale(colored(), view.playback);
  showSnapshot(view, { snapshot: 0, cut, ...colored() });
  placeHandles(view, shown);
  placePull(view);
}

/** Tells the session what is shown, so that it sends that alone. */
function look() {
  const { field } = live.view ? colored() : { field: null };
  const cut = byId("cut").checked;
  tell({ do: "show", particles: Boolean(live.view) && (byId("show-particles").checked || cut),
    skin: Boolean(live.view) && byId("show-surface").checked, field: field?.name ?? "",
    holds_range: byId("hold").checked });
}

function showFigures(header) {
  const { time, earliest, latest, playing } = header;
  Object.assign(byId("time"), { min: earliest, max: Math.max(latest, time), step: 0.001 });
  if (document.activeElement !== byId("time") || playing) byId("time").value = time;
  byId("clock").textContent = `${time.toFixed(2)} s`;
  byId("play").textContent = playing ? "❚❚" : "▶";
  byId("play").ariaLabel = playing ? "Pause" : "Play";
  const rows = [["real time", `${readable(Number(header.real_time.toFixed(2)))} ×`, playing && header.real_time < 0.95 * Number(byId("pace").value)],
    ["smallest J", readable(header.J_min), header.J_min <= 0],
    ["inverted", `${readable(100 * header.inverted)} %`, header.inverted > 0],
    ["kinetic energy", quantityText(header.kinetic < 1e-12 ? 0 : header.kinetic, "J")]];
  if (header.reaction)
    rows.push(["force on this bone", quantityText(header.reaction.force, "N")],
      ["moment on this bone", quantityText(header.reaction.moment, "N m")]);
  if (header.pull) rows.push(["pull", quantityText(Math.hypot(...header.pull), "N")]);
  byId("figures").replaceChildren(...rows.flatMap(([name, value, poor]) =>
    [element("dt", { textContent: name }), element("dd", { textContent: value, className: poor ? "poor" : "" })]));
}

function takeScene(scene, more) {
  live.more = more;
  live.names = scene.boneNames;
  byId("what").textContent = `${more.particles.toLocaleString("en")} particles, ${scene.boneNames.length} bones, steps of ` +
    quantityText(more.step, "s");
  fillKnobs(more);
  const unpacked = unpackedPlayback(scene);
  unpacked.fields = more.fields.map((field) => ({ ...field, help: field.label, low: 0, high: 1,
    levels: new Uint8Array(unpacked.ids.length).fill(255) }));
  try {
    showView(unpacked, more);
  } catch (error) {
    sayWithout(error.message);
  }
  look();
}

/** Without a graphics card, smooth edges and frames that nobody needs cost the steps their time. */
function drawsInSoftware() {
  const gl = element("canvas").getContext("webgl"), names = gl?.getExtension("WEBGL_debug_renderer_info");
  return Boolean(names) && /swiftshader|llvmpipe|software/i.test(gl.getParameter(names.UNMASKED_RENDERER_WEBGL));
}

function showView(playback, more) {
  const old = byId("stage").querySelector("canvas"), canvas = element("canvas");
  old.replaceWith(canvas); // of a body before it
  const slow = drawsInSoftware();
  const view = makeView(playback, byId("stage"), slow ? { antialias: false, pixelRatio: 2 / 3 } : {});
  link.between = slow ? 45 : 0;
  view.slow = slow;
  const kept = live.view && byId("field").value;
  live.view = view;
  view.atRest = { ...playback };
  view.beside = besideSkin(view.atRest, view.counts.points);
  live.categories = categoriesOf(playback);
  byId("field").replaceChildren();
  fillFields({ fields: playback.fields.map(({ label }) => ({ name: label })) }, live.categories);
  byId("field").value = kept || "0";
  byId("has-held").hidden = true;
  byId("has-obstacles").hidden = playback.obstacles.every((corners) => corners.length === 0);
  if (playback.corners.length === 0) byId("show-particles").checked = true;
  makeHandles(view, more.parents);
  connectHands(view);
}

function number(id, value, more = {}) {
  return element("input", { type: "number", id, value, step: "any", ...more });
}

function fillKnobs(more) {
  const gravity = element("div", { className: "three" },
    ["x", "y", "z"].map((axis, k) => number(`gravity-${axis}`, more.gravity[k], { ariaLabel: `gravity along ${axis}` })));
  const factors = more.knobs.flatMap(({ name, max, value }) => {
    const slider = element("input", { type: "range", min: 0, max, step: 0.01, value, ariaLabel: name });
    const shown = element("span", { textContent: slider.value });
    slider.addEventListener("input", () => { shown.textContent = slider.value; set(name, Number(slider.value)); });
    return [element("label", { textContent: name }), slider, shown];
  });
  const stiffness = element("input", { type: "range", id: "stiffness", min: more.max_stiffness / 100,
    max: more.max_stiffness, step: "any", value: more.stiffness, ariaLabel: "stiffness of pulls" });
  const shown = element("span", { textContent: quantityText(more.stiffness, "N/m") });
  stiffness.addEventListener("input", () => { shown.textContent = quantityText(Number(stiffness.value), "N/m"); });
  byId("knob-list").replaceChildren(element("label", { textContent: "gravity, m/s²" }), gravity,
    element("label", { textContent: "pull" }), stiffness, shown, ...factors);
  gravity.addEventListener("change", () => set("solver.gravity",
    ["x", "y", "z"].map((axis) => Number(byId(`gravity-${axis}`).value))));
  const settings = more.settings.flatMap(({ key, label, unit, value }) => [element("label", { textContent: label }),
    Object.assign(number(`set-${key}`, value), { key, was: String(value) }), element("span", { textContent: unit })]);
  byId("settings").replaceChildren(...settings);
}

function say(text, more = false) {
  byId("says").hidden = !text;
  byId("says").firstElementChild.textContent = text;
  byId("take").hidden = !more;
}

const quietly = (promise) => promise.catch(({ message }) => say(message));
const set = (key, value) => quietly(ask({ do: "set", key, value }));

function apply() {
  const changed = [...byId("settings").querySelectorAll("input")].filter(({ value, was }) => value !== was && value !== "");
  if (changed.length === 0) return;
  say("");
  quietly(ask({ do: "set", settings: Object.fromEntries(changed.map(({ key, value }) => [key, value])) }));
}

async function save(name) {
  const saved = await ask({ do: "save", name });
  byId("saved").textContent = `Saved as ${saved.path}: sinew run makes the same steps.`;
  return saved.path;
}

function connectControls() {
  byId("play").addEventListener("click", () => tell({ do: link.header?.playing ? "pause" : "play" }));
  byId("time").addEventListener("input", () => tell({ do: "seek", time: Number(byId("time").value) }));
  byId("step").addEventListener("click", () => tell({ do: "step" }));
  byId("again").addEventListener("click", () => tell({ do: "reset" }));
  byId("undo").addEventListener("click", () => tell({ do: "undo" }));
  byId("pace").addEventListener("change", () => tell({ do: "pace", value: Number(byId("pace").value) }));
  byId("apply").addEventListener("click", apply);
  byId("save").addEventListener("click", () => quietly(save(byId("name").value)));
  byId("take").addEventListener("click", () => { say(""); connect(true); });
  byId("reset").addEventListener("click", () => live.view && wholeView(live.view));
  for (const id of ["field", "show-particles", "show-surface", "show-bones", "show-obstacles", "cut", "hold"])
    byId(id).addEventListener("change", () => { look(); if (live.view) draw(); });
  addEventListener("keydown", (event) => {
    if ((event.ctrlKey || event.metaKey) && event.key === "z" && event.target.tagName !== "INPUT") tell({ do: "undo" });
  });
}

function sayWithout(reason) {
  const message = byId("stage").querySelector(".message");
  message.textContent = `The 3D view needs WebGL, which this browser does not offer (${reason}).`;
  message.hidden = false;
}

window.sinew = {
  ready: link.ready,
  bones: () => [...live.names],
  rotate: (bone, axis, degrees) => { tell({ do: "play" }); return ask({ do: "turn", bone, axis, degrees }); },
  pull: (particle, to) => ask({ do: "pull", particle, to, relative: true }),
  set: (key, value) => ask({ do: "set", key, value }),
  state: () => link.header && { time: link.header.time, hash: link.header.hash, real_time: link.header.real_time },
  rewind: (seconds) => ask({ do: "rewind", seconds }),
  save,
};
link.on = { frame: takeFrame, scene: takeScene, say, closed: say };
document.documentElement.classList.add("scripted");
connectControls();
connect();
