// SPDX-License-Identifier: MIT
// The material of linked surfaces: B's colours and a checkerboard of cubes around B, on both, and the distortion.
import {BufferAttribute, BufferGeometry, Color, DoubleSide, ShaderMaterial, Vector2} from 'three';
import {LIGHT_ON, ON_SCALE, RAMPS} from './shader_parts.js';

export const LINKED_COLOURINGS = {colours: 0, checkerboard: 1, area: 2, energy: 3, plain: 4};

const vertexShader = /* glsl */ `
attribute vec3 shownNormal;
attribute vec3 carried;    // the colour on B
attribute vec3 onB;
attribute float area;
attribute float energy;
varying vec3 vView, vNormal, vCarried, vOnB;
varying float vArea, vEnergy;

void main() {
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  vView = at.xyz;
  vNormal = normalMatrix * shownNormal;
  vCarried = carried;
  vOnB = onB;
  vArea = area;
  vEnergy = energy;
  gl_Position = projectionMatrix * at;
}`;

const fragmentShader = /* glsl */ `
varying vec3 vView, vNormal, vCarried, vOnB;
varying float vArea, vEnergy;
uniform int colouring;
uniform float squares;
uniform vec2 areaEnds, energyEnds;
uniform sampler2D areaMap, energyMap;
uniform vec3 plain;
${ON_SCALE}${RAMPS}${LIGHT_ON}

// The parity of the cube that a place of B lies in; cubes of the size of pixels become grey.
float cubes(vec3 at) {
  vec3 place = at * squares * 0.5 + 0.37;
  vec3 width = max(fwidth(place), 1e-6);
  vec3 ramp = ramps(place, width);
  return 0.5 + 0.5 * ramp.x * ramp.y * ramp.z * fade(max(width.x, max(width.y, width.z)));
}

vec3 colour() {
  if (colouring == 0) return vCarried;
  if (colouring == 1) return mix(plain * 0.75, vec3(0.94), cubes(vOnB));
  if (colouring == 2) return onScale(areaMap, areaEnds, vArea);
  if (colouring == 3) return onScale(energyMap, energyEnds, vEnergy);
  return plain;
}

void main() {
  vec3 toEye = normalize(-vView);
  vec3 n = normalize(vNormal);
  if (dot(n, toEye) < 0.0) n = -n;
  gl_FragColor = vec4(min(colour() * lightOn(n) * 1.04, 1.0), 1.0);
}`;

/** The uniforms that both surfaces share, so that one assignment changes both. */
export const linkedUniforms = (scene, maps) => ({
  colouring: {value: LINKED_COLOURINGS.colours},
  squares: {value: 14},
  areaEnds: {value: new Vector2(scene.scales.area.low, scene.scales.area.high)},
  energyEnds: {value: new Vector2(scene.scales.energy.low, scene.scales.energy.high)},
  areaMap: {value: maps.area},
  energyMap: {value: maps.energy},
  plain: {value: new Color(scene.plain)},
});

export const linkedMaterial = (uniforms) => new ShaderMaterial({vertexShader, fragmentShader, uniforms, side: DoubleSide});

/** The overlay's triangles at the place 'a' or 'b'. */
export function linkedGeometry(scene, place) {
  const result = new BufferGeometry();
  result.setAttribute('position', new BufferAttribute(scene[place], 3));
  result.setAttribute('shownNormal', new BufferAttribute(scene.normals[place], 3, true));
  result.setAttribute('carried', new BufferAttribute(scene.colour, 3, true));
  result.setAttribute('onB', new BufferAttribute(scene.b, 3));
  result.setAttribute('area', new BufferAttribute(scene.area, 1));
  result.setAttribute('energy', new BufferAttribute(scene.energy, 1));
  result.setIndex(new BufferAttribute(scene.fine.indices, 1));
  return result;
}
