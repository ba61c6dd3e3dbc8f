// SPDX-License-Identifier: MIT
// The page in a browser, as a reader has it: from disk, without network. The environment's ORBITUTTE names the program under test.
import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {after, before, test} from 'node:test';
import {Browser, drawn, pixelAt, pixels, placeOf} from './browser.js';
import {Workshop} from './workshop.js';

const PANELS = ['source', 'tile', 'tiling'];
const HOSTILE = `x'"><img src=x onerror=alert(1)></script><script>alert(2)</script>`;

let workshop, browser, figure;

before(async () => {
  workshop = new Workshop(process.env.ORBITUTTE);
  figure = workshop.makePage('figure');
  browser = await Browser.open();
});

after(async () => {
  await browser?.close();
  workshop?.close();
});

async function withPage(file, body, options) {
  const {page, faults} = await browser.visit(file, options);
  await body(page);
  assert.deepEqual(faults, []);
  await page.close();
}

const conesLine = (page) => page.textContent('#cones');
const dotsShown = (page, kind) => page.evaluate(([panels, dots]) =>
  panels.map((name) => window.orbitutteView.panels[name][dots].dots.length), [PANELS, kind]);

// An input vertex that the source shows in front, away from the rim of the panel.
const visibleVertex = (page) => page.evaluate(() => {
  const {scene, panels} = window.orbitutteView, view = window.orbitutteView;
  for (let vertex = 100; vertex < scene.sourceVertex.length; ++vertex) {
    const at = panels.source.camera.position.clone().fromArray(scene.source, 3 * vertex);
    const normal = at.clone().fromArray(scene.normal, 3 * vertex).normalize();
    const facing = normal.dot(panels.source.camera.position.clone().sub(at).normalize());
    if (facing > 0.9 && !view.isHidden(panels.source, at)) return scene.sourceVertex[vertex];
  }
  return -1;
});

test('every panel draws, with every colouring, and no two colourings alike', () => withPage(figure.page, async (page) => {
  const seen = Object.fromEntries(PANELS.map((panel) => [panel, new Set()]));
  const colourings = await page.$$eval('#colouring option', (options) => options.map(({value}) => value));
  for (const colouring of colourings) {
    await page.selectOption('#colouring', colouring);
    for (const panel of PANELS) {
      const {colours, sum} = await pixels(page, panel);
      assert.ok(colours > 50, `${panel}, ${colouring}: ${colours} colours`);
      seen[panel].add(sum);
    }
  }
  for (const panel of PANELS) assert.equal(seen[panel].size, colourings.length, panel);
}));

test('vertex colours are offered where the mesh has them, and shown as they are in all panels', async () => {
  const {page: file} = workshop.makePage('coloured', {faces: 500, coloured: true});
  await withPage(file, async (page) => {
    await page.selectOption('#colouring', 'vertex');
    const vertex = await visibleVertex(page);
    const [expected, places] = await page.evaluate((wanted) => {
      const {scene, panels} = window.orbitutteView, drawn = scene.sourceVertex.indexOf(wanted);
      const project = (name, numbers) => panels[name].project(panels[name].camera.position.clone().fromArray(numbers, 3 * drawn));
      return [[...scene.colour.slice(3 * drawn, 3 * drawn + 3)], {source: project('source', scene.source), tile: project('tile', scene.image)}];
    }, vertex);
    const line = readFileSync(workshop.path('coloured.obj'), 'utf8').split('\n').filter((row) => row.startsWith('v '))[vertex];
    assert.deepEqual(expected, line.split(' ').slice(4).map((channel) => Math.round(255 * channel)));
    for (const [panel, place] of Object.entries(places)) {
      const seen = await pixelAt(page, panel, place), light = Math.max(...seen) / Math.max(...expected);
      seen.forEach((channel, k) => assert.ok(Math.abs(channel - light * expected[k]) < 24, `${panel}: ${seen}, not as ${expected}`));
    }
    assert.ok((await pixels(page, 'tiling')).colours > 200);
  });
  await withPage(figure.page, async (page) => assert.equal(await page.locator('#colouring option[value=vertex]').count(), 0));
});

test('a page of values opens with them, their scale, and the value under the pointer', async () => {
  const name = 'sub-01_space-fsaverage_hemisphere-left_desc-smoothed_height.txt', values = workshop.path(name);
  workshop.embed('valued', {faces: 500});
  const heights = readFileSync(workshop.path('valued.obj'), 'utf8').split('\n').filter((row) => row.startsWith('v ')).map((row) => Number(row.split(' ')[2]));
  writeFileSync(values, heights.map((height) => `${height}\n`).join(''));
  const {page: file} = workshop.makePage('valued', {faces: 500, options: ['--values', values]});
  await withPage(file, async (page) => {
    assert.equal(await page.inputValue('#colouring'), 'vertex');
    assert.equal(await page.textContent('#colouring option:checked'), name);
    assert.equal(await page.isVisible('#legend'), true);
    assert.ok((await page.textContent('#legend-title')).startsWith(name));
    const opened = await pixels(page, 'source');
    await page.selectOption('#colouring', 'tile');
    assert.notEqual((await pixels(page, 'source')).sum, opened.sum);
    const vertex = await visibleVertex(page), place = await placeOf(page, 'source', vertex);
    await page.mouse.move(place.x, place.y);
    await drawn(page);
    const value = Number((await page.textContent('#readout')).match(/_height.txt (-?[0-9.e-]+)/)[1]);
    assert.ok(Math.abs(value - heights[vertex]) < 1e-3 * Math.max(...heights.map(Math.abs)), `${value}, not ${heights[vertex]}`);
  });
  await withPage(file, async (page) => assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390), {viewport: {width: 390, height: 844}});
  await withPage(figure.page, async (page) => assert.equal(await page.inputValue('#colouring'), 'tile'));
});

test('a click on a vertex marks it in all panels and names it in the --cones line', () => withPage(figure.page, async (page) => {
  const vertex = await visibleVertex(page), place = await placeOf(page, 'source', vertex);
  await page.mouse.click(place.x, place.y);
  assert.equal(await conesLine(page), `--cones ${vertex}`);
  assert.deepEqual(await dotsShown(page, 'marks'), [1, 1, 24]);
  await page.mouse.click(place.x, place.y);
  assert.equal(await conesLine(page), '--cones');
}));

test('the same vertex is picked in the tile and on the tiled sphere', () => withPage(figure.page, async (page) => {
  for (const panel of ['tile', 'tiling']) {
    const vertex = await page.evaluate((name) => {
      const view = window.orbitutteView, box = document.getElementById(name);
      return view.scene.sourceVertex[view.points.nearestVertex(view.pointAt(name, box.clientWidth / 2, box.clientHeight / 2))];
    }, panel);
    const place = await placeOf(page, panel, vertex);
    await page.mouse.click(place.x, place.y);
    assert.equal(await conesLine(page), `--cones ${vertex}`);
    await page.click('#clear');
  }
}));

test('a point under the pointer shows in the other panels and in the readout', () => withPage(figure.page, async (page) => {
  const vertex = await visibleVertex(page), place = await placeOf(page, 'source', vertex);
  await page.mouse.move(place.x, place.y);
  await drawn(page);
  assert.deepEqual(await dotsShown(page, 'point'), [1, 1, 24]);
  assert.match(await page.textContent('#readout'), new RegExp(`^Vertex ${vertex}: area ratio [0-9.e-]+, angle distortion [0-9.]+`));
  const [shown, expected] = await page.evaluate((wanted) => {
    const {scene, panels} = window.orbitutteView, at = 3 * scene.sourceVertex.indexOf(wanted);
    return [panels.tile.point.dots[0].at.toArray(), [...scene.image.slice(at, at + 3)]];
  }, vertex);
  assert.ok(Math.hypot(...shown.map((value, k) => value - expected[k])) < 0.01);
  await page.mouse.move(5, 5);
  await drawn(page);
  assert.deepEqual(await dotsShown(page, 'point'), [0, 0, 0]);
}));

test('a vertex can be marked by its number, and the line copied and cleared', () => withPage(figure.page, async (page) => {
  for (const vertex of [12, 40, 7]) {
    await page.fill('#add-vertex', String(vertex));
    await page.press('#add-vertex', 'Enter');
  }
  assert.equal(await conesLine(page), '--cones 12,40,7');
  await page.fill('#add-vertex', '99999999');
  await page.press('#add-vertex', 'Enter');
  assert.match(await page.textContent('#copied'), /no vertex 99999999/);
  await browser.context.grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.click('#copy');
  await page.waitForFunction(() => document.getElementById('copied').textContent === 'Copied.');
  assert.equal(await page.evaluate(() => navigator.clipboard.readText()), '--cones 12,40,7');
  await page.click('#clear');
  assert.equal(await conesLine(page), '--cones');
}));

test('Tab reaches every panel and control; keys turn, zoom, reset and mark', () => withPage(figure.page, async (page) => {
  await page.selectOption('#colouring', 'checkerboard');  // which shows all controls
  const reached = new Set();
  for (let k = 0; k < 25; ++k) {
    await page.keyboard.press('Tab');
    reached.add(await page.evaluate(() => document.activeElement.id || document.activeElement.tagName));
  }
  for (const id of [...PANELS, 'colouring', 'squares', 'opacity', 'relief', 'edges', 'reset', 'add-vertex', 'cones'])
    assert.ok(reached.has(id), id);
  for (const [panel, keys] of [['source', ['ArrowRight', 'ArrowUp', '+', '-']], ['tile', ['ArrowLeft']], ['tiling', ['ArrowDown']]]) {
    await page.focus(`#${panel}`);
    const start = await pixels(page, panel);
    let previous = start;
    for (const key of keys) {
      await page.keyboard.press(key);
      const now = await pixels(page, panel);
      assert.notEqual(now.sum, previous.sum, `${panel}: ${key}`);
      previous = now;
    }
    await page.keyboard.press('Home');
    assert.equal((await pixels(page, panel)).sum, start.sum, `${panel}: Home`);
  }
  await page.focus('#tiling');
  await page.keyboard.press('Enter');
  assert.match(await conesLine(page), /^--cones \d+$/);
}));

test('however near the zoom, the middle of a panel shows the same point, and labels stay within their panels', () => withPage(figure.page, async (page) => {
  for (const panel of PANELS) {
    const {points, outside, seen} = await page.evaluate((name) => {
      const view = window.orbitutteView, stage = document.getElementById(name), box = stage.getBoundingClientRect();
      const labels = () => [...stage.querySelectorAll('.cone-label:not([hidden])')].map((label) => label.getBoundingClientRect());
      const found = {points: [], outside: 0, seen: 0};
      for (let k = 0; k < 20; ++k) {
        const at = view.pointAt(name, box.width / 2, box.height / 2);
        found.points.push(at && `${at.face} ${at.copy}`);
        view.painter.drawNow([view.panels[name]]);
        found.seen += labels().length;
        found.outside += labels().filter(({left, right, top}) => left < box.left - 1 || right > box.right + 1 || top < box.top - 1).length;
        view.tables[name].zoomBy(1.12);
      }
      view.reset();
      return found;
    }, panel);
    assert.notEqual(points[0], null, panel);
    assert.equal(new Set(points).size, 1, `${panel}: ${points}`);
    assert.equal(outside, 0, `${panel}: labels reach out`);
    assert.ok(panel === 'tiling' || seen > 0, panel);
  }
}));

test('turning the source draws the source alone again', () => withPage(figure.page, async (page) => {
  await drawn(page);
  const panels = await page.evaluate(() => new Promise((done) => {
    const {painter, tables} = window.orbitutteView, seen = [], draw = painter.drawPanel.bind(painter);
    painter.drawPanel = (panel, box) => { seen.push(panel.name); draw(panel, box); };
    tables.source.turn(0.1, 0);
    requestAnimationFrame(() => requestAnimationFrame(() => done(seen)));
  }));
  assert.deepEqual(panels, ['source']);
}));

test('dragging turns a panel and marks nothing', () => withPage(figure.page, async (page) => {
  const box = await page.locator('#tiling').boundingBox(), before = await pixels(page, 'tiling');
  const middle = {x: box.x + box.width / 2, y: box.y + box.height / 2};
  await page.mouse.move(middle.x, middle.y);
  await page.mouse.down();
  await page.mouse.move(middle.x + 80, middle.y + 20, {steps: 4});
  await page.mouse.up();
  assert.notEqual((await pixels(page, 'tiling')).sum, before.sum);
  assert.equal(await conesLine(page), '--cones');
}));

test('edges, relief and the copies\' opacity change the picture', () => withPage(figure.page, async (page) => {
  const pictures = [await pixels(page, 'tiling')];
  await page.fill('#opacity', '40');
  pictures.push(await pixels(page, 'tiling'));
  await page.uncheck('#relief');
  pictures.push(await pixels(page, 'tiling'));
  assert.equal(new Set(pictures.map(({sum}) => sum)).size, 3);
  const before = await pixels(page, 'source');
  await page.check('#edges');
  assert.notEqual((await pixels(page, 'source')).sum, before.sum);
}));

test('on a phone nothing is wider than the screen, and text is no smaller than 14 pixels', () => withPage(figure.page, async (page) => {
  const {width, smallest} = await page.evaluate(() => {
    for (const element of document.querySelectorAll('details')) element.open = false;
    const sizes = [...document.querySelectorAll('p, td, th, dd, dt, label, button')].map((element) => parseFloat(getComputedStyle(element).fontSize));
    return {width: document.documentElement.scrollWidth, smallest: Math.min(...sizes)};
  });
  assert.equal(width, 390);
  assert.ok(smallest >= 14, `${smallest}`);
  for (const panel of PANELS) assert.ok((await pixels(page, panel)).colours > 50, panel);
}, {viewport: {width: 390, height: 844}}));

test('a disk with mirrors and 48 copies is drawn', async () => {
  const mask = workshop.makePage('mask', {shape: 'mask', faces: 500, orbifold: '*2,2,12'});
  await withPage(mask.page, async (page) => {
    for (const panel of PANELS) assert.ok((await pixels(page, panel)).colours > 50, panel);
    assert.equal(await page.evaluate(() => window.orbitutteView.scene.copies.length), 48);
  });
});

test('a mesh with a hostile name is only ever text', async () => {
  const editReport = (report) => ({...report, mesh: {...report.mesh, path: HOSTILE}, warnings: [HOSTILE]});
  const {page: file} = workshop.makePage('hostile', {faces: 500, editReport});
  await withPage(file, async (page) => {
    assert.equal(await page.locator('img, script[src]').count(), 0);
    assert.ok((await page.textContent('.warning')).includes('<img src=x'));
    assert.ok((await pixels(page, 'source')).colours > 50);
  });
});

test('a report that claims too little or too much is contradicted by the page', async () => {
  const editReport = (report) => ({...report, certificate: {...report.certificate, bijective: false}});
  const {page: file} = workshop.makePage('claim', {faces: 500, editReport});
  await withPage(file, async (page) => assert.match(await page.textContent('.warning'), /says otherwise/));
});

test('without JavaScript the figures and charts are there, and the page says what is missing', async () => {
  const html = readFileSync(figure.page, 'utf8').replace(/<script>[\s\S]*<\/script>/, '');
  writeFileSync(workshop.path('still.html'), html);
  await withPage(workshop.path('still.html'), async (page) => {
    assert.ok(await page.isVisible('#view-notice'));
    assert.equal(await page.locator('svg.chart').count(), 2);
    assert.ok(await page.isVisible('text=Certified bijective'));
  });
});
