// SPDX-License-Identifier: GPL-3.0-or-later
// Particles as spheres of their true size: squares on which the shader computes spheres with shading
// and depth (impostors, as in Gumhold 2003).
"use strict";

const sphereVertex = `
  attribute vec3 tint;
  attribute float radius;
  uniform float pixels;
  varying vec3 color, center;
  varying float size;
  void main() {
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    color = tint;
    center = seen.xyz;
    size = radius;
    gl_Position = projectionMatrix * seen;
    gl_PointSize = max(1.5, radius * projectionMatrix[1][1] * pixels / -seen.z);
  }`;

const sphereFragment = `
  uniform mat4 projectionMatrix;
  varying vec3 color, center;
  varying float size;
  void main() {
    vec2 at = vec2(2.0, -2.0) * gl_PointCoord + vec2(-1.0, 1.0);
    float outside = dot(at, at);
    if (outside > 1.0) discard;
    vec3 normal = vec3(at, sqrt(1.0 - outside));
    float light = 0.5 + 0.55 * max(0.0, dot(normal, normalize(vec3(0.35, 0.55, 0.8))));
    gl_FragColor = vec4(color * light * (0.75 + 0.25 * normal.z), 1.0);
    vec4 clip = projectionMatrix * vec4(center + size * normal, 1.0);
    gl_FragDepthEXT = 0.5 * clip.z / clip.w + 0.5;
  }`;

/** Groups of spheres: number and radius (m), as [count, radius]. */
function makeSpheres(balls) {
  const radii = Float32Array.from(balls.flatMap(([count, radius]) => Array(count).fill(radius)));
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * radii.length), 3));
  geometry.setAttribute("tint", new THREE.BufferAttribute(new Float32Array(3 * radii.length), 3));
  geometry.setAttribute("radius", new THREE.BufferAttribute(radii, 1));
  const material = new THREE.ShaderMaterial({
    vertexShader: sphereVertex,
    fragmentShader: sphereFragment,
    uniforms: { pixels: { value: 1 } },
    extensions: { fragDepth: true },
  });
  const spheres = new THREE.Points(geometry, material);
  spheres.frustumCulled = false; // their box changes from frame to frame
  return spheres;
}

const nameColors = palette.map((color) => [1, 3, 5].map((i) => parseInt(color.slice(i, i + 2), 16)));
const noColor = [150, 150, 150];
const [heldColor, loadColor] = [[30, 34, 40], [134, 72, 178]]; // of what is held, where names are colors, and of forces

/** Colors of levels 0 to 254 of a range, between those of the pictures, 0 to 255 each; 255 is no value. */
function levelColorsOf(colors) {
  return Array.from({ length: 256 }, (_, level) => {
    if (level === 255) return noColor;
    const at = level / 254 * (colors.length - 1), low = Math.min(Math.floor(at), colors.length - 2);
    return colors[low].map((c, k) => c + (at - low) * (colors[low + 1][k] - c));
  });
}
