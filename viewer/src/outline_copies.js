// SPDX-License-Identifier: MIT
// The outline of the tile in many copies: bands on the sphere that are as wide on the screen at any zoom. The thick lines of
// three.js take ten times as long to draw.
import {BufferAttribute, BufferGeometry, Color, DoubleSide, InstancedMesh, ShaderMaterial, Vector3} from 'three';

const vertexShader = /* glsl */ `
attribute vec3 offset;   // across and beyond the edge, for a band of half-width one
uniform float halfWidth;

void main() {
  gl_Position = projectionMatrix * modelViewMatrix * instanceMatrix * vec4(position + halfWidth * offset, 1.0);
}`;

const fragmentShader = /* glsl */ `
uniform vec3 colour;

void main() {
  gl_FragColor = vec4(colour, 1.0);
}`;

// A rectangle for every edge, longer by its half-width at both ends, so that there is no gap where edges meet.
function bands(positions, ends) {
  const count = ends.length / 2, places = new Float32Array(12 * count), offsets = new Float32Array(12 * count);
  const indices = new Uint32Array(6 * count), [a, b, along, across] = [0, 1, 2, 3].map(() => new Vector3());
  for (let e = 0; e < count; ++e) {
    a.fromArray(positions, 3 * ends[2 * e]);
    b.fromArray(positions, 3 * ends[2 * e + 1]);
    along.subVectors(b, a).normalize();
    across.crossVectors(a, along).normalize();
    [[a, -1, -1], [a, -1, 1], [b, 1, -1], [b, 1, 1]].forEach(([end, beyond, side], k) => {
      end.toArray(places, 3 * (4 * e + k));
      new Vector3().addScaledVector(along, beyond).addScaledVector(across, side).toArray(offsets, 3 * (4 * e + k));
    });
    indices.set([0, 1, 2, 2, 1, 3].map((corner) => 4 * e + corner), 6 * e);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(places, 3));
  geometry.setAttribute('offset', new BufferAttribute(offsets, 3));
  geometry.setIndex(new BufferAttribute(indices, 1));
  return geometry;
}

/** Edges between positions on the sphere, repeated by every transform, `width` pixels wide on a panel. */
export function outlineCopies(panel, {positions, ends, matrices, width, colour}) {
  const uniforms = {halfWidth: {value: 0}, colour: {value: new Color(colour)}};
  const material = new ShaderMaterial({vertexShader, fragmentShader, uniforms, side: DoubleSide});
  const mesh = new InstancedMesh(bands(positions, ends), material, matrices.length);
  matrices.forEach((matrix, i) => mesh.setMatrixAt(i, matrix));
  mesh.frustumCulled = false;
  mesh.onBeforeRender = () => {
    uniforms.halfWidth.value = width / (2 * panel.pixels(1));
    material.uniformsNeedUpdate = true;
  };
  return mesh;
}
