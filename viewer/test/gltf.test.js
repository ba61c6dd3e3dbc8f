// SPDX-License-Identifier: MIT
// GLB files before Khronos' glTF validator. The environment's ORBITUTTE names the program under test.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {after, before, test} from 'node:test';
import validator from 'gltf-validator';
import {Workshop} from './workshop.js';

const CHARTS = ['stereographic', 'equirectangular', 'octahedral'];
const SAMPLES = {
  sphere: {orbifold: '432'},
  coloured: {orbifold: '432', coloured: true},
  disk: {shape: 'mask', orbifold: '*2,2,12'},
  plane: {shape: 'quotient', orbifold: '3x'},
};

const workshop = new Workshop(process.env.ORBITUTTE), embedded = {};

before(() => {
  for (const [name, sample] of Object.entries(SAMPLES)) embedded[name] = workshop.embed(name, {faces: 500, ...sample});
});

after(() => workshop.close());

/** What the validator finds, its hints left out. */
async function faults(bytes) {
  const {issues, info} = await validator.validateBytes(new Uint8Array(bytes));
  assert.equal(issues.truncated, false);
  return {faults: issues.messages.filter(({severity}) => severity < 2).map(({code, pointer}) => `${code} ${pointer}`), info};
}

function exported(name, chart) {
  const file = workshop.path(`${name}-${chart}.glb`);
  workshop.run('export', ...embedded[name], '-o', file, '--chart', chart);
  return readFileSync(file);
}

function tiling(name) {
  const file = workshop.path(`${name}-tiling.glb`), [map, report] = embedded[name];
  workshop.run('tile', map, report, '-o', file);
  return readFileSync(file);
}

for (const name of Object.keys(SAMPLES)) {
  for (const chart of CHARTS) {
    test(`the ${name} exported with the ${chart} chart is valid`, async () => {
      const {faults: found, info} = await faults(exported(name, chart));
      assert.deepEqual(found, []);
      assert.equal(info.maxUVs, 1);
      assert.ok(info.totalTriangleCount >= 400);
    });
  }
}

for (const name of ['sphere', 'disk']) {
  test(`the tiling with the ${name} is valid`, async () => {
    const {faults: found, info} = await faults(tiling(name));
    assert.deepEqual(found, []);
    assert.ok(info.drawCallCount >= 2);
  });
}

// The parts of a GLB: its JSON, and its bytes of numbers as a view that can be written to.
function parts(glb) {
  const length = glb.readUInt32LE(12), json = JSON.parse(glb.subarray(20, 20 + length).toString());
  return {json, numbers: glb.subarray(28 + length)};
}

// Where an accessor's numbers begin.
const startOf = ({bufferViews, accessors}, accessor) => bufferViews[accessors[accessor].bufferView].byteOffset ?? 0;

const PLANTED = {
  'an index beyond the vertices': (json, numbers, {indices}) => numbers.writeUInt32LE(1e6, startOf(json, indices)),
  'a position beyond the bounds': (json, numbers, {attributes}) => numbers.writeFloatLE(1e3, startOf(json, attributes.POSITION)),
  'a normal that is no unit vector': (json, numbers, {attributes}) => numbers.writeFloatLE(7, startOf(json, attributes.NORMAL)),
};

for (const [fault, plant] of Object.entries(PLANTED)) {
  test(`${fault} is found`, async () => {
    const glb = exported('sphere', 'stereographic'), {json, numbers} = parts(glb);
    plant(json, numbers, json.meshes[0].primitives[0]);
    assert.notDeepEqual((await faults(glb)).faults, []);
  });
}

test('a file that is cut short is found', async () => {
  assert.notDeepEqual((await faults(exported('sphere', 'stereographic').subarray(0, -4))).faults, []);
});
