// SPDX-License-Identifier: MIT
// Small balls that keep their size on the screen: cones, marked vertices, the point under the pointer.
import {Color, InstancedMesh, Matrix4, MeshBasicMaterial, SphereGeometry, Vector3} from 'three';

const ball = new SphereGeometry(1, 20, 14);

/** Room for `capacity` dots; `size` is their radius as a share of the panel's height. */
export class Dots {
  constructor(capacity, size) {
    this.size = size;
    this.mesh = new InstancedMesh(ball, new MeshBasicMaterial(), Math.max(capacity, 1));
    this.mesh.frustumCulled = false;
    this.set([]);
  }

  /** Shows dots at positions, each with a colour and, if it is to differ, a scale. */
  set(dots) {
    this.dots = dots.slice(0, this.mesh.instanceMatrix.count);
    this.mesh.count = this.dots.length;
    this.dots.forEach(({colour}, i) => this.mesh.setColorAt(i, new Color(colour)));
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }

  /** Called before every picture. */
  fit(camera) {
    const matrix = new Matrix4(), scale = new Vector3();
    const unit = 2 * this.size * Math.tan((camera.fov * Math.PI) / 360);
    this.dots.forEach(({at, scale: factor = 1}, i) => {
      const radius = factor * unit * camera.position.distanceTo(at);
      matrix.makeScale(...scale.setScalar(radius)).setPosition(at);
      this.mesh.setMatrixAt(i, matrix);
    });
    this.mesh.instanceMatrix.needsUpdate = true;
  }
}
