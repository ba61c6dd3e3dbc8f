// SPDX-License-Identifier: MIT
// The material of all surfaces: one shader with a colouring that the user chooses.
import {DoubleSide, ShaderMaterial, Vector2} from 'three';
import {LIGHT_ON, ON_SCALE, RAMPS} from './shader_parts.js';

export const COLOURINGS = {tile: 0, checkerboard: 1, area: 2, angle: 3, normal: 4, vertex: 5};

const vertexShader = /* glsl */ `
attribute vec3 image;         // on the unit sphere, in the tile itself
attribute vec3 sourceNormal;
attribute vec3 sourceColour;
attribute float area;
attribute float angle;
varying vec3 vView, vNormal, vImage, vSourceNormal, vSourceColour, vTint;
varying float vArea, vAngle;
uniform bool onSphere;
uniform vec3 tint;

void main() {
  vec4 at = vec4(position, 1.0);
  vec3 n = onSphere ? position : sourceNormal;
  vTint = tint;
#ifdef USE_INSTANCING
  at = instanceMatrix * at;
  n = mat3(instanceMatrix) * n;
#endif
#ifdef USE_INSTANCING_COLOR
  vTint = instanceColor;
#endif
  at = modelViewMatrix * at;
  vView = at.xyz;
  vNormal = normalMatrix * n;
  vImage = image;
  vSourceNormal = sourceNormal;
  vSourceColour = sourceColour;
  vArea = area;
  vAngle = angle;
  gl_Position = projectionMatrix * at;
}`;

const fragmentShader = /* glsl */ `
varying vec3 vView, vNormal, vImage, vSourceNormal, vSourceColour, vTint;
varying float vArea, vAngle;
uniform int colouring;
uniform bool onSphere;
uniform float squares, opacity, relief;
uniform vec2 areaEnds, angleEnds;    // the values at both ends of the scales
uniform sampler2D areaMap, angleMap;
uniform vec3 centre, east, north;   // the tile's frame: its middle, and two directions across
uniform vec3 sourceLight;
${ON_SCALE}${RAMPS}${LIGHT_ON}

// Stereographic from the antipode of the tile's middle, so that a conformal map shows squares.
float checker(vec3 p) {
  vec2 plane = vec2(dot(p, east), dot(p, north)) / (1.0 + dot(p, centre)) * squares;
  vec2 width = max(fwidth(plane), 1e-6);
  vec3 ramp = ramps(vec3(plane, 0.0), vec3(width, 1.0));
  return 0.5 + 0.5 * ramp.x * ramp.y * fade(max(width.x, width.y));
}

vec3 colour() {
  if (colouring == 1) return mix(vTint * 0.45, mix(vTint, vec3(1.0), 0.72), checker(normalize(vImage)));
  if (colouring == 2) return onScale(areaMap, areaEnds, vArea);
  if (colouring == 3) return onScale(angleMap, angleEnds, exp2(vAngle));
  if (colouring == 4) return 0.64 + 0.34 * normalize(vSourceNormal);
  if (colouring == 5) return vSourceColour;
  return vTint;
}

void main() {
  vec3 toEye = normalize(-vView);
  vec3 n = normalize(vNormal);
  if (onSphere && opacity < 1.0 && dot(n, toEye) < 0.0) discard;   // translucent copies hide nothing behind
  if (dot(n, toEye) < 0.0) n = -n;                                 // both sides of a disk are lit
  float light = lightOn(n);
  if (onSphere) {
    float bumps = 0.8 + 0.28 * dot(normalize(vSourceNormal), sourceLight);
    bool measured = colouring == 2 || colouring == 3;   // colours that are read off a legend are shaded less
    light = mix(light, (0.4 + 0.6 * light) * bumps, measured ? 0.35 * relief : relief);
  }
  gl_FragColor = vec4(min(colour() * light * 1.04, 1.0), opacity);
}`;

/** Uniforms that all surfaces share, so that one assignment changes all of them. */
export function sharedUniforms(frame, maps, scales) {
  return {
    colouring: {value: COLOURINGS.tile},
    squares: {value: 14},
    relief: {value: 1},
    areaEnds: {value: new Vector2(scales.area.low, scales.area.high)},
    angleEnds: {value: new Vector2(scales.angle.low, scales.angle.high)},
    areaMap: {value: maps.area},
    angleMap: {value: maps.angle},
    centre: {value: frame.centre},
    east: {value: frame.east},
    north: {value: frame.north},
    sourceLight: {value: frame.sourceLight},
  };
}

/** A material with shared uniforms, and with an opacity and colour of its own. */
export function surfaceMaterial(shared, {onSphere, tint}) {
  return new ShaderMaterial({
    vertexShader,
    fragmentShader,
    uniforms: {...shared, onSphere: {value: onSphere}, tint: {value: tint}, opacity: {value: 1}},
    side: DoubleSide,
    polygonOffset: true,  // lines on the surface stay in front of it
    polygonOffsetFactor: 1.5,
    polygonOffsetUnits: 2,
  });
}
