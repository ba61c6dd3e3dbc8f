// SPDX-License-Identifier: MIT
// A point of the mesh is a drawn face and barycentric coordinates, the same in the source and on the sphere.
import {BufferAttribute, BufferGeometry, DoubleSide, Ray, Sphere, Triangle, Vector3} from 'three';
import {MeshBVH} from 'three-mesh-bvh';

const unitSphere = new Sphere(new Vector3(), 1);
const OUTLINE_SLACK = 0.02;  // radians, approximately

const corners = [new Vector3(), new Vector3(), new Vector3()];

function loadCorners(indices, positions, face) {
  for (let k = 0; k < 3; ++k) corners[k].fromArray(positions, 3 * indices[3 * face + k]);
}

/** Finds the points of the mesh under rays, in the source and on the tile; both have the same faces. */
export class MapPoints {
  constructor(scene) {
    this.scene = scene;
    this.inverses = scene.copies.map(({matrix}) => matrix.clone().invert());
    this.trees = {};
  }

  // Builds a tree when it is first needed, which takes a tenth of a second per 100,000 faces.
  tree(name) {
    if (!this.trees[name]) {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(this.scene[name], 3));
      geometry.setIndex(new BufferAttribute(this.scene.fine.indices, 1));
      this.trees[name] = new MeshBVH(geometry, {indirect: true});
    }
    return this.trees[name];
  }

  firstHit(name, ray) {
    const hit = this.tree(name).raycastFirst(ray, DoubleSide);
    return hit && this.pointOf(name, hit);
  }

  // The point that a ray hit, in barycentric coordinates.
  pointOf(name, {faceIndex, point, distance}) {
    loadCorners(this.scene.fine.indices, this.scene[name], faceIndex);
    const weights = Triangle.getBarycoord(point, ...corners, new Vector3());
    return weights && {face: faceIndex, weights, copy: 0, distance};
  }

  onSource(ray) {
    return this.firstHit('source', ray);
  }

  /** The point within the tile alone, or on its outline if the ray meets the sphere close to it. */
  onTile(ray) {
    const at = ray.intersectSphere(unitSphere, new Vector3());
    if (!at) return null;
    const hit = this.firstHit('image', new Ray(new Vector3(), at.clone().normalize()));
    return hit ?? this.nearest(at, OUTLINE_SLACK);
  }

  /** The point in the copy that covers the sphere where the ray meets it. */
  onSphere(ray) {
    const at = ray.intersectSphere(unitSphere, new Vector3());
    if (!at) return null;
    const inTile = new Ray();
    for (let copy = 0; copy < this.inverses.length; ++copy) {
      inTile.direction.copy(at).applyMatrix4(this.inverses[copy]).normalize();
      const hit = this.firstHit('image', inTile);
      if (hit) return {...hit, copy};
    }
    return this.onSeam(at);
  }

  // Rounding can leave a place exactly on a seam to no copy. It then belongs to the nearest.
  onSeam(at) {
    const candidates = this.inverses.map((inverse, copy) => ({...this.nearest(at.clone().applyMatrix4(inverse), Infinity), copy}));
    return candidates.reduce((best, other) => (other.distance < best.distance ? other : best));
  }

  nearest(at, farthest) {
    const hit = this.tree('image').closestPointToPoint(at, {}, 0, farthest);
    return hit && this.pointOf('image', hit);
  }

  /** The position of a point in 'source' or 'image'. */
  position(name, {face, weights}) {
    loadCorners(this.scene.fine.indices, this.scene[name], face);
    const at = new Vector3();
    corners.forEach((corner, k) => at.addScaledVector(corner, weights.getComponent(k)));
    return name === 'image' ? at.normalize() : at;
  }

  /** The value at a point of a quantity given at the vertices. */
  value(quantity, {face, weights}) {
    let sum = 0;
    for (let k = 0; k < 3; ++k) sum += weights.getComponent(k) * quantity[this.scene.fine.indices[3 * face + k]];
    return sum;
  }

  /** The drawn vertex of a point's face that is nearest to the point. */
  nearestVertex({face, weights}) {
    const largest = [0, 1, 2].reduce((best, k) => (weights.getComponent(k) > weights.getComponent(best) ? k : best), 0);
    return this.scene.fine.indices[3 * face + largest];
  }
}
