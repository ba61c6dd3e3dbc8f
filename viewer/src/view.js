// SPDX-License-Identifier: MIT
// The three panels, drawn by one renderer into one canvas that lies behind them.
import {
  BufferAttribute, BufferGeometry, Color, ColorManagement, InstancedMesh, LineBasicMaterial, LineSegments, LinearSRGBColorSpace,
  Matrix4, Mesh, MeshBasicMaterial, Quaternion, Ray, SphereGeometry, Vector2, Vector3, WebGLRenderer,
} from 'three';
import {angleMap, areaMap, robustBound} from './colour_maps.js';
import {firstView} from './first_view.js';
import {attributes, edgeIndices, surfaceGeometry, thickLines} from './geometry.js';
import {MapPoints} from './map_point.js';
import {Panel} from './panel.js';
import {tileFrame, vertexPosition} from './scene_data.js';
import {COLOURINGS, sharedUniforms, surfaceMaterial} from './surface.js';
import {StageInput, Turntable} from './turntable.js';

const INK = '#20262d', MARK = '#d6006c', POINT = '#ffffff', FAINT = '#9aa4af';
const CONE_COLOURS = {2: '#0072b2', 3: '#d55e00', 4: '#009e73', 5: '#7b2d8b'};
const coneColour = (order) => CONE_COLOURS[order] ?? '#5b4636';

ColorManagement.enabled = false;

/** Shows a scene in the stages `{source, tile, tiling}`. Tells `onHover(point or null)` and `onPick(drawn vertex)`. */
export class View {
  constructor(scene, {canvas, stages, onHover, onPick}) {
    this.scene = scene;
    this.canvas = canvas;
    this.events = {onHover, onPick};
    this.points = new MapPoints(scene);
    this.front = firstView(scene);
    this.frame = {...tileFrame(scene), sourceLight: new Vector3(-0.35, 0.55, 0.8).normalize().applyQuaternion(this.front)};
    this.renderer = new WebGLRenderer({canvas, antialias: true, alpha: true});
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.autoClear = false;
    this.renderer.setClearColor(0x000000, 0);
    this.bounds = {
      area: robustBound(scene.area, {share: 0.1, among: [1, 2, 3, 4, 5, 6, 8]}),
      angle: robustBound(scene.angle, {share: 0.02, among: [1.2, 1.5, 2, 3, 4, 6, 8].map(Math.log2)}),
    };
    const maps = {area: areaMap.texture(), angle: angleMap.texture()};
    this.uniforms = sharedUniforms(this.frame, maps, this.bounds);
    this.makePanels(stages);
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
    this.list = Object.values(this.panels);
    this.makeTables();
  }

  // The source turns by itself; tile and tiled sphere turn together, at first with the tile in front.
  makeTables() {
    const {source, tile, tiling} = this.panels;
    const front = new Quaternion().setFromRotationMatrix(
      new Matrix4().makeBasis(this.frame.east, this.frame.north, this.frame.centre));
    const sphere = new Turntable([tile.place(), tiling.place()], front);
    this.tables = {source: new Turntable([source.place()], this.front), tile: sphere, tiling: sphere};
    for (const table of Object.values(this.tables)) table.onChange = () => this.draw();
  }

  fillPanels() {
    const {scene, uniforms} = this, shared = attributes(scene);
    const tint = new Color(scene.copies[0].colour);
    const surface = (panel, position, level) => {
      const material = surfaceMaterial(uniforms, {onSphere: position === 'image', tint});
      panel.scene.add(new Mesh(surfaceGeometry(shared, position, level.indices), material));
      panel.scene.add(thickLines(scene[position], level.outline, {matrices: [new Matrix4()], width: panel.name === 'tiling' ? 3 : 2, colour: INK}));
    };
    surface(this.panels.source, 'source', scene.fine);
    surface(this.panels.tile, 'image', scene.fine);
    surface(this.panels.tiling, 'image', scene.coarse);
    this.shared = shared;
    this.addCopies();
    this.addNeighbours();
  }

  // Around the tile, the outlines of the other copies; a ball without colour hides those behind it.
  addNeighbours() {
    const others = this.scene.copies.slice(1).map(({matrix}) => matrix);
    const lines = thickLines(this.scene.image, this.scene.coarse.outline, {matrices: others, width: 1, colour: FAINT});
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
    const matrices = others.map(({matrix}) => matrix);
    this.copyLines = thickLines(this.scene.image, this.scene.coarse.outline, {matrices, width: 1, colour: INK});
    this.panels.tiling.scene.add(copies, this.copyLines);
  }

  showCones() {
    const dots = {source: [], tile: []};
    for (const {order, drawn} of this.scene.cones) {
      const colour = coneColour(order);
      if (drawn.length > 0) dots.source.push({at: vertexPosition(this.scene, 'source', drawn[0]), colour, label: order});
      for (const vertex of drawn) dots.tile.push({at: vertexPosition(this.scene, 'image', vertex), colour, label: order});
    }
    this.panels.source.cones.set(dots.source);
    this.panels.tile.cones.set(dots.tile);
    this.panels.tiling.cones.set(this.copied(dots.tile).map((dot) => ({...dot, scale: 0.8})));
    this.addLabels(this.panels.source, dots.source);
    this.addLabels(this.panels.tile, dots.tile);
  }

  addLabels(panel, dots) {
    panel.labels = dots.map(({at, label}) => {
      const element = document.createElement('span');
      element.className = 'cone-label';
      element.textContent = label;
      panel.stage.append(element);
      return {at, element};
    });
  }

  /** Every dot in all copies of the tile. */
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
    new ResizeObserver(() => this.draw()).observe(this.canvas.parentElement);
  }

  pointAt(name, x, y) {
    const ray = this.panels[name].ray(x, y);
    if (name === 'source') return this.points.onSource(ray);
    return name === 'tile' ? this.points.onTile(ray) : this.points.onSphere(ray);
  }

  // At most once a frame, however fast the pointer moves.
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

  /** Shows a point in all panels; brighter in the copy that was pointed at. */
  showPoint(point) {
    const on = (dots, colour) => dots.map((dot) => ({...dot, colour}));
    const source = point ? [{at: this.points.position('source', point)}] : [];
    const tile = point ? [{at: this.points.position('image', point)}] : [];
    const all = this.copied(tile).map((dot) => ({...dot, scale: dot.copy === point.copy ? 1 : 0.5}));
    for (const [panel, dots] of [[this.panels.source, source], [this.panels.tile, tile], [this.panels.tiling, all]]) {
      panel.rim.set(on(dots, INK));
      panel.point.set(on(dots, POINT));
    }
    this.point = point;
    this.events.onHover(point);
    this.draw();
  }

  /** Shows marked vertices, given as drawn ones. */
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

  /** How opaque the copies are, besides the tile itself. */
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
    const material = new LineBasicMaterial({color: new Color(INK), transparent: true, opacity: 0.35});
    const index = new BufferAttribute(edgeIndices(this.scene.fine.indices), 1);
    this.edges = [['source', 'source'], ['tile', 'image']].map(([panel, position]) => {
      const lines = new BufferGeometry();
      lines.setAttribute('position', this.shared[position]);
      lines.setIndex(index);
      const segments = new LineSegments(lines, material);
      this.panels[panel].scene.add(segments);
      return segments;
    });
  }

  reset() {
    for (const table of new Set(Object.values(this.tables))) table.reset();
  }

  /** Draws before the next repaint. */
  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.drawNow();
    });
  }

  drawNow() {
    const box = this.canvas.parentElement.getBoundingClientRect();
    this.fitCanvas(box);
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    this.renderer.setScissorTest(true);
    for (const panel of this.list) this.drawPanel(panel, box);
  }

  fitCanvas({width, height}) {
    const ratio = Math.min(window.devicePixelRatio || 1, 2), size = this.renderer.getSize(new Vector2());
    if (size.x === width && size.y === height && this.renderer.getPixelRatio() === ratio) return;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
  }

  drawPanel(panel, box) {
    const stage = panel.stage.getBoundingClientRect();
    const place = [stage.left - box.left, box.bottom - stage.bottom, stage.width, stage.height];
    panel.resize(stage.width / stage.height);
    for (const dots of panel.dots()) dots.fit(panel.camera);
    this.renderer.setViewport(...place);
    this.renderer.setScissor(...place);
    this.renderer.render(panel.scene, panel.camera);
    for (const label of panel.labels) this.placeLabel(panel, label);
  }

  placeLabel(panel, {at, element}) {
    const {x, y} = panel.project(at);
    element.style.transform = `translate(${x + 9}px, ${y - 22}px)`;
    element.hidden = this.isHidden(panel, at);
  }

  // On the sphere, behind the horizon; in the source, behind another part of it.
  isHidden(panel, at) {
    const toEye = panel.camera.position.clone().sub(at);
    if (panel.name !== 'source') return toEye.dot(at) < 0;
    const distance = toEye.length();
    const hit = this.points.onSource(new Ray(panel.camera.position.clone(), toEye.normalize().negate()));
    return hit !== null && hit.distance < distance - 0.02;
  }
}
