// SPDX-License-Identifier: MIT
// One panel: what it shows, its camera, the dots and labels on it.
import {PerspectiveCamera, Raycaster, Scene, Vector2} from 'three';
import {Dots} from './dots.js';

const FIELD_OF_VIEW = 24;

const distanceFor = (radius) => radius / Math.sin((FIELD_OF_VIEW * Math.PI) / 360);

/** `capacity` is that of its dots. `frame` is the ball, given by centre and radius, that the camera shows at first. */
export class Panel {
  constructor(name, stage, {capacity, frame}) {
    this.name = name;
    this.stage = stage;
    this.scene = new Scene();
    this.frame = frame;
    this.camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 100);
    this.cones = new Dots({capacity: capacity.cones, size: 0.014});
    this.marks = new Dots({capacity: capacity.marks, size: 0.014});
    this.point = new Dots({capacity: capacity.copies, size: 0.014});
    this.rim = new Dots({capacity: capacity.copies, size: 0.02, rim: true});
    for (const dots of this.dots()) this.scene.add(dots.mesh);
    this.labels = [];
  }

  dots() {
    return [this.cones, this.marks, this.rim, this.point];
  }

  place() {
    return {camera: this.camera, target: this.frame.target, distance: distanceFor(this.frame.radius)};
  }

  /** Called before every picture. */
  prepare() {
    this.fitCamera(this.stage.clientWidth / this.stage.clientHeight);
    for (const dots of this.dots()) dots.fit(this.camera);
  }

  // Makes what fits a square fit the shorter side of the panel.
  fitCamera(aspect) {
    const half = Math.tan((FIELD_OF_VIEW * Math.PI) / 360) / Math.min(aspect, 1);
    this.camera.fov = (2 * Math.atan(half) * 180) / Math.PI;
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
  }

  ray(x, y) {
    const ndc = new Vector2((2 * x) / this.stage.clientWidth - 1, 1 - (2 * y) / this.stage.clientHeight);
    const caster = new Raycaster();
    caster.setFromCamera(ndc, this.camera);
    return caster.ray;
  }

  /** The place of a position on the panel, in CSS pixels. */
  project(at) {
    const ndc = at.clone().project(this.camera);
    return {x: ((ndc.x + 1) / 2) * this.stage.clientWidth, y: ((1 - ndc.y) / 2) * this.stage.clientHeight};
  }

  /** The length in pixels of a length in the middle of the panel. */
  pixels(length) {
    const {fov, zoom, position} = this.camera;
    const seen = (2 * Math.tan((fov * Math.PI) / 360) * position.distanceTo(this.frame.target)) / zoom;
    return (length / seen) * this.stage.clientHeight;
  }

  /** Writes `label` beside every dot. */
  addLabels(dots) {
    this.labels = dots.map(({at, label}) => {
      const element = document.createElement('span');
      element.className = 'cone-label';
      element.textContent = label;
      this.stage.append(element);
      return {at, element, width: element.offsetWidth};
    });
  }

  /** Moves the labels to their dots, but not beyond the panel's edge. `isHidden(at)` says which of them are not seen. */
  placeLabels(isHidden) {
    const {clientWidth, clientHeight} = this.stage;
    for (const {at, element, width} of this.labels) {
      const {x, y} = this.project(at);
      const left = Math.min(x + 9, clientWidth - width), top = Math.max(y - 22, 0);
      element.style.transform = `translate(${left}px, ${top}px)`;
      element.hidden = x < 0 || y < 0 || x > clientWidth || y > clientHeight || isHidden(at);
    }
  }
}
