// SPDX-License-Identifier: MIT
// Draws the panels into one canvas that lies behind them. It draws only the panels that have changed, since a large mesh takes
// long without a graphics card.
import {LinearSRGBColorSpace, Vector2, WebGLRenderer} from 'three';

const pixelRatio = () => Math.min(window.devicePixelRatio || 1, 2);

export class Painter {
  /** `afterPanel(panel)` is called when a panel has been drawn. */
  constructor(canvas, panels, afterPanel) {
    this.canvas = canvas;
    this.panels = panels;
    this.afterPanel = afterPanel;
    this.stale = new Set();
    // Panels that are not drawn again must keep their picture.
    this.renderer = new WebGLRenderer({canvas, antialias: true, alpha: true, preserveDrawingBuffer: true});
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.autoClear = false;
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.setScissorTest(true);
    new ResizeObserver(() => this.resized()).observe(canvas.parentElement);
  }

  /** Draws these panels, or all, before the next repaint. */
  draw(panels = this.panels) {
    for (const panel of panels) this.stale.add(panel);
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.drawNow([...this.stale]);
    });
  }

  drawNow(panels = this.panels) {
    const box = this.canvas.parentElement.getBoundingClientRect();
    const isEmpty = this.fitCanvas(box);
    for (const panel of isEmpty ? this.panels : panels) this.drawPanel(panel, box);
    this.stale.clear();
  }

  // The observer also reports once at the start, when nothing has been resized.
  resized() {
    if (!this.fits(this.canvas.parentElement.getBoundingClientRect())) this.draw();
  }

  fits({width, height}) {
    const size = this.renderer.getSize(new Vector2());
    return size.x === width && size.y === height && this.renderer.getPixelRatio() === pixelRatio();
  }

  // Fits the canvas to its box. Returns true if its size has changed; the canvas is then empty.
  fitCanvas(box) {
    if (this.fits(box)) return false;
    this.renderer.setPixelRatio(pixelRatio());
    this.renderer.setSize(box.width, box.height, false);
    return true;
  }

  drawPanel(panel, box) {
    const stage = panel.stage.getBoundingClientRect();
    const place = [stage.left - box.left, box.bottom - stage.bottom, stage.width, stage.height];
    panel.prepare();
    this.renderer.setViewport(...place);
    this.renderer.setScissor(...place);
    this.renderer.clear();
    this.renderer.render(panel.scene, panel.camera);
    this.afterPanel(panel);
  }
}
