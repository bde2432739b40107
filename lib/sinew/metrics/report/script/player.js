// SPDX-License-Identifier: GPL-3.0-or-later
// The controls beneath the 3D view: time, colour, parts, and the worst frames.
"use strict";

const byId = (id) => document.getElementById(id);

function fillFields(film) {
  const options = film.fields.map((field, i) =>
    element("option", { value: i, textContent: field.name }));
  byId("field").append(element("option", { value: -1, textContent: "bone it follows" }), ...options);
}

const mostNames = 12; // bones named beside the view; more would bury it

/** Which colour is which bone. */
function fillBoneNames(film) {
  const names = film.boneNames.slice(0, mostNames).map((name, b) => {
    const colour = boneColours[b % boneColours.length].join(" ");
    const dot = element("i");
    dot.style.background = `rgb(${colour})`;
    return element("span", {}, [dot, name]);
  });
  const more = film.boneNames.length - names.length;
  if (more > 0) names.push(element("span", { textContent: `and ${more} more` }));
  byId("bone-names").append(...names);
}

function showScale(film, field) {
  byId("bone-names").hidden = Boolean(field);
  const [low, bar, high] = byId("scale").children;
  byId("scale").hidden = !field;
  if (!field) return;
  const stops = viridis.map((colour) => `rgb(${colour.join(" ")})`).join(", ");
  bar.style.background = `linear-gradient(90deg, ${stops})`;
  low.textContent = readable(field.low);
  high.textContent = `${readable(field.high)} ${field.unit}`.trim();
  byId("scale").title = field.help;
}

const nearestShot = (film, distance) => film.shots.reduce((best, shot, i) =>
  distance(shot) < distance(film.shots[best]) ? i : best, 0);

function showWorst(film, go) {
  for (const worst of data.worst) {
    const shot = nearestShot(film, (one) => Math.abs(one.frame - worst.frame));
    const button = element("button", { type: "button", textContent: worst.metric.replace(/_/g, " "),
      title: `frame ${worst.frame}, ${readable(worst.time)} s` });
    button.addEventListener("click", () => go(shot));
    byId("worst").append(button);
  }
  byId("worst").hidden = data.worst.length === 0;
}

/** The state of the view and the ways to change it. */
function makePlayer(view) {
  const { film } = view;
  const player = { shot: 0, timer: null };
  const field = () => film.fields[Number(byId("field").value)] ?? null;
  player.show = () => {
    const { frame, time } = film.shots[player.shot];
    byId("time").value = player.shot;
    byId("clock").textContent = `${time.toFixed(3)} s · frame ${frame}`;
    view.spheres.visible = byId("show-particles").checked;
    view.skin.visible = byId("show-surface").checked;
    for (const bone of view.bones) bone.visible = byId("show-bones").checked;
    showScale(film, field());
    showShot(view, { shot: player.shot, field: field(), cut: byId("cut").checked });
    markTime(time);
  };
  player.go = (shot) => {
    player.shot = Math.min(Math.max(shot, 0), film.shots.length - 1);
    player.show();
  };
  return player;
}

/** Milliseconds a shot stays, so that the film takes its own time, yet at most ten seconds. */
function pace(film) {
  const span = film.shots[film.shots.length - 1].time - film.shots[0].time;
  return 1000 * Math.min(span, 10) / Math.max(film.shots.length - 1, 1);
}

function play(player, film) {
  const playing = player.timer !== null;
  if (playing) clearInterval(player.timer);
  player.timer = playing ? null : setInterval(
    () => player.go((player.shot + 1) % film.shots.length), Math.max(pace(film), 16));
  byId("play").textContent = playing ? "▶" : "❚❚";
  byId("play").ariaLabel = playing ? "Play" : "Stop";
}

function connect(player, view) {
  const { film } = view;
  byId("time").max = film.shots.length - 1;
  byId("time").addEventListener("input", () => player.go(Number(byId("time").value)));
  byId("play").addEventListener("click", () => play(player, film));
  byId("reset").addEventListener("click", () => aim(view));
  for (const id of ["field", "show-particles", "show-surface", "show-bones", "cut"])
    byId(id).addEventListener("change", player.show);
  marked.go = (time) => player.go(nearestShot(film, (shot) => Math.abs(shot.time - time)));
  whenDarkChanges(player.show);
  showWorst(film, player.go);
}

function startFilm(packed) {
  const film = unpackedFilm(packed);
  const view = makeView(film, byId("stage"));
  const player = makePlayer(view);
  fillFields(film);
  fillBoneNames(film);
  connect(player, view);
  player.show();
  return { view, player };
}
