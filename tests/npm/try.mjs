// The package in a folder with nothing else: its README's program, what it refuses, and the pairs,
// counts and exact answers of a record that `sdop run --truth` wrote.
//     node try.mjs README.md RECORD…

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import * as sdop from "sdop";

const [readme, ...records] = process.argv.slice(2);

// The program of the README, with what it computes for the checks below.
const program = readFileSync(readme, "utf8").match(/```js\n(.*?)```/s)[1];
writeFileSync("first.mjs", `${program}\nexport { pairs, meet };\nexport const counts = culler.counts;\n`);
const seen = await import("./first.mjs");
assert.deepEqual([...seen.pairs], [0, 1]);
assert.equal(seen.meet, true);
assert.deepEqual([seen.counts.nu, seen.counts.hits, seen.counts.reported], [6, 1, 1]);
assert.deepEqual([...sdop.boxPairs(new Float32Array([0, 0, 0, 1, 1, 1, 1, 0, 0, 2, 1, 1]))], [0, 1]);
const world = new sdop.BoxWorld();
const [a, b] = [0, 1].map((x) => world.insert(new Float32Array([x, 0, 0, x + 1, 1, 1])));
assert.deepEqual([...world.cull()], [a, b]);
assert.deepEqual([...world.events().begun], [a, b]);
world.remove(b);
assert.deepEqual([...world.cull()], []);
assert.deepEqual([...world.events().ended], [a, b]);

// What browsers load.
const web = await import(new URL("node_modules/sdop/web/sdop.js", import.meta.url).href);
web.initSync({ module: readFileSync("node_modules/sdop/web/sdop_bg.wasm") });
assert.deepEqual([...web.boxPairs(new Float32Array([0, 0, 0, 1, 1, 1, 1, 0, 0, 2, 1, 1]))], [0, 1]);

for (const [act, message] of [
  [() => sdop.boxPairs(new Float32Array(5)), /^boxes: 5 numbers; give 6 for each entry$/],
  [() => sdop.boxPairs(new Float32Array([Number.NaN, 0, 0, 1, 1, 1])), /body 0/],
  [() => world.remove(b), /body/],
  [() => new sdop.Culler("spheres"), /sphere/],
  [() => new sdop.Mesh(new Float32Array(9), new Uint32Array([0, 1, 3])), /vertex 3/],
]) {
  assert.throws(act, (error) => error instanceof Error && message.test(error.message), String(message));
}

for (const record of records) {
  const [header, ...frames] = readFileSync(record, "utf8").trim().split("\n").map((line) => JSON.parse(line));
  const meshes = header.shapes.map((s) => new sdop.Mesh(new Float32Array(s.vertices.flat()), new Uint32Array(s.triangles.flat())));
  const { strategy, k, pairs: finder, interest } = header.cull;
  const culler = new sdop.Culler(strategy, k, finder);
  for (const mesh of meshes) culler.addShape(mesh);
  for (const body of header.bodies) culler.addBody(body.shape, body.static);
  if (interest) culler.setInterest(new Uint32Array(interest));
  const sums = { nu: 0, nv: 0, reported: 0, meeting: 0 };
  for (const { frame, poses, pairs, counters, meets } of frames) {
    const columns = [[0, 4], [4, 7]].map(([from, to]) => new Float32Array(poses.flatMap((pose) => pose.slice(from, to))));
    assert.deepEqual([...culler.cull(...columns)], pairs.flat(), `pairs of frame ${frame}`);
    const { nu, nv, hits, reported } = culler.counts;
    const sum = (key) => counters.reduce((total, volume) => total + volume[key], 0);
    assert.deepEqual([nu, nv, hits, reported], [sum("updates"), sum("tests"), counters[0].hits, pairs.length], `counts of frame ${frame}`);
    const posed = (body) => [meshes[header.bodies[body].shape], new Float32Array(poses[body])];
    const meeting = pairs.filter(([i, j]) => sdop.exactMeet(...posed(i), ...posed(j)));
    assert.deepEqual(meeting, meets, `meetings of frame ${frame}`);
    for (const [key, more] of Object.entries({ nu, nv, reported, meeting: meeting.length })) sums[key] += more;
  }
  assert.ok(sums.meeting > 0, `${record}: no pair meets`);
  console.log(`${header.scene}, ${strategy}, ${frames.length} frames: equal to the program's`, sums);
}
