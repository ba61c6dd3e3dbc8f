// SPDX-License-Identifier: MIT
// The scale's bar of colours with its numbers, as in pictures.
import {gradient} from './colour_maps.js';

const element = (id) => document.getElementById(id);

/** Shows a scale, or hides the legend if there is none. */
export function showLegend(scale, remark) {
  element('legend').hidden = !scale;
  if (!scale) return;
  element('legend-bar').style.backgroundImage = gradient(scale.colours);
  element('legend-ticks').replaceChildren(...scale.ticks.map(({at, text}) => {
    const tick = document.createElement('span');
    tick.textContent = text;
    tick.style.left = `${100 * at}%`;
    return tick;
  }));
  element('legend-title').textContent = `${scale.title}\n${remark}`;
}
