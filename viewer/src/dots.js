// SPDX-License-Identifier: MIT
// Small balls that keep their size on the screen: cones, marked vertices, the point under the pointer.
import {BackSide, Color, FrontSide, InstancedMesh, Matrix4, MeshBasicMaterial, SphereGeometry, Vector3} from 'three';

// As a share of the panel's height; the same for dots of all sizes.
const LIFT = 0.016;

const ball = new SphereGeometry(1, 20, 14);

/**
 * Room for `capacity` dots; `size` is their radius as a share of the panel's height. A `rim` shows only its far side, so
 * that it surrounds smaller dots at the same places.
 */
export class Dots {
  constructor({capacity, size, rim = false}) {
    this.size = size;
    this.mesh = new InstancedMesh(ball, new MeshBasicMaterial({side: rim ? BackSide : FrontSide}), Math.max(capacity, 1));
    this.mesh.frustumCulled = false;
    this.set([]);
  }

  /** Shows dots at positions, each with a colour and, optionally, a scale. */
  set(dots) {
    this.dots = dots.slice(0, this.mesh.instanceMatrix.count);
    this.mesh.count = this.dots.length;
    this.dots.forEach(({colour}, i) => this.mesh.setColorAt(i, new Color(colour)));
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }

  /** Called before every picture. Moves the dots in front of the surface by their radius, so that it does not cut them. */
  fit(camera) {
    const matrix = new Matrix4(), scale = new Vector3(), toEye = new Vector3();
    const unit = (2 * this.size * Math.tan((camera.fov * Math.PI) / 360)) / camera.zoom;
    this.dots.forEach(({at, scale: factor = 1}, i) => {
      toEye.subVectors(camera.position, at);
      const radius = factor * unit * toEye.length();
      toEye.setLength((LIFT * radius) / this.size).add(at);
      matrix.makeScale(...scale.setScalar(radius)).setPosition(toEye);
      this.mesh.setMatrixAt(i, matrix);
    });
    this.mesh.instanceMatrix.needsUpdate = true;
  }
}
