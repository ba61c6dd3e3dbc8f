// SPDX-License-Identifier: MIT
// The direction from which the source is first seen.
import {Quaternion, Vector3} from 'three';

const DIRECTIONS = 16, ELEVATION = 0.2, SAMPLES = 4000;

const X = new Vector3(1, 0, 0), Y = new Vector3(0, 1, 0);

const orientation = (azimuth) =>
  new Quaternion().setFromAxisAngle(Y, azimuth).multiply(new Quaternion().setFromAxisAngle(X, -ELEVATION));

const normalAt = ({normal}, vertex) => new Vector3().fromArray(normal, 3 * vertex).normalize();

/**
 * The camera's orientation, y upwards, that faces most of the surface and the cones. It prefers +z, where many meshes have
 * their front.
 */
export function firstView(scene) {
  const count = scene.normal.length / 3, stride = Math.max(1, Math.floor(count / SAMPLES));
  const cones = scene.cones.flatMap(({drawn}) => drawn.slice(0, 1)).map((vertex) => normalAt(scene, vertex));
  const samples = [];
  for (let v = 0; v < count; v += stride) samples.push(normalAt(scene, v));
  const faced = (normals, direction) =>
    normals.reduce((sum, normal) => sum + Math.max(normal.dot(direction), 0), 0) / Math.max(normals.length, 1);

  let best = null;
  for (let k = 0; k < DIRECTIONS; ++k) {
    const turned = orientation((2 * Math.PI * k) / DIRECTIONS);
    const direction = new Vector3(0, 0, 1).applyQuaternion(turned);
    const score = 2 * faced(samples, direction) + 0.6 * faced(cones, direction) + 0.2 * direction.z;
    if (!best || score > best.score + 1e-6) best = {score, turned};
  }
  return best.turned;
}
