// SPDX-License-Identifier: MIT
// The colours of the distortions, for surfaces and legend.
import {DataTexture, LinearFilter, RGBAFormat} from 'three';

// Diverging and light in the middle; can be told apart with impaired colour vision, too (after P. Tol's "sunset" scheme).
const diverging = ['#364b9a', '#4a7bb7', '#6ea6cd', '#98cae1', '#c2e4ef', '#eaeccc', '#feda8b', '#fdb366', '#f67e4b', '#dd3d2d', '#a50026'];
// From light to dark (after P. Tol's "iridescent" and "YlOrBr" schemes).
const sequential = ['#ffffe5', '#fff7bc', '#fee391', '#fec44f', '#fb9a29', '#ec7014', '#cc4c02', '#993404', '#662506'];

const channels = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));

function texture(stops) {
  const size = 256, data = new Uint8Array(4 * size);
  for (let i = 0; i < size; ++i) {
    const at = (i / (size - 1)) * (stops.length - 1), k = Math.min(Math.floor(at), stops.length - 2);
    const from = channels(stops[k]), to = channels(stops[k + 1]);
    for (let c = 0; c < 3; ++c) data[4 * i + c] = Math.round(from[c] + (at - k) * (to[c] - from[c]));
    data[4 * i + 3] = 255;
  }
  const result = new DataTexture(data, size, 1, RGBAFormat);
  result.minFilter = result.magFilter = LinearFilter;
  result.needsUpdate = true;
  return result;
}

const css = (stops) => `linear-gradient(to right, ${stops.join(', ')})`;

export const areaMap = {texture: () => texture(diverging), css: css(diverging)};
export const angleMap = {texture: () => texture(sequential), css: css(sequential)};

/** The first bound `among` these that only a `share` of the values exceeds in size; the last one if there is none. */
export function robustBound(values, {share, among}) {
  const stride = Math.max(1, Math.floor(values.length / 20000));
  const sizes = [];
  for (let i = 0; i < values.length; i += stride) sizes.push(Math.abs(values[i]));
  sizes.sort((a, b) => a - b);
  const size = sizes[Math.floor((1 - share) * (sizes.length - 1))] ?? 0;
  return among.find((bound) => bound >= size) ?? among[among.length - 1];
}
