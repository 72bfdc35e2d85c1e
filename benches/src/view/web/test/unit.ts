import assert from "node:assert/strict";
import { test } from "node:test";
import { format, parse } from "../src/address.ts";
import { reduce } from "../src/charts.ts";
import { type Header, MEETS, type Numbers, parseHeader, decodeBlock, REPORTED, SPHERES } from "../src/data.ts";
import { extent, rotate, turnFromX } from "../src/figures.ts";
import { Player } from "../src/player.ts";
import { coefficients, halfSpaces, polytope, type Vec } from "../src/polytope.ts";
import { Run, State } from "../src/run.ts";
import { boundsOf, EXTENT, Space } from "../src/space.ts";

const IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1];

/** The polytope of an or-DOP about points, in the model's axes. */
function about(k: number, points: Vec[]) {
  const ends = coefficients(k).map((d) => points.map((p) => d[0] * p[0] + d[1] * p[1] + d[2] * p[2]));
  const planes = halfSpaces(k, IDENTITY, ends.map((e) => Math.min(...e)), ends.map((e) => Math.max(...e)));
  return polytope(planes, Math.max(...points.map((p) => Math.hypot(...p))));
}

const octahedron: Vec[] = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
const cube: Vec[] = [0, 1, 2, 3, 4, 5, 6, 7].map((n) => [n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1]);

test("a polytope has the corners and edges of the body that its slabs describe", () => {
  // Vertices, edges: cube by any k; cuboctahedron-like cuts of the octahedron by k.
  for (const k of [6, 14, 18, 26]) {
    const { corners, edges } = about(k, cube);
    assert.deepEqual([corners.length, edges.length], [8, 12], `cube, k = ${k}`);
  }
  assert.deepEqual(counts(about(6, octahedron)), [8, 12]);
  assert.deepEqual(counts(about(14, octahedron)), [6, 12]);
  assert.deepEqual(counts(about(18, octahedron)), [14, 24], "rhombic dodecahedron");
});

const counts = ({ corners, edges }: ReturnType<typeof about>) => [corners.length, edges.length];

test("every corner lies in all slabs, and Euler's formula holds", () => {
  let seed = 7;
  const random = () => {
    seed = (seed * 16807) % 2147483647;
    return seed / 2147483647 - 0.5;
  };
  for (let round = 0; round < 20; round++) {
    const points = Array.from({ length: 12 }, (): Vec => [random(), 2 * random(), random()]);
    for (const k of [6, 14, 18, 26]) {
      const { corners, edges } = about(k, points);
      for (const [i, d] of coefficients(k).entries()) {
        const dot = (p: Vec) => d[0] * p[0] + d[1] * p[1] + d[2] * p[2];
        const high = Math.max(...points.map(dot));
        assert.ok(corners.every((c) => dot(c) <= high + 1e-5), `k = ${k}, direction ${i}`);
        assert.ok(corners.some((c) => Math.abs(dot(c) - high) < 1e-5), `k = ${k}, direction ${i} is touched`);
      }
      const degrees = corners.map((_, c) => edges.filter((e) => e.includes(c)).length);
      assert.ok(degrees.every((degree) => degree >= 3), `k = ${k}: ${degrees}`);
    }
  }
});

test("flat bodies and points have polytopes too", () => {
  const plate: Vec[] = [[1, 1, 0], [1, -1, 0], [-1, 1, 0], [-1, -1, 0]];
  assert.deepEqual(counts(about(6, plate)), [4, 4]);
  assert.deepEqual(counts(about(18, [[-1, 0, 0], [1, 0, 0]])), [2, 1]);
  assert.deepEqual(counts(about(26, [[0.5, 0.5, 0.5]])), [1, 0]);
});

const header = (change: Partial<Header> = {}): Header => ({
  format: "sdop-view",
  version: 1,
  scene: "s",
  source: "s.toml",
  seed: "18446744073709551615",
  dt: 0.1,
  side: null,
  interest: [],
  bodies: 3,
  moving: 1,
  frames: 2,
  pairs: 3,
  shapes: [
    { name: "p", triangles: 0, ball: [0, 0, 0, 1], reach: 1, ordop: { k: 6, basis: IDENTITY, lo: [], hi: [] }, lods: [], hull: [0, 0] },
  ],
  runs: [
    { name: "a", detail: "", control: false, volumes: ["sphere", "or-dop"], construct: 1 },
    { name: "none", detail: "", control: true, volumes: null, construct: null },
  ],
  truth: true,
  meet: "meshes",
  layers: [],
  effects: null,
  focus: null,
  messages: [],
  blocks: [],
  ...change,
});

const blocks = (): Map<string, Numbers> =>
  new Map<string, Numbers>([
    ["numbers", new Uint32Array([5, 9])],
    ["shape", new Uint32Array(3)],
    ["static", new Uint8Array([0, 0, 1])],
    ["moving", new Uint32Array([1])],
    ["first", new Float32Array([0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 0, 1, 3, 0, 0])],
    ["poses", new Float32Array([0, 0, 0, 1, 2, 0, 0, 0, 0, 0, 1, 7, 8, 9])],
    ["starts", new Float64Array([0, 2, 3])],
    ["pairs", new Uint16Array([0, 1, 1, 2, 0, 1])],
    ["flags", new Uint8Array([SPHERES | REPORTED, SPHERES | MEETS | REPORTED, SPHERES | MEETS])],
    ["counters-0", new Float64Array([2, 10, 4, 2, 4, 2, 2, 11, 5, 2, 5, 0])],
    ["terms-0", new Float64Array([1, 2, 3, 4, 5, 6])],
  ]);

test("a frame's counts are sums over volumes and pairs", () => {
  const run = new Run(header(), blocks());
  assert.deepEqual(run.counts(0, 0), { nu: 4, nv: 14, hits: 4, reported: 2, apart: 1, true: 1, missed: 0, terms: [1, 2, 3] });
  assert.deepEqual(run.counts(1, 0), { nu: 4, nv: 16, hits: 5, reported: 0, apart: 0, true: 1, missed: 1, terms: [4, 5, 6] });
  assert.deepEqual(run.missed(0, 5), { list: [{ frame: 1, pair: { i: 0, j: 1, flags: SPHERES | MEETS } }], count: 1 });
});

test("the control misses nothing, and without truth nothing is true", () => {
  const run = new Run(header(), blocks());
  assert.deepEqual(run.counts(1, 1), { nu: null, nv: null, hits: null, reported: 0, apart: 0, true: 1, missed: 0, terms: null });
  assert.equal(run.state(MEETS, 1), State.Meets);
  assert.equal(run.state(MEETS, 0), State.Missed);
  assert.equal(new Run(header({ truth: false }), blocks()).counts(0, 0).true, null);
});

test("poses are the first frame's, but for bodies that move", () => {
  const run = new Run(header(), blocks());
  const translations = (frame: number) => [0, 1, 2].map((body) => [...run.posesAt(frame).slice(7 * body + 4, 7 * body + 7)]);
  assert.deepEqual(translations(1), [[1, 0, 0], [7, 8, 9], [3, 0, 0]]);
  assert.deepEqual(translations(0), [[1, 0, 0], [2, 0, 0], [3, 0, 0]]);
});

test("frames are found by number, the last before it where there is none", () => {
  const run = new Run(header(), blocks());
  assert.deepEqual([0, 5, 6, 9, 100].map((number) => run.indexOf(number)), [0, 0, 0, 1, 1]);
});

test("blocks that don't fit their header are refused", () => {
  const short = blocks();
  short.set("flags", new Uint8Array(2));
  assert.throws(() => new Run(header(), short), /block flags has 2 numbers, not 3/);
  const block = { name: "b", type: "f32", length: 2 } as const;
  assert.deepEqual([...decodeBlock(block, "AACAPwAAAEA=")], [1, 2]);
  assert.throws(() => decodeBlock(block, "AACAPwAAAE"), /cut off/);
  assert.throws(() => decodeBlock(block, "AACAPw=="), /4 bytes, not 8/);
  assert.throws(() => parseHeader('{"format":"sdop-view","vers'), /cut off/);
  assert.throws(() => parseHeader('{"format":"sdop-view","version":2}'), /version 2, this viewer reads version 1/);
  assert.throws(() => parseHeader("null"), /no run/);
});

test("an address reads back, and what can't be read is left out", () => {
  const address = {
    frame: 12,
    origin: [1e10, 0, -2],
    camera: [1, 2, 3, 4, 5, 6.5],
    switches: { spheres: true, ordops: false, boxes: false, pairs: true, cells: false },
    picked: 7,
    sides: "both",
    speed: 0.25,
    still: true,
  } as const;
  assert.deepEqual(parse(format({ ...address, origin: [...address.origin], camera: [...address.camera] })), address);
  const bare = parse("#frame=x&camera=1,2&body=-1&sides=left&speed=fast&show=stars");
  const off = { spheres: false, ordops: false, boxes: false, pairs: false, cells: false };
  assert.deepEqual(bare, { frame: null, origin: null, camera: null, switches: off, picked: null, sides: null, speed: null, still: false });
});

test("playing shows the frames that are due and ends at the last", () => {
  const player = new Player(10, 0.1);
  player.toggle();
  for (const [now, frame] of [[0, 0], [50, 0], [100, 1], [350, 3]]) {
    player.advance(now);
    assert.equal(player.at, frame, `at ${now} ms`);
  }
  player.speed = 4;
  player.advance(400);
  assert.equal(player.at, 5);
  player.advance(1400);
  assert.deepEqual([player.at, player.playing], [9, false]);
  player.toggle();
  assert.deepEqual([player.at, player.playing], [0, true]);
});

test("a chart keeps each column's extremes", () => {
  assert.deepEqual(reduce(new Float64Array([1, 9, 2, 3, 0, 4]), 2), [[1, 9], [0, 4]]);
  assert.deepEqual(reduce(new Float64Array([1, 9]), 100), [[1, 1], [9, 9]]);
});

test("turns turn the first axis to a direction, and rotate as they should", () => {
  for (const to of [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0.6, 0, -0.8], [-0.99999, 0.004, 0]] as Vec[]) {
    const turned = rotate(turnFromX(to, Math.hypot(...to)), [1, 0, 0], Math.hypot(...to));
    assert.ok(turned.every((x, axis) => Math.abs(x - to[axis]) < 1e-2), `${to}: ${turned}`);
  }
  const quarter: [number, number, number, number] = [0, 0, Math.SQRT1_2, Math.SQRT1_2];
  const { low, high } = extent(new Float64Array([1, 2, 3, -1, 0, 0]), quarter);
  assert.ok(Math.abs(low[0] + 2) < 1e-9 && Math.abs(high[1] - 1) < 1e-9 && Math.abs(high[2] - 3) < 1e-9, `${low} ${high}`);
});

test("worlds of any size fill the picture, and far places are brought near", () => {
  const run = new Run(header(), blocks());
  assert.deepEqual(boundsOf(run, 0), { centre: [2, 0, 0], half: 2 });
  const space = new Space(run);
  assert.deepEqual([space.x(4), space.x(2), space.y(1)], [10, 0, 5]);
  assert.equal(space.rebase([5, 5, 5]), null);
  assert.deepEqual(space.rebase([2 ** 40, 0, 0]), [5 * 2 ** 40 - 10, 0, 0]);
  assert.equal(space.x(2 ** 40), 0);
});

test("a case's boxes are those of each frame, and a picture is about them", () => {
  const boxes = new Float32Array([...[0, 0, 0, 2, 2, 2], ...[5, 0, 0, 6, 1, 1], ...[0, 9, 0, 1, 10, 1], ...[1, 0, 0, 3, 2, 2], ...[3, 0, 0, 5, 4, 2], ...[0, 9, 0, 1, 10, 1]]);
  const run = new Run(header(), new Map([...blocks(), ["boxes", boxes] as const]));
  assert.deepEqual([...run.boxesAt(1)!.slice(0, 6)], [1, 0, 0, 3, 2, 2]);
  assert.deepEqual(run.cubeAbout(1, 1), { centre: [4, 2, 1], half: 2 });
  assert.deepEqual(boundsOf(run, 1, [0, 1]), { centre: [3.5, 2, 1], half: 2.5 });
  assert.equal(new Run(header(), blocks()).boxesAt(0), null);
  assert.throws(() => new Run(header(), new Map([...blocks(), ["boxes", boxes.slice(1)] as const])), /block boxes has 35 numbers, not 36/);
});

test("where space repeats, a body is moved to its image nearest to another", () => {
  const boxes = new Float32Array([...[0, 4, 0, 1, 5, 1], ...[9, 24, 9, 10, 25, 10], ...[2, 4, 0, 3, 5, 1]]);
  const periods = new Float64Array([10, 10, 0, 0, 0, 0]);
  const given = [["boxes", new Float32Array([...boxes, ...boxes])], ["periods", periods]] as const;
  const run = new Run(header(), new Map<string, Numbers>([...blocks(), ...given]));
  assert.deepEqual([...run.periodsAt(0)!], [10, 10, 0]);
  assert.deepEqual(run.wayToImage(0, 1, 0), [-10, -20, 0]);
  assert.deepEqual(run.wayToImage(0, 0, 1), [10, 20, 0]);
  assert.equal(run.wayToImage(0, 0, 2), null);
  assert.deepEqual([run.periodsAt(1), run.wayToImage(1, 1, 0)], [null, null]);
  assert.equal(new Run(header(), blocks()).periodsAt(0), null);
});

test("a counter-example's picture is about its frame, and about its pair where that is small", () => {
  const focus = (bodies: [number, number]) => header({ focus: { frame: 1, bodies, point: null } });
  // In the second frame body 1 is at (7, 8, 9), the others at (1, 0, 0) and (3, 0, 0), each of
  // reach 1.
  assert.deepEqual(new Space(new Run(focus([0, 2]), blocks())).origin, [4, 4, 4.5]);
  const far = blocks();
  (far.get("poses") as Float32Array).set([1e6, 1e6, 1e6], 11);
  const space = new Space(new Run(focus([0, 2]), far));
  assert.deepEqual(space.origin, [2, 0, 0]);
  assert.ok(Math.abs(space.x(4) - EXTENT / 100) < 1e-9, String(space.x(4)));
});
