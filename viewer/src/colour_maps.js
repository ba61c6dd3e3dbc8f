// SPDX-License-Identifier: MIT
// The scales of the distortions, for surfaces and legend. Their colours come with the scene.
import {DataTexture, LinearFilter, RGBAFormat} from 'three';

const channels = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));

/** A row of texels, the first at the low end of the scale. */
export function texture(colours) {
  const data = new Uint8Array(colours.flatMap((colour) => [...channels(colour), 255]));
  const result = new DataTexture(data, colours.length, 1, RGBAFormat);
  result.minFilter = result.magFilter = LinearFilter;
  result.needsUpdate = true;
  return result;
}

/** The same as a background in CSS. */
export const gradient = (colours) => `linear-gradient(to right, ${colours.join(', ')})`;
