// SPDX-License-Identifier: MIT
// Starts the page's view, that of a map between surfaces if it holds one: reads the scene, and connects controls, legend and readout with the view.
import {showLegend} from './legend.js';
import {startLinked} from './linked.js';
import {Marks} from './marks.js';
import {readScene} from './scene_data.js';
import {View} from './view.js';

const element = (id) => document.getElementById(id);
const grouped = (count) => count.toLocaleString('en');

// A ratio, to about three digits: 0.52, 1.07, 312.
const ratio = (log2) => Number((2 ** log2).toPrecision(3)).toString();

// ", thickness 2.41", or the name of a label; nothing where there is no value.
function valueText({values}, drawn) {
  const number = values?.numbers[drawn];
  if (!Number.isFinite(number)) return '';
  return `, ${values.name} ${values.labels ? values.labels.get(number) ?? 'none' : Number(number.toPrecision(4))}`;
}

function showReadout(view, point) {
  if (!point) return;
  const {scene, points} = view;
  const drawn = points.nearestVertex(point), vertex = scene.sourceVertex[drawn];
  const copy = scene.copies.length > 1 ? `, copy ${point.copy + 1} of ${scene.copies.length}` : '';
  element('readout').textContent = `Vertex ${vertex}: area ratio ${ratio(points.value(scene.area, point))}, ` +
    `angle distortion ${ratio(points.value(scene.angle, point))}${valueText(scene, drawn)}${copy}`;
}

function connectControls(view) {
  const control = (id, event, action) => {
    element(id).addEventListener(event, action);
    action();
  };
  control('colouring', 'change', () => {
    const colouring = element('colouring').value;
    element('squares-label').hidden = colouring !== 'checkerboard';
    showLegend(view.scene.scales[colouring], colouring === 'vertex' ? 'values beyond an end have its colour' : 'mean of the faces around each vertex');
    view.setColouring(colouring);
  });
  control('squares', 'input', () => {
    element('squares-value').textContent = element('squares').value;
    view.setSquares(Number(element('squares').value));
  });
  control('opacity', 'input', () => {
    element('opacity-value').textContent = `${element('opacity').value}%`;
    view.setOpacity(Number(element('opacity').value) / 100);
  });
  control('relief', 'change', () => view.setRelief(element('relief').checked ? 1 : 0));
  control('edges', 'change', () => view.showEdges(element('edges').checked));
  element('reset').addEventListener('click', () => view.reset());
}

// Tells the user which part of the mesh is not drawn.
function sayHowMuchIsDrawn({faces, shownFaces, copyFaces}) {
  const sentences = [];
  if (shownFaces < faces) sentences.push(`Source and tile are drawn with ${grouped(shownFaces)} of ${grouped(faces)} triangles; their vertices are exact, and only these can be marked by clicking.`);
  if (copyFaces < faces) sentences.push(`On the tiled sphere every copy is drawn with ${grouped(copyFaces)} of ${grouped(faces)} triangles.`);
  element('decimated').textContent = sentences.join(' ');
  element('decimated').hidden = sentences.length === 0;
}

function start() {
  const scene = readScene(JSON.parse(element('scene').textContent));
  let marks = null;
  element('view-body').hidden = false;
  // A page of values opens with them.
  const {values} = scene;
  if (scene.colour) element('colouring').append(new Option(values?.name ?? 'Vertex colours', 'vertex', Boolean(values), Boolean(values)));
  const view = new View(scene, {
    canvas: element('canvas'),
    stages: {source: element('source'), tile: element('tile'), tiling: element('tiling')},
    onHover: (point) => showReadout(view, point),
    onPick: (vertex) => marks.toggle(vertex),
  });
  marks = new Marks(scene, {
    form: element('add-form'), number: element('add-vertex'), line: element('cones'),
    copy: element('copy'), clear: element('clear'), message: element('copied'),
  }, (vertices) => view.showMarks(vertices));
  connectControls(view);
  sayHowMuchIsDrawn(scene);
  element('view-notice').hidden = true;
  if (element('pictures')) element('pictures').hidden = true;
  window.orbitutteView = view;  // for the console, and for the tests
}

function isSupported() {
  return Boolean(document.createElement('canvas').getContext('webgl2'));
}

if (isSupported()) (element('linked-scene') ? startLinked : start)();
