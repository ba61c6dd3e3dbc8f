// SPDX-License-Identifier: MIT
// Decodes the scene that src/orbitutte/page/page_scene.h describes into typed arrays.
import {Matrix4, Vector3} from 'three';

function bytesOf(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64);
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** The numbers of a type in base64. */
export const numbers = (Type, base64) => new Type(bytesOf(base64).buffer);

/** Numbers of 16 bits, scaled to lie between two bounds. */
export function between(low, high, base64) {
  const values = Float32Array.from(numbers(Uint16Array, base64));
  const step = (high - low) / 65535;
  for (let i = 0; i < values.length; ++i) values[i] = low + step * values[i];
  return values;
}

/** Positions, scaled and moved so that the longest edge of their box is 2 and its middle is 0. */
export function centred(quantised) {
  const values = Float32Array.from(numbers(Uint16Array, quantised));
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < values.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], values[i]);
    high[i % 3] = Math.max(high[i % 3], values[i]);
  }
  for (let i = 0; i < values.length; ++i) values[i] = (values[i] - (low[i % 3] + high[i % 3]) / 2) / 32767.5;
  return values;
}

const level = ({indices, outline}) => ({
  indices: numbers(Uint32Array, indices),
  outline: numbers(Uint32Array, outline),
});

// A transform given row by row.
const matrixOf = ([a, b, c, d, e, f, g, h, i]) => new Matrix4().set(a, b, c, 0, d, e, f, 0, g, h, i, 0, 0, 0, 0, 1);

/**
 * The scene as typed arrays: three numbers per vertex for source, image, normal and colour (null if there is none), one for
 * the others; and the values for which the colours stand (null if there are none).
 */
export function readScene(json) {
  return {
    faces: json.faces,
    shownFaces: json.shown_faces,
    copyFaces: json.copy_faces,
    source: centred(json.source),
    image: numbers(Float32Array, json.image),
    normal: numbers(Int8Array, json.normal),
    sourceVertex: numbers(Uint32Array, json.source_vertex),
    area: between(...json.area_range, json.area),
    angle: between(...json.angle_range, json.angle),
    colour: json.colour ? numbers(Uint8Array, json.colour) : null,
    values: json.values ? {name: json.values.name, numbers: numbers(Float32Array, json.values.numbers), labels: json.values.labels && new Map(json.values.labels)} : null,
    fine: level(json.fine),
    coarse: level(json.coarse),
    copies: json.copies.map(({transform, colour}) => ({matrix: matrixOf(transform), colour})),
    cones: json.cones,
    scales: json.scales,
    tile: json.tile,
    ink: json.ink,
  };
}

/** The position of a drawn vertex in 'source' or 'image'. */
export const vertexPosition = (scene, name, vertex) => new Vector3().fromArray(scene[name], 3 * vertex);

/**
 * The tile's frame: its middle, two directions across, and how far its vertices lie from the middle of their chord. The
 * middle comes from the tile's vector area, which does not cancel for a tile up to a hemisphere.
 */
export function tileFrame({image, coarse: {indices}}) {
  const sum = new Vector3(), [a, b, c] = [new Vector3(), new Vector3(), new Vector3()];
  for (let f = 0; f < indices.length; f += 3) {
    [a, b, c].forEach((corner, k) => corner.fromArray(image, 3 * indices[f + k]));
    sum.add(b.sub(a).cross(c.sub(a)));
  }
  const centre = sum.normalize();
  const up = Math.abs(centre.y) < 0.9 ? new Vector3(0, 1, 0) : new Vector3(0, 0, -1);
  const east = up.clone().cross(centre).normalize(), north = centre.clone().cross(east);
  let least = 1;
  for (let i = 0; i < image.length; i += 3) least = Math.min(least, a.fromArray(image, i).dot(centre));
  const middle = centre.clone().multiplyScalar((1 + Math.max(least, 0)) / 2);
  let radius = 0;
  for (let i = 0; i < image.length; i += 3) radius = Math.max(radius, a.fromArray(image, i).distanceTo(middle));
  return {centre, east, north, middle, radius};
}
