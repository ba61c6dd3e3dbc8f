// SPDX-License-Identifier: MIT
// Two panels that show two surfaces and a map between them: a point of one under the pointer shows on the other.
import {ColorManagement, Mesh, Ray, Vector3} from 'three';
import {texture} from './colour_maps.js';
import {firstView} from './first_view.js';
import {LINKED_COLOURINGS, linkedGeometry, linkedMaterial, linkedUniforms} from './linked_surface.js';
import {MapPoints} from './map_point.js';
import {Painter} from './painter.js';
import {Panel} from './panel.js';
import {vertexPosition} from './scene_data.js';
import {StageInput, Turntable} from './turntable.js';

const POINT = '#ffffff';
const PLACES = ['a', 'b'];

ColorManagement.enabled = false;

/** Shows a linked scene in the stages `{a, b}`. Calls `onHover(point or null, place)`. */
export class LinkedView {
  constructor(scene, {canvas, stages, onHover}) {
    this.scene = scene;
    this.onHover = onHover;
    this.points = new MapPoints(scene);
    this.uniforms = linkedUniforms(scene, {area: texture(scene.scales.area.colours), energy: texture(scene.scales.energy.colours)});
    this.panels = Object.fromEntries(PLACES.map((place) => [place, this.makePanel(place, stages[place])]));
    this.painter = new Painter(canvas, Object.values(this.panels), (panel) => panel.placeLabels((at) => this.isHidden(panel, at)));
    // Both turn together, since they are placed alike.
    this.table = new Turntable(PLACES.map((place) => this.panels[place].place()), this.front());
    this.table.onChange = () => this.painter.draw();
    for (const place of PLACES) {
      this.showLandmarks(place);
      new StageInput(stages[place], this.table, {
        hover: (x, y) => this.hover(place, x, y),
        leave: () => this.showPoint(null, place),
        click: (x, y) => this.showPoint(this.pointAt(place, x, y), place),
      });
    }
  }

  makePanel(place, stage) {
    const positions = this.scene[place];
    let radius = 0;
    for (let i = 0; i < positions.length; i += 3) radius = Math.max(radius, Math.hypot(positions[i], positions[i + 1], positions[i + 2]));
    const capacity = {cones: this.scene.landmarks.length, marks: 0, copies: 1};
    const panel = new Panel(place, stage, {capacity, frame: {target: new Vector3(), radius: radius * 1.03}});
    panel.scene.add(new Mesh(linkedGeometry(this.scene, place), linkedMaterial(this.uniforms)));
    return panel;
  }

  // From where A shows most of itself and of its landmarks.
  front() {
    return firstView({normal: this.scene.normals.a, cones: this.scene.landmarks.map(({at}) => ({drawn: [at]}))});
  }

  showLandmarks(place) {
    const dots = this.scene.landmarks.map(({at, colour}, k) => ({at: vertexPosition(this.scene, place, at), colour, label: k + 1}));
    this.panels[place].cones.set(dots);
    this.panels[place].addLabels(dots);
  }

  pointAt(place, x, y) {
    return this.points.firstHit(place, this.panels[place].ray(x, y));
  }

  // Runs at most once a frame, however fast the pointer moves.
  hover(place, x, y) {
    const waiting = this.hovered !== undefined;
    this.hovered = {place, x, y};
    if (waiting) return;
    requestAnimationFrame(() => {
      const at = this.hovered;
      this.hovered = undefined;
      this.showPoint(this.pointAt(at.place, at.x, at.y), at.place);
    });
  }

  /** Shows a point in both panels; `place` is the one that was pointed at. */
  showPoint(point, place) {
    for (const each of PLACES) {
      const dots = point ? [{at: this.points.position(each, point)}] : [];
      this.panels[each].rim.set(dots.map((dot) => ({...dot, colour: this.scene.ink})));
      this.panels[each].point.set(dots.map((dot) => ({...dot, colour: POINT})));
    }
    this.point = point;
    this.onHover(point, place);
    this.painter.draw();
  }

  /** The input vertex of a surface that a point lies on, or the nearest one of its piece; -1 if the piece has none. */
  nearestVertex(place, {face, weights}) {
    const {fine: {indices}, vertices} = this.scene;
    let best = -1, largest = -1;
    for (let k = 0; k < 3; ++k) {
      const vertex = vertices[place][indices[3 * face + k]];
      if (vertex < 0 || weights.getComponent(k) <= largest) continue;
      best = vertex;
      largest = weights.getComponent(k);
    }
    return best;
  }

  setColouring(name) {
    this.uniforms.colouring.value = LINKED_COLOURINGS[name];
    this.painter.draw();
  }

  setSquares(count) {
    this.uniforms.squares.value = count;
    this.painter.draw();
  }

  reset() {
    this.table.reset();
  }

  // Behind another part of the surface.
  isHidden(panel, at) {
    const toEye = panel.camera.position.clone().sub(at), distance = toEye.length();
    const hit = this.points.firstHit(panel.name, new Ray(panel.camera.position.clone(), toEye.normalize().negate()));
    return hit !== null && hit.distance < distance - 0.02;
  }
}
