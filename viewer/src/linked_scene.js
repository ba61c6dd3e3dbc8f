// SPDX-License-Identifier: MIT
// Decodes the scene of two linked surfaces, which src/orbitutte/page/map_page.h describes.
import {between, centred, numbers} from './scene_data.js';

/**
 * The scene as typed arrays: three numbers per vertex of the overlay for the places 'a' and 'b', their normals and the
 * carried colours, one for the others.
 */
export function readLinkedScene(json) {
  return {
    a: centred(json.a),
    b: centred(json.b),
    normals: {a: numbers(Int8Array, json.a_normal), b: numbers(Int8Array, json.b_normal)},
    vertices: {a: numbers(Int32Array, json.a_vertex), b: numbers(Int32Array, json.b_vertex)},
    colour: numbers(Uint8Array, json.colour),
    area: between(...json.area_range, json.area),
    energy: between(...json.energy_range, json.energy),
    fine: {indices: numbers(Uint32Array, json.indices)},
    landmarks: json.landmarks,
    scales: json.scales,
    plain: json.plain,
    ink: json.ink,
    copies: [],  // a map between surfaces has no copies of a tile
  };
}
