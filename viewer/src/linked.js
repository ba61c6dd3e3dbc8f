// SPDX-License-Identifier: MIT
// Starts the view of a map between two surfaces: connects controls, legend and readout with it.
import {showLegend} from './legend.js';
import {readLinkedScene} from './linked_scene.js';
import {LinkedView} from './linked_view.js';

const element = (id) => document.getElementById(id);

// A ratio, to about three digits.
const ratio = (log2) => Number((2 ** log2).toPrecision(3)).toString();

function showReadout(view, point) {
  if (!point) return;
  const {scene, points} = view;
  const near = ['a', 'b'].map((place) => [place.toUpperCase(), view.nearestVertex(place, point)]).filter(([, vertex]) => vertex >= 0);
  const where = near.length ? near.map(([name, vertex]) => `vertex ${vertex} of ${name}`).join(', ') : 'inside of triangles of both';
  element('readout').textContent = `Near ${where}: area ratio ${ratio(points.value(scene.area, point))}, ` +
    `symmetric Dirichlet energy ${Number(points.value(scene.energy, point).toPrecision(3))}`;
}

/** Shows the scene that the page holds. */
export function startLinked() {
  const scene = readLinkedScene(JSON.parse(element('linked-scene').textContent));
  element('view-body').hidden = false;
  const view = new LinkedView(scene, {
    canvas: element('canvas'),
    stages: {a: element('a'), b: element('b')},
    onHover: (point) => showReadout(view, point),
  });
  const control = (id, event, action) => {
    element(id).addEventListener(event, action);
    action();
  };
  control('colouring', 'change', () => {
    const colouring = element('colouring').value;
    element('squares-label').hidden = colouring !== 'checkerboard';
    showLegend(scene.scales[colouring], 'mean of the pieces around each vertex');
    view.setColouring(colouring);
  });
  control('squares', 'input', () => {
    element('squares-value').textContent = element('squares').value;
    view.setSquares(Number(element('squares').value));
  });
  element('reset').addEventListener('click', () => view.reset());
  element('view-notice').hidden = true;
  window.orbitutteView = view;  // for the console, and for the tests
}
