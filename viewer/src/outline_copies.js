// SPDX-License-Identifier: MIT
// The outline of the tile in many copies, as bands of the same width on the screen at any zoom and slant. The thick lines of
// three.js take ten times as long to draw.
import {BufferAttribute, BufferGeometry, Color, DoubleSide, InstancedMesh, ShaderMaterial, Vector2, Vector3} from 'three';

const vertexShader = /* glsl */ `
attribute vec3 along;    // the edge's direction
attribute vec2 corner;   // beyond the edge's end and across, for a band of half-width one
uniform vec2 halfWidth;  // as a share of the viewport's half width and half height

void main() {
  mat4 toScreen = projectionMatrix * modelViewMatrix * instanceMatrix;
  vec4 here = toScreen * vec4(position, 1.0), there = toScreen * vec4(position + 0.001 * along, 1.0);
  vec2 run = normalize((there.xy / there.w - here.xy / here.w) / halfWidth);
  here.xy += here.w * halfWidth * (corner.x * run + corner.y * vec2(-run.y, run.x));
  gl_Position = here;
}`;

const fragmentShader = /* glsl */ `
uniform vec3 colour;

void main() {
  gl_FragColor = vec4(colour, 1.0);
}`;

// A rectangle for every edge, longer by its half-width at both ends, so that no gap is left where edges meet.
function bands(positions, ends) {
  const count = ends.length / 2, places = new Float32Array(12 * count), directions = new Float32Array(12 * count);
  const corners = new Float32Array(8 * count), indices = new Uint32Array(6 * count);
  const [a, b, along] = [0, 1, 2].map(() => new Vector3());
  for (let e = 0; e < count; ++e) {
    a.fromArray(positions, 3 * ends[2 * e]);
    b.fromArray(positions, 3 * ends[2 * e + 1]);
    along.subVectors(b, a).normalize();
    [[a, -1, -1], [a, -1, 1], [b, 1, -1], [b, 1, 1]].forEach(([end, beyond, side], k) => {
      end.toArray(places, 3 * (4 * e + k));
      along.toArray(directions, 3 * (4 * e + k));
      corners.set([beyond, side], 2 * (4 * e + k));
    });
    indices.set([0, 1, 2, 2, 1, 3].map((corner) => 4 * e + corner), 6 * e);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(places, 3));
  geometry.setAttribute('along', new BufferAttribute(directions, 3));
  geometry.setAttribute('corner', new BufferAttribute(corners, 2));
  geometry.setIndex(new BufferAttribute(indices, 1));
  return geometry;
}

/** Edges between positions on the sphere, repeated by every transform, `width` pixels wide on a panel. */
export function outlineCopies(panel, {positions, ends, matrices, width, colour}) {
  const uniforms = {halfWidth: {value: new Vector2()}, colour: {value: new Color(colour)}};
  const material = new ShaderMaterial({vertexShader, fragmentShader, uniforms, side: DoubleSide});
  const mesh = new InstancedMesh(bands(positions, ends), material, matrices.length);
  matrices.forEach((matrix, i) => mesh.setMatrixAt(i, matrix));
  mesh.frustumCulled = false;
  mesh.onBeforeRender = () => {
    uniforms.halfWidth.value.set(width / panel.stage.clientWidth, width / panel.stage.clientHeight);
    material.uniformsNeedUpdate = true;
  };
  return mesh;
}
