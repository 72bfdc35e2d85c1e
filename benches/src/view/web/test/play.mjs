// The page to play with, in headless Chromium: one file of at most 1.5 MB, without errors and
// network access. Its counts are those of the program `sdop` for the same scene and seed.
//
// node test/play.mjs SDOP PAGE

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { find, launch, sleep, Tab } from "./chromium.mjs";

const [sdop, page] = process.argv.slice(2).map((path) => resolve(path));
const size = statSync(page).size;
assert.ok(size < 1.5e6, `${size} bytes`);
assert.ok(!/(?:src|href)="(?!data:)/.test(readFileSync(page, "utf8")), "a file next to the page");

/** The frames of a shipped scene as the program culls them. */
function record(scene, ...flags) {
  const directory = mkdtempSync(join(tmpdir(), "sdop-play-"));
  const file = join(directory, "run.ndjson");
  const path = new URL(`../../../../../data/scenes/${scene}.toml`, import.meta.url).pathname;
  execFileSync(sdop, ["run", path, ...flags, "--record", file]);
  const [, ...frames] = readFileSync(file, "utf8").trim().split("\n").map((line) => JSON.parse(line));
  rmSync(directory, { recursive: true });
  return frames;
}

/** The numbers that the panel has for a frame; the truth is missing where it wasn't asked for. */
function expected({ counters, pairs, meets }) {
  const sum = (key) => counters.reduce((total, volume) => total + volume[key], 0);
  return [sum("updates"), sum("tests"), counters[0].hits, pairs.length, meets?.length ?? null];
}

const READ = `["nu", "nv", "hits", "reported", "true"].map((id) => {
  const text = document.getElementById(id).textContent;
  return text === "–" ? null : Number(text.replaceAll(",", ""));
})`;

async function open(browser, query, options) {
  const tab = await Tab.open(browser.port, options);
  await tab.go(`file://${page}?${query}#frame=0`);
  for (let tries = 0; !(await tab.read("window.sdop !== undefined || document.getElementById('message').textContent.startsWith('This')")); tries++) {
    if (tries > 600) throw new Error(`${query}: nothing after 60 s`);
    await sleep(100);
  }
  assert.equal(await tab.read("document.getElementById('message').textContent"), "", query);
  return tab;
}

/** A setting that the program refuses is explained on the page. */
async function refuse(browser) {
  const tab = await open(browser, "strategy=spheres").catch((error) => error.message);
  assert.match(String(tab), /unknown variant `spheres`.*did you mean `sphere`/s);
  console.log("ok      an unknown strategy is explained");
}

/** A dropped file is the mesh of all bodies. */
async function drop(browser) {
  const tab = await open(browser, "bodies=50&frames=60");
  const wedge = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  await tab.read(`{
    const given = new DataTransfer();
    given.items.add(new File([${JSON.stringify(wedge)}], "wedge.obj"));
    document.dispatchEvent(Object.assign(new Event("drop"), { dataTransfer: given }));
  }`);
  for (let tries = 0; (await tab.read("document.getElementById('scene')?.textContent")) !== "own-50"; tries++) {
    if (tries > 100) throw new Error("a dropped file isn't shown");
    await sleep(100);
  }
  const [nu, nv, hits, reported] = await tab.read(READ);
  assert.ok(nu === 80 && nv === 1180 + hits && reported <= hits, String([nu, nv, hits, reported]));
  await finish(tab);
  console.log("ok      a dropped mesh");
}

async function finish(tab) {
  assert.deepEqual(tab.errors, [], "console");
  assert.deepEqual(tab.requests.filter((request) => !/^(?:file|data|blob):/.test(request)), [], "requests");
  await tab.close();
}

async function compare(browser, query, frames) {
  const start = performance.now();
  const tab = await open(browser, query);
  const opened = performance.now() - start;
  for (const frame of frames) {
    await tab.read(`sdop.seek(${frame.frame})`);
    assert.deepEqual(await tab.read(READ), expected(frame), `${query}: frame ${frame.frame}`);
  }
  await finish(tab);
  const total = frames.reduce((sum, frame) => sum + frame.pairs.length, 0);
  console.log(`ok      ${query}: ${frames.length} frames, ${total} pairs; shown after ${(opened / 1000).toFixed(1)} s`);
}

try {
  find();
} catch (error) {
  console.log(`SKIPPED the page in a browser: ${error.message}`);
  process.exit(0);
}
const browser = await launch();
try {
  await compare(browser, "bodies=50&frames=60&truth=yes", record("paper-50", "--frames", "60", "--truth"));
  for (const [strategy, ...k] of [["sphere"], ["or-dop", "26"], ["s-dop-object-of-interest", "14"]]) {
    const frames = record("paper-150", "--frames", "60", "--strategy", strategy, ...k.flatMap((k) => ["--k", k]));
    await compare(browser, `bodies=150&frames=60&strategy=${strategy}&k=${k[0] ?? 18}`, frames);
  }
  await compare(browser, "bodies=500&frames=240&seed=7", record("paper-500", "--frames", "240", "--seed", "7"));

  await refuse(browser);
  await drop(browser);

  const phone = await open(browser, "bodies=50&frames=60&meshes=balls", { width: 390, height: 844, touch: true });
  assert.ok(await phone.read("document.documentElement.scrollWidth <= innerWidth"), "wider than a phone");
  await phone.read("sdop.play()");
  await sleep(500);
  assert.ok(Number(await phone.read("document.getElementById('frame').textContent")) > 0, "it plays");
  assert.ok((await phone.read("document.getElementById('play-bodies').value")) === "50");
  await phone.read("document.getElementById('play-seed').select()");
  await phone.key("2"); // elsewhere a key of the viewer
  assert.equal(await phone.read("document.getElementById('play-seed').value"), "2");
  await finish(phone);
  console.log("ok      balls at a phone's width");
} finally {
  await browser.close();
}
