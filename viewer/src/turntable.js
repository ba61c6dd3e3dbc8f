// SPDX-License-Identifier: MIT
// Turns and zooms one or more cameras around the origin, by pointer, touch, wheel and keyboard.
import {Quaternion, Vector3} from 'three';

const TURN_PER_KEY = Math.PI / 18;
const ZOOM_PER_KEY = 1.12;
const NEAREST = 0.15, FARTHEST = 4;
const CLICK_SLACK = 6;  // pixels that a pointer may move in a click

const X = new Vector3(1, 0, 0), Y = new Vector3(0, 1, 0);

/**
 * Places cameras, all with the same orientation and zoom. Each `{camera, target, distance}` looks at its target from its
 * distance; the zoom narrows its field of view.
 */
export class Turntable {
  constructor(places, orientation = new Quaternion()) {
    this.places = places;
    this.start = orientation.clone();
    this.onChange = () => {};
    this.reset();
  }

  reset() {
    this.orientation = this.start.clone();
    this.zoom = 1;
    this.apply();
  }

  /** Turns the objects by angles about the screen's vertical and horizontal axes. */
  turn(horizontal, vertical) {
    this.orientation.multiply(new Quaternion().setFromAxisAngle(Y, -horizontal));
    this.orientation.multiply(new Quaternion().setFromAxisAngle(X, -vertical)).normalize();
    this.apply();
  }

  zoomBy(factor) {
    this.zoom = Math.min(Math.max(this.zoom / factor, NEAREST), FARTHEST);
    this.apply();
  }

  apply() {
    for (const {camera, target, distance} of this.places) {
      camera.quaternion.copy(this.orientation);
      camera.position.set(0, 0, distance).applyQuaternion(this.orientation).add(target);
      camera.updateMatrixWorld();
      camera.zoom = 1 / this.zoom;  // a nearer camera would be inside the surface
      camera.updateProjectionMatrix();
    }
    this.onChange();
  }
}

const KEYS = {
  ArrowLeft: (table) => table.turn(-TURN_PER_KEY, 0),
  ArrowRight: (table) => table.turn(TURN_PER_KEY, 0),
  ArrowUp: (table) => table.turn(0, -TURN_PER_KEY),
  ArrowDown: (table) => table.turn(0, TURN_PER_KEY),
  '+': (table) => table.zoomBy(ZOOM_PER_KEY),
  '=': (table) => table.zoomBy(ZOOM_PER_KEY),
  '-': (table) => table.zoomBy(1 / ZOOM_PER_KEY),
  Home: (table) => table.reset(),
};

/** Lets the user turn a table through an element. `hover` and `click` receive the place, in CSS pixels within the element. */
export class StageInput {
  constructor(element, table, {hover, leave, click}) {
    this.element = element;
    this.table = table;
    this.actions = {hover, leave, click};
    this.pointers = new Map();
    this.moved = 0;
    const on = (name, handler, options) => element.addEventListener(name, handler.bind(this), options);
    on('pointerdown', this.down);
    on('pointermove', this.move);
    on('pointerup', this.up);
    on('pointercancel', this.forget);
    on('pointerleave', () => this.actions.leave());
    on('wheel', this.wheel, {passive: false});
    on('keydown', this.key);
  }

  place(event) {
    const box = this.element.getBoundingClientRect();
    return {x: event.clientX - box.left, y: event.clientY - box.top};
  }

  down(event) {
    this.pointers.set(event.pointerId, this.place(event));
    this.element.setPointerCapture(event.pointerId);
    this.moved = this.pointers.size > 1 ? Infinity : 0;
  }

  move(event) {
    const now = this.place(event), before = this.pointers.get(event.pointerId);
    if (!before) return this.actions.hover(now.x, now.y);
    if (this.pointers.size === 1) this.drag(before, now);
    else this.pinch(event.pointerId, before, now);
    this.pointers.set(event.pointerId, now);
  }

  drag(before, now) {
    this.moved += Math.hypot(now.x - before.x, now.y - before.y);
    if (this.moved < CLICK_SLACK) return;
    const perPixel = (2.6 * Math.min(this.table.zoom, 1)) / this.element.clientHeight;
    this.table.turn((now.x - before.x) * perPixel, (now.y - before.y) * perPixel);
  }

  pinch(id, before, now) {
    const [, other] = [...this.pointers].find(([key]) => key !== id);
    const span = (p) => Math.max(Math.hypot(p.x - other.x, p.y - other.y), 1);
    this.table.zoomBy(span(now) / span(before));
  }

  up(event) {
    const place = this.place(event), clicked = this.pointers.has(event.pointerId) && this.moved < CLICK_SLACK;
    this.forget(event);
    if (clicked) this.actions.click(place.x, place.y);
  }

  forget(event) {
    this.pointers.delete(event.pointerId);
  }

  // The wheel scrolls the page, unless the panel has the focus or Ctrl is held. (Browsers report a pinch on a touchpad as Ctrl
  // and wheel.)
  wheel(event) {
    if (!event.ctrlKey && document.activeElement !== this.element) return;
    event.preventDefault();
    this.table.zoomBy(Math.exp(-event.deltaY * (event.ctrlKey ? 0.01 : 0.0015)));
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === 'Enter') this.actions.click(this.element.clientWidth / 2, this.element.clientHeight / 2);
    else if (KEYS[event.key]) KEYS[event.key](this.table);
    else return;
    event.preventDefault();
  }
}
