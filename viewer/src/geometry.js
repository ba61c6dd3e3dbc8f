// SPDX-License-Identifier: MIT
// The scene's numbers as what three.js draws: surfaces, edges and thick lines.
import {BufferAttribute, BufferGeometry, Color, Vector3} from 'three';
import {LineMaterial} from 'three/examples/jsm/lines/LineMaterial.js';
import {LineSegments2} from 'three/examples/jsm/lines/LineSegments2.js';
import {LineSegmentsGeometry} from 'three/examples/jsm/lines/LineSegmentsGeometry.js';

/** What all surfaces share, by the names that the shader has for it; 'source' and 'image' are places. */
export function attributes(scene) {
  const shared = {
    source: new BufferAttribute(scene.source, 3),
    image: new BufferAttribute(scene.image, 3),
    sourceNormal: new BufferAttribute(scene.normal, 3, true),
    area: new BufferAttribute(scene.area, 1),
    angle: new BufferAttribute(scene.angle, 1),
  };
  if (scene.colour) shared.sourceColour = new BufferAttribute(scene.colour, 3, true);
  return shared;
}

/** Triangles in the place 'source' or 'image'. */
export function surfaceGeometry(shared, place, indices) {
  const {source, ...others} = shared, result = new BufferGeometry();
  result.setAttribute('position', shared[place]);
  for (const [name, attribute] of Object.entries(others)) result.setAttribute(name, attribute);
  result.setIndex(new BufferAttribute(indices, 1));
  return result;
}

/** The edges of triangles: each once, but for those of the outline, which are drawn anyway. */
export function edgeIndices(triangles) {
  const ends = new Uint32Array(2 * triangles.length);
  let count = 0;
  for (let f = 0; f < triangles.length; f += 3) {
    for (let k = 0; k < 3; ++k) {
      const a = triangles[f + k], b = triangles[f + ((k + 1) % 3)];
      if (a >= b) continue;
      ends[count++] = a;
      ends[count++] = b;
    }
  }
  return ends.slice(0, count);
}

/** Thick lines along pairs of positions, repeated by every transform. */
export function thickLines(positions, ends, {matrices, width, colour}) {
  const points = new Float32Array(3 * ends.length * matrices.length), at = new Vector3();
  matrices.forEach((matrix, g) => {
    ends.forEach((vertex, i) => at.fromArray(positions, 3 * vertex).applyMatrix4(matrix).toArray(points, 3 * (g * ends.length + i)));
  });
  const lines = new LineSegmentsGeometry();
  lines.setPositions(points);
  return new LineSegments2(lines, new LineMaterial({color: new Color(colour), linewidth: width}));
}
