// SPDX-License-Identifier: GPL-3.0-or-later
// The controls beneath the 3D view: time, color, parts, and the worst frames.
"use strict";

/** What particles are colored by that has names instead of a scale. */
function categoriesOf({ bone, boneNames, boneColor, material, materialNames, mark, markNames }) {
  return [
    { name: "the step that failed", of: mark, names: markNames, color: markNames.map((_, i) => i) },
    { name: "bone it follows", of: bone, names: boneNames, color: boneColor },
    { name: "material", of: material, names: materialNames, color: materialNames.map((_, i) => i) },
  ].filter(({ names }) => names.length > 0);
}

function fillFields(playback, categories) {
  const option = (value, { name }) => element("option", { value, textContent: name });
  byId("field").append(...categories.map((one, i) => option(`-${i + 1}`, one)),
    ...playback.fields.map((one, i) => option(String(i), one)));
}

const mostNames = 12; // bones or materials named beside the view; more would take too much space

/** The legend of colors. Two runs have one entry for bones of the same name. */
function showNames(category) {
  const all = new Map(category.names.map((name, i) => [name, category.color[i]]));
  const names = [...all].slice(0, mostNames).map(([name, color]) => {
    const dot = element("i");
    dot.style.background = palette[color % palette.length];
    return element("span", {}, [dot, name]);
  });
  const more = all.size - names.length;
  if (more > 0) names.push(element("span", { textContent: `and ${more} more` }));
  byId("bone-names").replaceChildren(...names);
}

/** The color scale with the values at its ends, and which percentiles these are. */
function showScale({ field, category }, { percentiles, colors }) {
  byId("bone-names").hidden = !category;
  if (category) showNames(category);
  const [low, bar, high, ends] = byId("scale").children;
  byId("scale").hidden = !field;
  if (!field) return;
  const stops = colors.map((color) => `rgb(${color.join(" ")})`).join(", ");
  bar.style.background = `linear-gradient(90deg, ${stops})`;
  const [prefix, size] = prefixOf(Math.max(Math.abs(field.low), Math.abs(field.high)), field.unit);
  low.textContent = readable(field.low / size);
  high.textContent = `${readable(field.high / size)} ${prefix}${field.unit}`.trim();
  const [first, last] = percentiles.map(readable);
  ends.textContent = `(${first}th to ${last}th percentile)`;
  byId("scale").title = field.help;
}

const nearestSnapshot = (playback, distance) => playback.snapshots.reduce((best, snapshot, i) =>
  distance(snapshot) < distance(playback.snapshots[best]) ? i : best, 0);

function showWorst(playback, go) {
  for (const worst of data.worst) {
    const snapshot = nearestSnapshot(playback, (one) => Math.abs(one.frame - worst.frame));
    const button = element("button", { type: "button", textContent: worst.metric.replace(/_/g, " "),
      title: `frame ${worst.frame}, ${readable(worst.time)} s` });
    button.addEventListener("click", () => go(snapshot));
    byId("worst").append(button);
  }
  byId("worst").hidden = data.worst.length === 0;
}

/** The state of the view and the functions that change it. */
function makePlayer(view) {
  const { playback } = view;
  const player = { snapshot: 0, timer: null };
  const categories = categoriesOf(playback);
  fillFields(playback, categories);
  const colored = () => {
    const number = Number(byId("field").value);
    return { field: playback.fields[number] ?? null, category: categories[-1 - number] ?? null };
  };
  player.show = () => {
    const { frame, time } = playback.snapshots[player.snapshot];
    byId("time").value = player.snapshot;
    byId("clock").textContent = `${time.toFixed(3)} s · frame ${frame}`;
    const cut = byId("cut").checked;
    view.spheres.visible = byId("show-particles").checked || cut;
    view.skin.visible = byId("show-surface").checked;
    byId("has-held").hidden = playback.held.length === 0 || !view.spheres.visible || colored().field !== null;
    dress(view, { cut, sheer: byId("show-particles").checked && !cut });
    view.obstacles.visible = byId("show-obstacles").checked;
    view.bones.forEach((bone, k) => { bone.visible = byId("show-bones").checked && !(cut && isBoneGone(view, k)); });
    for (const force of view.forces) force.visible = byId("show-forces").checked;
    showScale(colored(), playback);
    showSnapshot(view, { snapshot: player.snapshot, cut, ...colored() });
    markTime(time);
  };
  player.go = (snapshot) => {
    player.snapshot = Math.min(Math.max(snapshot, 0), playback.snapshots.length - 1);
    player.show();
  };
  return player;
}

/** The snapshot with the largest strain, or with the widest turn of bones. */
function mostDeformed(playback) {
  const worst = data.worst.find((one) => one.metric === "strain_99");
  return worst ? nearestSnapshot(playback, (one) => Math.abs(one.frame - worst.frame)) : 0;
}

/** What is seen first: the skin in the colors of the largest strain, and the motion playing unless the
 * reader wants none. */
function begin3D(player, playback) {
  const strain = playback.fields.findIndex(({ name }) => name === "strain");
  if (strain >= 0) byId("field").value = String(strain);
  byId("show-surface").checked = playback.corners.length > 0;
  byId("show-particles").checked = playback.corners.length === 0;
  player.go(mostDeformed(playback));
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches || playback.snapshots.length < 2;
  if (!still) play(player, playback);
}

/** Milliseconds per frame, so that the playback runs in real time, but at most ten seconds. */
function pace(playback) {
  const span = playback.snapshots[playback.snapshots.length - 1].time - playback.snapshots[0].time;
  return 1000 * Math.min(span, 10) / Math.max(playback.snapshots.length - 1, 1);
}

function play(player, playback) {
  const playing = player.timer !== null;
  if (playing) clearInterval(player.timer);
  player.timer = playing ? null : setInterval(
    () => player.go((player.snapshot + 1) % playback.snapshots.length), Math.max(pace(playback), 16));
  byId("play").textContent = playing ? "▶" : "❚❚";
  byId("play").ariaLabel = playing ? "Play" : "Stop";
}

/** Shows what a reader asks for, and stops there. */
function seek(player, playback, snapshot) {
  if (player.timer !== null) play(player, playback);
  player.go(snapshot);
}

function connect(player, view) {
  const { playback } = view;
  const goTo = (snapshot) => seek(player, playback, snapshot);
  byId("has-bones").hidden = playback.boneNames.length === 0;
  for (const part of ["has-forces", "force-names"]) byId(part).hidden = playback.isLoad.length === 0;
  byId("has-obstacles").hidden = playback.obstacles.every((corners) => corners.length === 0);
  byId("time").max = playback.snapshots.length - 1;
  byId("time").addEventListener("input", () => goTo(Number(byId("time").value)));
  byId("play").addEventListener("click", () => play(player, playback));
  byId("reset").addEventListener("click", () => aim(view));
  for (const id of ["field", "show-particles", "show-surface", "show-bones", "show-forces", "show-obstacles", "cut"])
    byId(id).addEventListener("change", player.show);
  marked.go = (time) => goTo(nearestSnapshot(playback, (snapshot) => Math.abs(snapshot.time - time)));
  showWorst(playback, goTo);
}

function startPlayback(packed) {
  const playback = unpackedPlayback(packed);
  const view = makeView(playback, byId("stage"));
  const player = makePlayer(view);
  connect(player, view);
  begin3D(player, playback);
  return { view, player };
}
