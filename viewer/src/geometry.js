// SPDX-License-Identifier: MIT
// Makes what three.js draws from the scene's numbers: surfaces, edges and thick lines.
import {BufferAttribute, BufferGeometry, Color, Vector3} from 'three';
import {LineMaterial} from 'three/examples/jsm/lines/LineMaterial.js';
import {LineSegments2} from 'three/examples/jsm/lines/LineSegments2.js';
import {LineSegmentsGeometry} from 'three/examples/jsm/lines/LineSegmentsGeometry.js';

/** The attributes that all surfaces share, under the shader's names. 'source' and 'image' are places. */
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

/** Triangles in one of the places 'source' and 'image'. */
export function surfaceGeometry(shared, place, indices) {
  const {source, ...others} = shared, result = new BufferGeometry();
  result.setAttribute('position', shared[place]);
  for (const [name, attribute] of Object.entries(others)) result.setAttribute(name, attribute);
  result.setIndex(new BufferAttribute(indices, 1));
  return result;
}

/** The edges of triangles, each once. About half of the outline's edges are missing, since the outline is drawn anyway. */
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

/** The mean length of the edges, from a sample of them. */
export function meanLength(positions, edges) {
  const stride = 2 * Math.max(1, Math.floor(edges.length / 20000)), [from, to] = [new Vector3(), new Vector3()];
  let sum = 0, count = 0;
  for (let i = 0; i < edges.length; i += stride, ++count)
    sum += from.fromArray(positions, 3 * edges[i]).distanceTo(to.fromArray(positions, 3 * edges[i + 1]));
  return sum / Math.max(count, 1);
}

// The two neighbours of every vertex on closed chains of edges; null if the edges do not form such chains.
function chainNeighbours(ends) {
  const neighbours = new Map();
  const link = (from, to) => neighbours.set(from, [...(neighbours.get(from) ?? []), to]);
  for (let i = 0; i < ends.length; i += 2) {
    link(ends[i], ends[i + 1]);
    link(ends[i + 1], ends[i]);
  }
  return [...neighbours.values()].every(({length}) => length === 2) ? neighbours : null;
}

// The vertices of a chain after `start`; `start` comes last.
function* chainFrom(start, neighbours) {
  let previous = start, [at] = neighbours.get(start);
  for (; at !== start; [previous, at] = [at, neighbours.get(at).find((other) => other !== previous)]) yield at;
  yield start;
}

/** Closed chains with fewer edges: leaves out a vertex if it is nearer than `least` to the last one kept. */
export function thinnedChains(positions, ends, least) {
  const neighbours = chainNeighbours(ends), kept = [];
  if (!neighbours) return ends;
  const place = (vertex) => new Vector3().fromArray(positions, 3 * vertex);
  const left = new Set(neighbours.keys());
  for (const start of left) {
    let last = start;
    for (const vertex of chainFrom(start, neighbours)) {
      left.delete(vertex);
      if (vertex !== start && place(vertex).distanceTo(place(last)) < least) continue;
      kept.push(last, vertex);
      last = vertex;
    }
  }
  return Uint32Array.from(kept);
}

/** Thick lines along pairs of positions. */
export function thickLines(positions, ends, {width, colour}) {
  const points = new Float32Array(3 * ends.length), lines = new LineSegmentsGeometry();
  ends.forEach((vertex, i) => points.set(positions.subarray(3 * vertex, 3 * vertex + 3), 3 * i));
  lines.setPositions(points);
  return new LineSegments2(lines, new LineMaterial({color: new Color(colour), linewidth: width}));
}
