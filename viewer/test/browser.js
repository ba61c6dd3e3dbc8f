// SPDX-License-Identifier: MIT
// What the page's tests need: a browser without network, and pixels.
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {chromium} from 'playwright-core';

const CHROMIUM = process.env.CHROMIUM ?? '/usr/bin/chromium';
const FLAGS = ['--no-sandbox', '--disable-gpu', '--enable-unsafe-swiftshader', '--disable-background-networking', '--no-first-run',
  '--disable-component-update', '--disable-sync', '--disable-quic'];

// Small, since it is drawn without a graphics card.
const VIEWPORT = {width: 800, height: 700};

/** One browser with a fresh profile. */
export class Browser {
  static async open() {
    const browser = new Browser();
    browser.profile = mkdtempSync(join(tmpdir(), 'orbitutte-chromium-'));
    browser.context = await chromium.launchPersistentContext(browser.profile, {
      executablePath: CHROMIUM, headless: true, args: FLAGS, viewport: VIEWPORT,
    });
    return browser;
  }

  /** Opens a file and collects what must not happen: errors, and requests for anything but the file. */
  async visit(file, {viewport = VIEWPORT} = {}) {
    const page = await this.context.newPage();
    const faults = [];
    page.on('console', (message) => message.type() === 'error' && faults.push(message.text()));
    page.on('pageerror', (error) => faults.push(error.message));
    page.on('dialog', (dialog) => faults.push(`dialog: ${dialog.message()}`) && dialog.dismiss());
    const address = pathToFileURL(file).href;
    page.on('request', (request) => !request.url().startsWith('data:') && request.url() !== address && faults.push(request.url()));
    await page.setViewportSize(viewport);
    await page.goto(address);
    return {page, faults};
  }

  async close() {
    await this.context.close();
    rmSync(this.profile, {recursive: true, force: true});
  }
}

/** Waits until the view has drawn everything that it was asked to. */
export const drawn = (page) => page.evaluate(() => new Promise((done) => {
  const settle = () => (window.orbitutteView.painter.waiting || window.orbitutteView.hovered ? requestAnimationFrame(settle) : done());
  requestAnimationFrame(settle);
}));

/** How many distinct colours a panel shows, and a number that tells pictures apart. */
export async function pixels(page, id) {
  await drawn(page);
  return page.evaluate((panel) => {
    const view = window.orbitutteView;
    view.painter.drawNow([view.panels[panel]]);  // the canvas keeps its pixels only until the frame ends
    const [stage, canvas] = [document.getElementById(panel).getBoundingClientRect(), view.painter.canvas.getBoundingClientRect()];
    const ratio = view.painter.renderer.getPixelRatio(), copy = document.createElement('canvas');
    copy.width = 120;
    copy.height = 120;
    const paper = copy.getContext('2d');
    paper.drawImage(view.painter.canvas, (stage.left - canvas.left) * ratio, (stage.top - canvas.top) * ratio, stage.width * ratio,
      stage.height * ratio, 0, 0, 120, 120);
    const values = new Uint32Array(paper.getImageData(0, 0, 120, 120).data.buffer);
    let sum = 0;
    for (const value of values) sum = (Math.imul(sum, 31) + value) | 0;
    return {colours: new Set(values).size, sum};
  }, id);
}

/** Red, green and blue at a place in a panel, in CSS pixels. */
export async function pixelAt(page, id, place) {
  await drawn(page);
  return page.evaluate(([panel, {x, y}]) => {
    const view = window.orbitutteView;
    view.painter.drawNow([view.panels[panel]]);
    const [stage, canvas] = [document.getElementById(panel).getBoundingClientRect(), view.painter.canvas.getBoundingClientRect()];
    const ratio = view.painter.renderer.getPixelRatio(), copy = new OffscreenCanvas(1, 1).getContext('2d');
    copy.drawImage(view.painter.canvas, (stage.left - canvas.left + x) * ratio, (stage.top - canvas.top + y) * ratio, 1, 1, 0, 0, 1, 1);
    return [...copy.getImageData(0, 0, 1, 1).data.slice(0, 3)];
  }, [id, place]);
}

/** Where a panel shows an input vertex, in CSS pixels of the window; for vertices that are in front. */
export const placeOf = (page, id, vertex) => page.evaluate(([panel, wanted]) => {
  const view = window.orbitutteView, element = document.getElementById(panel);
  element.scrollIntoView({block: 'center', behavior: 'instant'});
  const stage = element.getBoundingClientRect();
  const positions = panel === 'source' ? view.scene.source : view.scene.image;
  const at = view.panels[panel].camera.position.clone().fromArray(positions, 3 * view.scene.sourceVertex.indexOf(wanted));
  const {x, y} = view.panels[panel].project(at);
  return {x: stage.left + x, y: stage.top + y, hidden: view.isHidden(view.panels[panel], at)};
}, [id, vertex]);
