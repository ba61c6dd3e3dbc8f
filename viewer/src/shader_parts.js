// SPDX-License-Identifier: MIT
// What the shaders of all surfaces share, in GLSL.

// The middles of the outermost texels are the ends of the scale.
export const ON_SCALE = /* glsl */ `
vec3 onScale(sampler2D map, vec2 ends, float value) {
  float texels = float(textureSize(map, 0).x);
  float share = clamp((value - ends.x) / (ends.y - ends.x), 0.0, 1.0);
  return texture2D(map, vec2((0.5 + share * (texels - 1.0)) / texels, 0.5)).rgb;
}`;

// Of a checkerboard: from the parities along all axes, at the place in squares and its width in a pixel. Squares of the size of
// pixels become grey.
export const RAMPS = /* glsl */ `
vec3 ramps(vec3 place, vec3 width) {
  return clamp((abs(fract(place * 0.5) - 0.5) - 0.25) / width, -0.5, 0.5) * 2.0;
}
float fade(float width) { return clamp(1.5 - width, 0.0, 1.0); }`;

// Of a unit normal that points to the eye.
export const LIGHT_ON = /* glsl */ `
float lightOn(vec3 n) {
  return 0.52 + 0.48 * max(dot(n, normalize(vec3(-0.35, 0.55, 0.8))), 0.0) + 0.08 * n.z;
}`;
