// SPDX-License-Identifier: MIT
// The vertices that the user marks, and the --cones option that names them.

/** A list of input vertices, each represented by one drawn vertex. */
export class Marks {
  /** `onChange(drawn vertices)` is called after every change. */
  constructor(scene, elements, onChange) {
    this.scene = scene;
    this.elements = elements;
    this.onChange = onChange;
    this.drawn = [];
    elements.form.addEventListener('submit', (event) => this.addByNumber(event));
    elements.clear.addEventListener('click', () => this.change([]));
    elements.copy.addEventListener('click', () => this.copy());
  }

  vertices() {
    return this.drawn.map((vertex) => this.scene.sourceVertex[vertex]);
  }

  /** Marks a vertex, or removes its mark. */
  toggle(drawn) {
    const vertex = this.scene.sourceVertex[drawn];
    const rest = this.drawn.filter((other) => this.scene.sourceVertex[other] !== vertex);
    this.change(rest.length < this.drawn.length ? rest : [...this.drawn, drawn]);
  }

  addByNumber(event) {
    event.preventDefault();
    const {number, message} = this.elements;
    const drawn = number.value === '' ? -1 : this.scene.sourceVertex.indexOf(Number(number.value));
    message.textContent = drawn < 0 ? `This page draws no vertex ${number.value || 'without a number'}.` : '';
    if (drawn < 0) return;
    number.value = '';
    this.toggle(drawn);
  }

  change(drawn) {
    this.drawn = drawn;
    const {line, copy, clear, message} = this.elements;
    line.textContent = drawn.length > 0 ? `--cones ${this.vertices().join(',')}` : '--cones';
    copy.disabled = clear.disabled = drawn.length === 0;
    message.textContent = '';
    this.onChange(drawn);
  }

  async copy() {
    const {line, message} = this.elements;
    window.getSelection().selectAllChildren(line);
    try {
      await navigator.clipboard.writeText(line.textContent);
    } catch {
      document.execCommand('copy');  // for browsers where pages from disk may not write to the clipboard
    }
    message.textContent = 'Copied.';
  }
}
