// SPDX-License-Identifier: MIT
// The three panels: what they show, and how they respond to the user.
import {
  BufferAttribute, BufferGeometry, Color, ColorManagement, InstancedMesh, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  MeshBasicMaterial, Quaternion, Ray, SphereGeometry, Vector3,
} from 'three';
import {texture} from './colour_maps.js';
import {firstView} from './first_view.js';
import {attributes, edgeIndices, meanLength, surfaceGeometry, thickLines, thinnedChains} from './geometry.js';
import {MapPoints} from './map_point.js';
import {outlineCopies} from './outline_copies.js';
import {Painter} from './painter.js';
import {Panel} from './panel.js';
import {tileFrame, vertexPosition} from './scene_data.js';
import {COLOURINGS, sharedUniforms, surfaceMaterial} from './surface.js';
import {StageInput, Turntable} from './turntable.js';

// Only the view has marks and points; all other colours come with the scene.
const MARK = '#d6006c', POINT = '#ffffff', FAINT = '#9aa4af';
const OUTLINE_STEP = 0.004;  // in units of the sphere's radius; below a pixel

ColorManagement.enabled = false;

/** Shows a scene in the stages `{source, tile, tiling}`. Calls `onHover(point or null)` and `onPick(drawn vertex)`. */
export class View {
  constructor(scene, {canvas, stages, onHover, onPick}) {
    this.scene = scene;
    this.events = {onHover, onPick};
    this.points = new MapPoints(scene);
    this.front = firstView(scene);
    this.frame = {...tileFrame(scene), sourceLight: new Vector3(-0.35, 0.55, 0.8).normalize().applyQuaternion(this.front)};
    const maps = {area: texture(scene.scales.area.colours), angle: texture(scene.scales.angle.colours)};
    this.uniforms = sharedUniforms(this.frame, maps, scene.scales);
    this.makePanels(stages);
    this.painter = new Painter(canvas, Object.values(this.panels), (panel) => panel.placeLabels((at) => this.isHidden(panel, at)));
    this.makeTables();
    this.fillPanels();
    this.showCones();
    this.listen(stages);
  }

  makePanels(stages) {
    const {cones, copies, source} = this.scene;
    const drawn = cones.reduce((sum, {drawn}) => sum + drawn.length, 0);
    let radius = 0;
    for (let i = 0; i < source.length; i += 3) radius = Math.max(radius, Math.hypot(source[i], source[i + 1], source[i + 2]));
    const frames = {
      source: {target: new Vector3(), radius: radius * 1.03},
      tile: {target: this.frame.middle, radius: this.frame.radius * 1.08},
      tiling: {target: new Vector3(), radius: 1.04},
    };
    const many = {cones: drawn * copies.length, marks: 64 * copies.length, copies: copies.length};
    const few = {cones: drawn, marks: 256, copies: 2};
    this.panels = Object.fromEntries(Object.entries(stages).map(([name, stage]) =>
      [name, new Panel(name, stage, {capacity: name === 'tiling' ? many : few, frame: frames[name]})]));
  }

  // The source turns by itself. Tile and tiled sphere turn together; at first they show the tile in front.
  makeTables() {
    const {source, tile, tiling} = this.panels;
    const front = new Quaternion().setFromRotationMatrix(
      new Matrix4().makeBasis(this.frame.east, this.frame.north, this.frame.centre));
    const sphere = new Turntable([tile.place(), tiling.place()], front);
    this.tables = {source: new Turntable([source.place()], this.front), tile: sphere, tiling: sphere};
    this.tables.source.onChange = () => this.draw([source]);
    sphere.onChange = () => this.draw([tile, tiling]);
  }

  fillPanels() {
    const {scene, uniforms} = this, shared = attributes(scene);
    const tint = new Color(scene.tile);
    const surface = (panel, position, level) => {
      const material = surfaceMaterial(uniforms, {onSphere: position === 'image', tint});
      panel.scene.add(new Mesh(surfaceGeometry(shared, position, level.indices), material));
      panel.scene.add(thickLines(scene[position], level.outline, {width: panel.name === 'tiling' ? 3 : 2, colour: scene.ink}));
    };
    surface(this.panels.source, 'source', scene.fine);
    surface(this.panels.tile, 'image', scene.fine);
    surface(this.panels.tiling, 'image', scene.coarse);
    this.shared = shared;
    this.copyOutline = thinnedChains(scene.image, scene.coarse.outline, OUTLINE_STEP);
    this.addCopies();
    this.addNeighbours();
  }

  // The outlines of all copies except the tile itself.
  outlines(panel, colour) {
    const matrices = this.scene.copies.slice(1).map(({matrix}) => matrix);
    return outlineCopies(panel, {positions: this.scene.image, ends: this.copyOutline, matrices, width: 1.4, colour});
  }

  // Adds the outlines of the other copies around the tile, and a ball without colour that hides those behind it.
  addNeighbours() {
    const lines = this.outlines(this.panels.tile, FAINT);
    lines.scale.setScalar(0.998);  // behind the tile's own outline
    const ball = new Mesh(new SphereGeometry(0.96, 96, 64), new MeshBasicMaterial({colorWrite: false}));
    ball.renderOrder = -1;
    this.panels.tile.scene.add(lines, ball);
  }

  addCopies() {
    const others = this.scene.copies.slice(1);
    if (others.length === 0) return;
    this.copyMaterial = surfaceMaterial(this.uniforms, {onSphere: true, tint: new Color()});
    const copies = new InstancedMesh(surfaceGeometry(this.shared, 'image', this.scene.coarse.indices), this.copyMaterial, others.length);
    others.forEach(({matrix, colour}, i) => {
      copies.setMatrixAt(i, matrix);
      copies.setColorAt(i, new Color(colour));
    });
    copies.frustumCulled = false;
    this.copyLines = this.outlines(this.panels.tiling, this.scene.ink);
    this.panels.tiling.scene.add(copies, this.copyLines);
  }

  showCones() {
    const dots = {source: [], tile: []};
    for (const {order, colour, drawn} of this.scene.cones) {
      if (drawn.length > 0) dots.source.push({at: vertexPosition(this.scene, 'source', drawn[0]), colour, label: order});
      for (const vertex of drawn) dots.tile.push({at: vertexPosition(this.scene, 'image', vertex), colour, label: order});
    }
    this.panels.source.cones.set(dots.source);
    this.panels.tile.cones.set(dots.tile);
    this.panels.tiling.cones.set(this.copied(dots.tile).map((dot) => ({...dot, scale: 0.8})));
    this.panels.source.addLabels(dots.source);
    this.panels.tile.addLabels(dots.tile);
  }

  /** Copies every dot to all copies of the tile. */
  copied(dots) {
    return this.scene.copies.flatMap(({matrix}, copy) =>
      dots.map((dot) => ({...dot, at: dot.at.clone().applyMatrix4(matrix), copy})));
  }

  listen(stages) {
    for (const [name, stage] of Object.entries(stages)) {
      new StageInput(stage, this.tables[name], {
        hover: (x, y) => this.hover(name, x, y),
        leave: () => this.showPoint(null),
        click: (x, y) => this.click(name, x, y),
      });
    }
  }

  pointAt(name, x, y) {
    const ray = this.panels[name].ray(x, y);
    if (name === 'source') return this.points.onSource(ray);
    return name === 'tile' ? this.points.onTile(ray) : this.points.onSphere(ray);
  }

  // Runs at most once a frame, however fast the pointer moves.
  hover(name, x, y) {
    const waiting = this.hovered !== undefined;
    this.hovered = {name, x, y};
    if (waiting) return;
    requestAnimationFrame(() => {
      const place = this.hovered;
      this.hovered = undefined;
      this.showPoint(this.pointAt(place.name, place.x, place.y));
    });
  }

  click(name, x, y) {
    const point = this.pointAt(name, x, y);
    this.showPoint(point);
    if (point) this.events.onPick(this.points.nearestVertex(point));
  }

  /** Shows a point in all panels, brighter in the copy that was pointed at. */
  showPoint(point) {
    const on = (dots, colour) => dots.map((dot) => ({...dot, colour}));
    const source = point ? [{at: this.points.position('source', point)}] : [];
    const tile = point ? [{at: this.points.position('image', point)}] : [];
    const all = this.copied(tile).map((dot) => ({...dot, scale: dot.copy === point.copy ? 1 : 0.5}));
    for (const [panel, dots] of [[this.panels.source, source], [this.panels.tile, tile], [this.panels.tiling, all]]) {
      panel.rim.set(on(dots, this.scene.ink));
      panel.point.set(on(dots, POINT));
    }
    this.point = point;
    this.events.onHover(point);
    this.draw();
  }

  /** Shows marked vertices, given by their drawn vertices. */
  showMarks(vertices) {
    const dots = (name) => vertices.map((vertex) => ({at: vertexPosition(this.scene, name, vertex), colour: MARK}));
    this.panels.source.marks.set(dots('source'));
    this.panels.tile.marks.set(dots('image'));
    this.panels.tiling.marks.set(this.copied(dots('image')));
    this.draw();
  }

  setColouring(name) {
    this.uniforms.colouring.value = COLOURINGS[name];
    this.draw();
  }

  setSquares(count) {
    this.uniforms.squares.value = count / this.frame.radius;
    this.draw();
  }

  setRelief(share) {
    this.uniforms.relief.value = share;
    this.draw();
  }

  /** Sets the opacity of the copies, except the tile itself. */
  setOpacity(opacity) {
    if (!this.copyMaterial) return;
    this.copyMaterial.uniforms.opacity.value = opacity;
    this.copyMaterial.transparent = opacity < 1;
    this.copyMaterial.needsUpdate = true;
    this.copyLines.visible = opacity > 0;
    this.draw();
  }

  showEdges(shown) {
    if (shown && !this.edges) this.makeEdges();
    for (const lines of this.edges ?? []) lines.visible = shown;
    this.draw();
  }

  makeEdges() {
    const index = new BufferAttribute(edgeIndices(this.scene.fine.indices), 1);
    this.edges = [['source', 'source'], ['tile', 'image']].map(([panel, position]) => {
      const lines = new BufferGeometry();
      lines.setAttribute('position', this.shared[position]);
      lines.setIndex(index);
      const segments = new LineSegments(lines, new LineBasicMaterial({color: new Color(this.scene.ink), transparent: true}));
      const length = meanLength(this.scene[position], index.array);
      // Fades the edges where they are dense, since they would hide all colours.
      segments.onBeforeRender = () => {
        segments.material.opacity = 0.35 * Math.min(Math.max(this.panels[panel].pixels(length) / 5, 0.1), 1);
      };
      this.panels[panel].scene.add(segments);
      return segments;
    });
  }

  reset() {
    for (const table of new Set(Object.values(this.tables))) table.reset();
  }

  draw(panels) {
    this.painter.draw(panels);
  }

  // On the sphere, a place is hidden behind the horizon; on the source, behind another part of it.
  isHidden(panel, at) {
    const toEye = panel.camera.position.clone().sub(at);
    if (panel.name !== 'source') return toEye.dot(at) < 0;
    const distance = toEye.length();
    const hit = this.points.onSource(new Ray(panel.camera.position.clone(), toEye.normalize().negate()));
    return hit !== null && hit.distance < distance - 0.02;
  }
}
