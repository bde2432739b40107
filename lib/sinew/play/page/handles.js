// SPDX-License-Identifier: GPL-3.0-or-later
// Hands in the 3D view: joints to be dragged, and the skin.
"use strict";

const near = 16; // pixels within which a joint is touched

/** A ball at the tip of each bone, and at the head of each root, drawn over everything. */
function makeHandles(view, parents) {
  const { edge, bones } = view.playback;
  const sizeOf = (bone) => Math.min(edge / 100, 0.2 * new THREE.Vector3().fromArray(bones, 6 * bone)
    .distanceTo(new THREE.Vector3().fromArray(bones, 6 * bone + 3)));
  const handles = parents.flatMap((parent, bone) => parent < 0 ? [[bone, false], [bone, true]] : [[bone, true]]);
  view.handles = handles.map(([bone, isTip]) => {
    const material = new THREE.MeshBasicMaterial({ color: isTip ? 0xffffff : 0xffd24a, transparent: true,
      depthTest: false });
    const size = sizeOf(bone);
    const ball = Object.assign(new THREE.Mesh(new THREE.SphereBufferGeometry(size, 16, 12), material),
      { renderOrder: 5, bone, isTip });
    const rim = new THREE.Mesh(new THREE.SphereBufferGeometry(1.35 * size, 16, 12),
      new THREE.MeshBasicMaterial({ color: 0x22262b, transparent: true, depthTest: false }));
    rim.renderOrder = 4;
    ball.add(rim);
    view.scene.add(ball);
    return ball;
  });
  view.pullArrow = makeForce(true);
  view.pullArrow.visible = false;
  view.scene.add(view.pullArrow);
}

function placeHandles(view, shown) {
  for (const ball of view.handles) {
    ball.position.fromArray(view.playback.bones, 6 * ball.bone + (ball.isTip ? 3 : 0));
    ball.visible = shown;
  }
}

/** The middle of the playback's cube: places of the view are from there. */
const centerOf = ({ low, edge }) => new THREE.Vector3().fromArray(low).addScalar(edge / 2);

function pixelsOf(view, point) {
  const seen = point.clone().project(view.camera);
  const { clientWidth: width, clientHeight: height } = view.stage;
  return [(seen.x + 1) / 2 * width, (1 - seen.y) / 2 * height, seen.z];
}

function rayAt(view, [x, y]) {
  const ray = new THREE.Raycaster();
  ray.setFromCamera({ x: 2 * x / view.stage.clientWidth - 1, y: 1 - 2 * y / view.stage.clientHeight }, view.camera);
  return ray;
}

function handleAt(view, at) {
  const distance = (ball) => { const [x, y] = pixelsOf(view, ball.position); return Math.hypot(x - at[0], y - at[1]); };
  return view.handles.filter((ball) => ball.visible && distance(ball) < near)
    .sort((a, b) => distance(a) - distance(b))[0] ?? null;
}

/** The particle beneath the pointer, by its index on the page, and the place that is touched. */
function fleshAt(view, at) {
  if (view.skin.visible) {
    view.skin.geometry.computeBoundingSphere();
    const [hit] = rayAt(view, at).intersectObject(view.skin);
    if (!hit) return null;
    const { first, all } = view.beside ?? (view.beside = besideSkin(view.atRest, view.counts.points));
    const corner = [hit.face.a, hit.face.b, hit.face.c].find((p) => first[p] < first[p + 1]);
    return corner === undefined ? null : { particle: all[first[corner]], place: hit.point };
  }
  if (!view.spheres.visible) return null;
  let best = null;
  for (let i = 0; i < view.counts.particles; ++i) {
    const place = new THREE.Vector3().fromArray(view.playback.particles, 3 * i);
    const [x, y, depth] = pixelsOf(view, place);
    if (Math.hypot(x - at[0], y - at[1]) < near / 2 && (!best || depth < best.depth)) best = { particle: i, place, depth };
  }
  return best;
}

/** The place beneath the pointer, as far away as `place`. */
function placeAt(view, at, place) {
  const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(
    view.camera.getWorldDirection(new THREE.Vector3()), place);
  return rayAt(view, at).ray.intersectPlane(plane, new THREE.Vector3());
}

/** Drags begin on a joint or the skin; elsewhere, and with Alt, the pointer turns the view. */
function connectHands(view) {
  const canvas = view.stage.querySelector("canvas");
  const at = (event) => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
  let drag = null, due = null;
  const scenePlace = (place) => place.clone().add(centerOf(view.playback)).toArray();
  const send = () => {
    if (drag && due) drag.to(due);
    due = null;
  };
  const begin = (event) => {
    if (event.button !== 0 || event.altKey || drag) return;
    const ball = handleAt(view, at(event));
    const flesh = ball ? null : fleshAt(view, at(event));
    if (!ball && !flesh) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    view.controls.enabled = false;
    try { canvas.setPointerCapture(event.pointerId); } catch { /* a pointer of a script */ }
    drag = ball ? dragOfBone(view, ball, event.shiftKey, scenePlace) : dragOfFlesh(view, flesh, scenePlace);
  };
  const end = () => {
    if (!drag) return;
    send();
    drag.end();
    drag = null;
    view.controls.enabled = true;
  };
  canvas.addEventListener("pointerdown", begin, { capture: true });
  canvas.addEventListener("mousedown", (event) => { if (drag) event.stopImmediatePropagation(); }, { capture: true });
  canvas.addEventListener("pointermove", (event) => {
    if (!drag) return canvas.style.setProperty("cursor", handleAt(view, at(event)) ? "grab" : "default");
    if (!due) requestAnimationFrame(send);
    due = placeAt(view, at(event), drag.place);
  });
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
}

function dragOfBone(view, ball, chain, scenePlace) {
  const { bone, isTip } = ball;
  const what = !isTip ? "move" : chain ? "reach" : "aim";
  tell({ do: "grab", bone });
  return { place: ball.position.clone(), to: (place) => tell({ do: what, bone, to: scenePlace(place) }),
    end: () => tell({ do: "release" }) };
}

function dragOfFlesh(view, { particle, place }, scenePlace) {
  const id = view.playback.ids[particle];
  view.pulled = { particle, to: place };
  return { place: place.clone(), end: () => { view.pulled = null; tell({ do: "pull", to: null }); },
    to: (to) => {
      view.pulled.to = to;
      tell({ do: "pull", particle: id, to: scenePlace(to), stiffness: Number(byId("stiffness").value) });
    } };
}

/** An arrow from the pulled flesh to the free end of its spring. */
function placePull(view) {
  const { pulled, pullArrow, playback } = view;
  pullArrow.visible = Boolean(pulled) && playback.particles.length > 0;
  if (!pullArrow.visible) return;
  const from = pulled.to.clone(), skin = playback.surface;
  const { first, all } = view.beside ?? { first: [], all: [] };
  const point = first.findIndex((begin, p) => p < view.counts.points && all[begin] === pulled.particle);
  if (point >= 0) from.fromArray(skin, 3 * point);
  placeBetween([pullArrow], Float32Array.from([...from.toArray(), ...pulled.to.toArray()]), 0, 0.1 * playback.edge);
}
