// SPDX-License-Identifier: MIT
// Meshes, embeddings and what the program under test makes of them, in a folder of their own.
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

// A smooth colour for every position: what stands behind it in a line `v x y z` of an OBJ file.
const colourAt = (position) => position.map((x) => (0.5 + 0.5 * Math.sin(5 * x)).toFixed(4)).join(' ');

const withColours = (obj) => obj.replace(/^v (.*)$/gm, (line, xyz) => `${line} ${colourAt(xyz.split(' ').map(Number))}`);

export class Workshop {
  constructor(program) {
    this.program = program;
    this.folder = mkdtempSync(join(tmpdir(), 'orbitutte-viewer-'));
  }

  path(name) {
    return join(this.folder, name);
  }

  run(...words) {
    execFileSync(this.program, words, {stdio: 'pipe', cwd: this.folder});
  }

  /** A sample mesh, its embedding and report, as the paths that commands take in this order. */
  embed(name, {shape = 'figure', faces = 1000, orbifold = '432', coloured = false} = {}) {
    const [mesh, map, json] = ['obj', 'map.ply', 'json'].map((ending) => this.path(`${name}.${ending}`));
    this.run('sample', '--shape', shape, '--faces', String(faces), '-o', mesh);
    if (coloured) writeFileSync(mesh, withColours(readFileSync(mesh, 'utf8')));
    this.run('embed', mesh, '--orbifold', orbifold, '--cones', 'extremities', '-o', map, '--report', json, '--quiet');
    return [map, json, mesh];
  }

  /** Embeds a sample and writes its page, with further options; `editReport` may change the report in between. */
  makePage(name, {editReport = (report) => report, options = [], ...sample} = {}) {
    const [map, json, mesh] = this.embed(name, sample), page = this.path(`${name}.html`);
    const report = editReport(JSON.parse(readFileSync(json, 'utf8')));
    writeFileSync(json, JSON.stringify(report));
    this.run('report', map, json, mesh, '-o', page, ...options);
    return {page, report};
  }

  /** A sample mesh and the same, stretched: the paths of two OBJ files, NAME_a.obj and NAME_b.obj. */
  makePair(name, {shape = 'figure', faces = 1000} = {}) {
    const [a, b] = ['a', 'b'].map((side) => this.path(`${name}_${side}.obj`));
    this.run('sample', '--shape', shape, '--faces', String(faces), '-o', a);
    const stretched = ([x, y, z]) => [1.3 * x, y, z + 0.1 * x * x];
    writeFileSync(b, readFileSync(a, 'utf8').replace(/^v (.*)$/gm, (line, xyz) => `v ${stretched(xyz.split(' ').map(Number)).join(' ')}`));
    return [a, b];
  }

  close() {
    rmSync(this.folder, {recursive: true, force: true});
  }
}
