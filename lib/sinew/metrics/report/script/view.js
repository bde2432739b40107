// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D view: particles, skin and bones of one frame, to be turned and zoomed.
"use strict";

const away = 1e9; // position of hidden particles, m

/** Throws where the browser has no WebGL. */
function makeView(playback, stage, { antialias = true, pixelRatio } = {}) {
  const canvas = stage.querySelector("canvas");
  const context = canvas.getContext("webgl2", { antialias }) || canvas.getContext("webgl", { antialias });
  if (!context) throw new Error("no WebGL");
  const renderer = new THREE.WebGLRenderer({ canvas, context });
  const counts = { particles: playback.ids.length, points: playback.surface.length / 3 / playback.snapshots.length,
    bones: playback.boneNames.length };
  const view = { playback, stage, renderer, counts, pixelRatio, scene: new THREE.Scene(),
    camera: new THREE.PerspectiveCamera(30, 1, playback.edge / 100, playback.edge * 30) };
  view.controls = new THREE.OrbitControls(view.camera, canvas);
  addParts(view);
  aim(view);
  view.draw = drawer(view);
  view.controls.addEventListener("change", view.draw);
  new ResizeObserver(() => resize(view)).observe(stage);
  resize(view);
  return view;
}

/** A function that draws once at the next repaint, however often it is called before. */
function drawer(view) {
  let due = false;
  const draw = () => {
    due = false;
    view.renderer.setClearColor(colorOf("--stage"));
    view.renderer.render(view.scene, view.camera);
  };
  addEventListener("beforeprint", draw);
  return () => {
    if (!due) requestAnimationFrame(draw);
    due = true;
  };
}

function addParts(view) {
  const { playback, scene, counts } = view;
  view.spheres = makeSpheres(playback.balls);
  view.skin = makeSkin(playback, counts.points);
  view.skin.visible = false;
  view.obstacles = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshLambertMaterial({ color: 0x80868e,
    side: THREE.DoubleSide, transparent: true, opacity: 0.4, depthWrite: false }));
  view.obstacles.frustumCulled = false;
  view.bones = playback.boneColor.map(makeBone);
  view.forces = playback.isLoad.map(makeForce);
  const sun = new THREE.DirectionalLight(0xffffff, 0.75);
  sun.position.set(0.35, 0.55, 0.8);
  view.camera.add(sun);
  scene.add(view.camera, new THREE.AmbientLight(0xffffff, 0.5), view.skin, view.spheres,
    view.obstacles, ...view.bones, ...view.forces);
}

function makeSkin(playback, points) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * points), 3));
  geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * points), 3));
  geometry.setIndex(new THREE.BufferAttribute(playback.corners, 1));
  const skin = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: THREE.VertexColors,
    side: THREE.DoubleSide }));
  skin.frustumCulled = false;
  return skin;
}

/** The skin opaque, or sheer around the particles; cut open without its part before the plane. */
function dress(view, { cut, sheer }) {
  const { material, geometry } = view.skin;
  if (material.transparent !== sheer) {
    Object.assign(material, { transparent: sheer, opacity: sheer ? 0.45 : 1, depthWrite: !sheer });
    material.needsUpdate = true;
  }
  if (view.isCut === cut) return;
  view.isCut = cut;
  geometry.setIndex(new THREE.BufferAttribute(cut ? cornersBehind(startOf(view), view.counts.points)
    : view.playback.corners, 1));
}

/** The playback from which cuts are made: that of the start, where `view.playback` has one moment alone. */
const startOf = (view) => view.atRest ?? view.playback;

/** The faces of the skin that lie behind the plane of the cut at the start. */
function cornersBehind(playback, points) {
  const before = beforeCut(playback, snapshotOf(playback.surface, points, 0));
  const { corners } = playback, kept = [];
  for (let i = 0; i < corners.length; i += 3)
    if (![0, 1, 2].some((k) => before(corners[i + k]) > 0)) kept.push(...corners.subarray(i, i + 3));
  return new Uint32Array(kept);
}

/** The particles beside each point of the skin at the start, from which it has its colors: an array of
 * their numbers, one after the other, and where those of each point begin. */
function besideSkin(playback, points) {
  const places = snapshotOf(playback.particles, playback.ids.length, 0);
  const skin = snapshotOf(playback.surface, points, 0);
  const size = 2.5 * Math.max(...playback.balls.map(([, radius]) => radius));
  const cells = new Map(), low = -2 * playback.edge;
  const cellOf = (array, i, k) => Math.floor((array[3 * i + k] - low) / size);
  const key = (x, y, z) => (x * 8192 + y) * 8192 + z;
  for (let i = 0; i < playback.ids.length; ++i) {
    const cell = key(...[0, 1, 2].map((k) => cellOf(places, i, k)));
    if (cells.has(cell)) cells.get(cell).push(i); else cells.set(cell, [i]);
  }
  const distance = (p, i) => Math.hypot(...[0, 1, 2].map((k) => skin[3 * p + k] - places[3 * i + k]));
  const first = [0], all = [];
  for (let p = 0; p < points; ++p) {
    const [x, y, z] = [0, 1, 2].map((k) => cellOf(skin, p, k)), near = [];
    for (let a = -1; a < 2; ++a) for (let b = -1; b < 2; ++b) for (let c = -1; c < 2; ++c)
      near.push(...cells.get(key(x + a, y + b, z + c)) ?? []);
    const sorted = near.map((i) => [distance(p, i), i]).sort(([a], [b]) => a - b);
    all.push(...sorted.slice(0, 4).map(([, i]) => i));
    first.push(all.length);
  }
  return { first, all };
}

/** A long octahedron of length 1 along y, drawn over everything so that it is visible inside. */
function makeBone(number) {
  const geometry = new THREE.CylinderBufferGeometry(0, 0.07, 0.85, 4).translate(0, 0.575, 0);
  const foot = new THREE.CylinderBufferGeometry(0.07, 0, 0.15, 4).translate(0, 0.075, 0);
  const color = new THREE.Color(palette[number % palette.length]);
  const material = new THREE.MeshLambertMaterial({ color: color, transparent: true, opacity: 0.85,
    depthTest: false, flatShading: true });
  const bone = new THREE.Group();
  for (const part of [geometry, foot]) bone.add(Object.assign(new THREE.Mesh(part, material),
    { renderOrder: 1 }));
  return bone;
}

/** An arrow of length 1 along y with a white rim, drawn over everything. */
function makeForce(isLoad) {
  const shaft = new THREE.CylinderBufferGeometry(0.025, 0.025, 0.75, 12).translate(0, 0.375, 0);
  const tip = new THREE.CylinderBufferGeometry(0, 0.08, 0.25, 24).translate(0, 0.875, 0);
  const [red, green, blue] = (isLoad ? loadColor : heldColor).map((part) => part / 255);
  const drawn = { transparent: true, depthTest: false };
  const material = new THREE.MeshLambertMaterial({ color: new THREE.Color(red, green, blue), ...drawn });
  const white = new THREE.MeshBasicMaterial({ color: 0xffffff, ...drawn });
  const arrow = new THREE.Group();
  for (const part of [shaft, tip]) {
    const rim = Object.assign(new THREE.Mesh(part, white), { renderOrder: 2 });
    rim.scale.set(1.4, 1.03, 1.4);
    arrow.add(rim, Object.assign(new THREE.Mesh(part, material), { renderOrder: 3 }));
  }
  return arrow;
}

/** The middle of the body on the ground in each snapshot, if it goes farther than it is large; else none. */
function travelOf(playback) {
  const boxes = playback.snapshots.map((_, i) =>
    new THREE.Box3().setFromArray(snapshotOf(playback.particles, playback.ids.length, i)));
  const middles = boxes.map((box) => box.getCenter(new THREE.Vector3()).setZ(0));
  const size = boxes[0].getSize(new THREE.Vector3()).length();
  return middles.some((middle) => middle.distanceTo(middles[0]) > size) ? middles : [];
}

/** All places of the particles relative to where the camera has followed them. */
function followedBox(playback, travel) {
  if (travel.length === 0) return new THREE.Box3().setFromArray(playback.particles);
  const all = new THREE.Box3();
  travel.forEach((middle, i) => all.union(
    new THREE.Box3().setFromArray(snapshotOf(playback.particles, playback.ids.length, i))
      .translate(new THREE.Vector3().subVectors(travel[0], middle))));
  return all;
}

/** Moves the camera with the body. */
function follow(view, snapshot) {
  if (view.travel.length === 0) return;
  const step = new THREE.Vector3().subVectors(view.travel[snapshot], view.travel[view.followed]);
  view.controls.target.add(step);
  view.camera.position.add(step);
  view.followed = snapshot;
}

/** Where the viewer is: before a figure, slightly to its left, or along the axis of least motion. */
function viewerSide([x, y], size) {
  if (Math.hypot(x, y) > 0.5) return new THREE.Vector3(x - 0.35 * y, y + 0.35 * x, 0.25);
  return size.y <= 1.01 * size.x ? new THREE.Vector3(0.35, -1, 0.25) : new THREE.Vector3(1, -0.35, 0.25);
}

/** Places the camera to see the whole playback, or what is in a box. */
function aim(view, inBox = null) {
  const { playback, camera, controls } = view;
  view.travel = travelOf(playback);
  view.followed = 0;
  const box = inBox ?? followedBox(playback, view.travel);
  const size = box.getSize(new THREE.Vector3());
  const side = viewerSide(playback.front, size);
  box.getCenter(controls.target);
  camera.up.set(0, 0, 1);
  const reach = size.length() / 2 + Math.max(...playback.balls.map(([, radius]) => radius));
  const narrow = Math.min(1, view.stage.clientWidth / view.stage.clientHeight);
  const halfAngle = Math.atan(narrow * Math.tan(camera.fov * Math.PI / 360));
  const distance = reach / Math.sin(halfAngle);
  camera.position.copy(controls.target).addScaledVector(side.normalize(), distance);
  controls.update();
}

function resize(view) {
  const { clientWidth: width, clientHeight: height } = view.stage;
  view.renderer.setPixelRatio(view.pixelRatio ?? Math.min(devicePixelRatio, 2));
  view.renderer.setSize(width, height, false);
  view.spheres.material.uniforms.pixels.value = view.renderer.getDrawingBufferSize(
    new THREE.Vector2()).y;
  view.camera.aspect = width / height;
  view.camera.updateProjectionMatrix();
  view.draw();
}

const snapshotOf = (array, count, snapshot) => array.subarray(3 * count * snapshot, 3 * count * (snapshot + 1));

/** How far each of some places at the start lies before the middle of the body, across its shorter axis, m. */
function beforeCut(playback, places) {
  const box = new THREE.Box3().setFromArray(snapshotOf(playback.particles, playback.ids.length, 0));
  const size = box.getSize(new THREE.Vector3());
  const axis = size.y <= 1.01 * size.x ? 1 : 0; // as layer_of_cut in playback.cpp
  const middle = box.getCenter(new THREE.Vector3()).getComponent(axis);
  const sign = axis === 1 ? -1 : 1;
  return (i) => sign * (places[3 * i + axis] - middle);
}

/** The particles before the cut, and those outside of the layer behind it, which the skin encloses. */
function layersGone(view) {
  if (view.gone) return view.gone;
  const playback = startOf(view), before = [], outside = [];
  const distance = beforeCut(playback, snapshotOf(playback.particles, view.counts.particles, 0));
  let i = 0;
  for (const [count, , layer] of playback.balls)
    for (const end = i + count; i < end; ++i) {
      if (distance(i) > 0) before.push(i);
      if (distance(i) > 0 || distance(i) < -layer) outside.push(i);
    }
  return view.gone = { before, outside };
}

/** Whether a bone's middle at the start lies before the cut. */
function isBoneGone(view, bone) {
  const playback = startOf(view), ends = playback.bones.subarray(6 * bone, 6 * bone + 6);
  return beforeCut(playback, [0, 1, 2].map((k) => (ends[k] + ends[3 + k]) / 2))(0) > 0;
}

function placeParticles(view, snapshot, cut) {
  const geometry = view.spheres.geometry;
  const places = geometry.attributes.position.array;
  places.set(snapshotOf(view.playback.particles, view.counts.particles, snapshot));
  if (cut) {
    const gone = view.skin.visible ? layersGone(view).outside : layersGone(view).before;
    gone.forEach((i) => { places[3 * i] = away; });
  }
  geometry.attributes.position.needsUpdate = true;
}

function placeSkin(view, snapshot) {
  const geometry = view.skin.geometry;
  geometry.attributes.position.array.set(snapshotOf(view.playback.surface, view.counts.points, snapshot));
  geometry.attributes.position.needsUpdate = true;
  geometry.computeVertexNormals();
}

function placeObstacles(view, snapshot) {
  const corners = view.playback.obstacles[snapshot], geometry = view.obstacles.geometry;
  if (geometry.attributes.position?.array === corners) return;
  geometry.setAttribute("position", new THREE.BufferAttribute(corners, 3));
  geometry.deleteAttribute("normal");
  geometry.computeVertexNormals();
}

/** Parts of length 1 along y, each from one point to another; short ones are no thinner than `least`. */
function placeBetween(parts, places, snapshot, least = 0) {
  const ends = snapshotOf(places, 2 * parts.length, snapshot);
  parts.forEach((part, k) => {
    const from = new THREE.Vector3().fromArray(ends, 6 * k);
    const along = new THREE.Vector3().fromArray(ends, 6 * k + 3).sub(from);
    part.position.copy(from);
    const length = Math.max(along.length(), 1e-9), thick = Math.max(length, least);
    part.scale.set(thick, length, thick);
    part.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.normalize());
  });
}

/** field: an item of playback.fields; where it is null, particles have the color of their category. */
function tint(view, snapshot, { field, category }) {
  const tints = view.spheres.geometry.attributes.tint;
  const count = view.counts.particles;
  for (let i = 0; i < count; ++i) {
    const color = field ? view.playback.levelColors[field.levels[snapshot * count + i]]
      : nameColors[category?.color[category.of[i]] % nameColors.length] ?? noColor;
    for (let k = 0; k < 3; ++k) tints.array[3 * i + k] = color[k] / 255;
  }
  if (!field) for (const i of view.playback.held)
    for (let k = 0; k < 3; ++k) tints.array[3 * i + k] = heldColor[k] / 255;
  tints.needsUpdate = true;
  tintSkin(view, snapshot, { field, category });
}

/** The skin in the mean of the values beside each point; names are those of the nearest particle. */
function tintSkin(view, snapshot, { field, category }) {
  const { playback } = view;
  const { first, all } = view.beside ?? (view.beside = besideSkin(playback, view.counts.points));
  const colors = view.skin.geometry.attributes.color;
  for (let p = 0; p < view.counts.points; ++p) {
    let sum = 0, count = 0;
    for (let k = first[p]; field && k < first[p + 1]; ++k) {
      const level = field.levels[snapshot * view.counts.particles + all[k]];
      if (level < 255) sum += level, ++count;
    }
    const nearest = first[p] < first[p + 1] ? all[first[p]] : -1;
    const color = field ? playback.levelColors[count > 0 ? Math.round(sum / count) : 255]
      : nameColors[category?.color[category.of[nearest]] % nameColors.length] ?? noColor;
    for (let k = 0; k < 3; ++k) colors.array[3 * p + k] = color[k] / 255;
  }
  colors.needsUpdate = true;
}

function showSnapshot(view, { snapshot, cut, ...shown }) {
  follow(view, snapshot);
  placeParticles(view, snapshot, cut);
  placeSkin(view, snapshot);
  placeObstacles(view, snapshot);
  placeBetween(view.bones, view.playback.bones, snapshot);
  placeBetween(view.forces, view.playback.forces, snapshot, 0.15 * view.playback.edge);
  tint(view, snapshot, shown);
  view.draw();
}
