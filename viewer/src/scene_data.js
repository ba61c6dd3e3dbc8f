// SPDX-License-Identifier: MIT
// Decodes what src/orbitutte/output/page_scene.h describes into typed arrays.

function bytesOf(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64);
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

const numbers = (Type, base64) => new Type(bytesOf(base64).buffer);

// Numbers of 16 bits between two bounds.
function between(low, high, base64) {
  const values = Float32Array.from(numbers(Uint16Array, base64));
  const step = (high - low) / 65535;
  for (let i = 0; i < values.length; ++i) values[i] = low + step * values[i];
  return values;
}

// The source, scaled and moved such that its box's longest edge is 2 and its middle is 0.
function centred(quantised) {
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

/** The scene as typed arrays: three numbers a vertex for source, image and normal, one for the others. */
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
    fine: level(json.fine),
    coarse: level(json.coarse),
    copies: json.copies,
    cones: json.cones,
  };
}
