// SPDX-License-Identifier: MIT
// The page of a map between two surfaces in a browser, from disk, without network. The environment's ORBITUTTE names the program
// under test.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {after, before, test} from 'node:test';
import {Browser, drawn, pixels} from './browser.js';
import {Workshop} from './workshop.js';

const PANELS = ['a', 'b'];
const LANDMARKS = '0:0,120:120,260:260,400:400';

let workshop, browser, page;

// The second surface is the first, stretched.
before(async () => {
  workshop = new Workshop(process.env.ORBITUTTE);
  const meshes = workshop.makePair('pair');
  page = workshop.path('pair.html');
  workshop.run('map', ...meshes, '--landmarks', LANDMARKS, '-o', workshop.path('map'), '--page', page, '--quiet');
  browser = await Browser.open();
});

after(async () => {
  await browser?.close();
  workshop?.close();
});

async function withPage(body, options) {
  const {page: opened, faults} = await browser.visit(page, options);
  await body(opened);
  assert.deepEqual(faults, []);
  await opened.close();
}

// Vertices of A that panel A shows in front, away from the rim, and where; and where their overlay vertices are on B.
const visibleVertices = (opened) => opened.evaluate(() => {
  const view = window.orbitutteView, {scene, panels} = view, element = document.getElementById('a');
  element.scrollIntoView({block: 'center', behavior: 'instant'});
  const stage = element.getBoundingClientRect(), found = [];
  for (let v = 0; v < scene.vertices.a.length; ++v) {
    if (scene.vertices.a[v] < 0) continue;
    const at = panels.a.camera.position.clone().fromArray(scene.a, 3 * v);
    const normal = at.clone().fromArray(scene.normals.a, 3 * v).normalize();
    const facing = normal.dot(panels.a.camera.position.clone().sub(at).normalize());
    if (facing < 0.9 || view.isHidden(panels.a, at)) continue;
    const {x, y} = panels.a.project(at);
    found.push({vertex: scene.vertices.a[v], x: stage.left + x, y: stage.top + y});
  }
  return found;
});

// The vertices of an OBJ, and where each vertex of A lies on B, as orbitutte map says.
const positionsIn = (file) => readFileSync(file, 'utf8').split('\n').filter((line) => line.startsWith('v ')).map((line) => line.split(' ').slice(1, 4).map(Number));
const facesIn = (file) => readFileSync(file, 'utf8').split('\n').filter((line) => line.startsWith('f ')).map((line) => line.split(' ').slice(1, 4).map((word) => parseInt(word, 10) - 1));
function imagesOnB() {
  const V = positionsIn(workshop.path('pair_b.obj')), F = facesIn(workshop.path('pair_b.obj'));
  return readFileSync(workshop.path('map/a_to_b.txt'), 'utf8').trim().split('\n').map((line) => {
    const [face, ...weights] = line.split(' ').map(Number);
    return [0, 1, 2].map((axis) => weights.reduce((sum, weight, k) => sum + weight * V[F[face][k]][axis], 0));
  });
}

test('both panels draw, with every colouring, and no two colourings alike', () => withPage(async (opened) => {
  const colourings = await opened.$$eval('#colouring option', (options) => options.map(({value}) => value));
  const seen = Object.fromEntries(PANELS.map((panel) => [panel, new Set()]));
  for (const colouring of colourings) {
    await opened.selectOption('#colouring', colouring);
    for (const panel of PANELS) {
      const {colours, sum} = await pixels(opened, panel);
      assert.ok(colours > 50, `${panel}, ${colouring}: ${colours} colours`);
      seen[panel].add(sum);
    }
  }
  for (const panel of PANELS) assert.equal(seen[panel].size, colourings.length, panel);
}));

test('a point under the pointer on A shows on B where the map takes it', () => withPage(async (opened) => {
  const visible = await visibleVertices(opened), images = imagesOnB();
  assert.ok(visible.length > 10);
  const box = await opened.evaluate(() => JSON.parse(document.getElementById('linked-scene').textContent).b_box);
  for (const {vertex, x, y} of visible.slice(0, 40)) {
    await opened.mouse.move(x, y);
    await drawn(opened);
    const [shown] = await opened.evaluate(() => window.orbitutteView.panels.b.point.dots.map(({at}) => at.toArray()));
    assert.ok(shown, `nothing is shown for vertex ${vertex}`);
    // The view's frame: the longest edge of B's box is 2, its middle 0.
    const middle = await opened.evaluate(() => {
      const {b} = window.orbitutteView.scene, ends = [0, 1, 2].map((axis) => [Infinity, -Infinity]);
      for (let i = 0; i < b.length; ++i) ends[i % 3] = [Math.min(ends[i % 3][0], b[i]), Math.max(ends[i % 3][1], b[i])];
      return ends.map(([low]) => low);
    });
    const here = shown.map((value, axis) => box[axis] + ((value - middle[axis]) / 2) * box[3]);
    const off = Math.hypot(...here.map((value, axis) => value - images[vertex][axis]));
    assert.ok(off < 0.03 * box[3], `vertex ${vertex} is ${off} off, of ${box[3]}`);
  }
}));

test('hovering on B shows the point on A, and leaving hides both', () => withPage(async (opened) => {
  await opened.locator('#b').hover();
  await drawn(opened);
  const counts = () => opened.evaluate(() => ['a', 'b'].map((panel) => window.orbitutteView.panels[panel].point.dots.length));
  assert.deepEqual(await counts(), [1, 1]);
  assert.match(await opened.textContent('#readout'), /area ratio [0-9.]+, symmetric Dirichlet energy [0-9.]+/);
  await opened.mouse.move(2, 2);
  await drawn(opened);
  assert.deepEqual(await counts(), [0, 0]);
}));

test('landmarks are partners, in both panels', () => withPage(async (opened) => {
  const found = await opened.evaluate(() => {
    const {scene} = window.orbitutteView;
    return scene.landmarks.map(({a, b, at}) => [a, b, scene.vertices.a[at], scene.vertices.b[at]]);
  });
  assert.equal(found.length, LANDMARKS.split(',').length);
  for (const [a, b, onA, onB] of found) assert.deepEqual([a, b], [onA, onB]);
  assert.equal(await opened.locator('.cone-label').count(), 2 * found.length);
}));

test('on a phone nothing is wider than the screen', () => withPage(async (opened) => {
  const [wide, screen] = await opened.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
  assert.ok(wide <= screen, `${wide} of ${screen} pixels`);
}, {viewport: {width: 360, height: 640}}));

test('keys turn both surfaces, and reset them', () => withPage(async (opened) => {
  const start = {a: await pixels(opened, 'a'), b: await pixels(opened, 'b')};
  await opened.focus('#a');
  await opened.keyboard.press('ArrowRight');
  for (const panel of PANELS) assert.notEqual((await pixels(opened, panel)).sum, start[panel].sum, panel);
  await opened.click('#reset');
  for (const panel of PANELS) assert.equal((await pixels(opened, panel)).sum, start[panel].sum, panel);
}));
