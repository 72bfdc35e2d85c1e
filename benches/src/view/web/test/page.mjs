// The page in headless Chromium: what it shows equals the record, however it is controlled, without
// errors and without network access.
//
// node test/page.mjs SDOP: the built binary makes a scene, records and pages in a temporary
// directory.

import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { find, launch, sleep, Tab } from "./chromium.mjs";
import { colours, kept } from "./colours.mjs";

const sdop = resolve(process.argv[2] ?? "target/debug/sdop");
const directory = mkdtempSync(join(tmpdir(), "sdop-view-page-"));
const scene = new URL("../../../../../data/scenes/paper-50.toml", import.meta.url).pathname;

const file = (name) => join(directory, name);
const url = (name, hash = "") => `file://${file(name)}${hash}`;
const run = (...args) => execFileSync(sdop, args, { encoding: "utf8" });

/** The run's record: first line, then frames. */
function readRecord(name) {
  return readFileSync(file(name), "utf8").trim().split("\n").map((line) => JSON.parse(line));
}

/** The panel's number with this id, or null where it shows none. */
async function shown(tab, id) {
  const text = await tab.read(`document.getElementById(${JSON.stringify(id)}).textContent`);
  return text === "–" ? null : Number(text.replaceAll(",", ""));
}

/** Repeats a question until the answer is true: a busy machine draws late. */
async function until(ask, what) {
  for (let tries = 0; tries < 200; tries++) {
    const answer = await ask();
    if (answer) return answer;
    await sleep(100);
  }
  assert.fail(`${what}: not within 20 s`);
}

/** The picture once it is drawn sharp: it stays the same. */
async function finished(tab) {
  let last = null;
  return until(async () => {
    await sleep(200); // longer than a picture rests before it is drawn sharp
    const picture = await tab.screenshot();
    const same = last?.equals(picture);
    last = picture;
    return same && picture;
  }, "a picture that stays");
}

const sum = (frame, key) => frame.counters.reduce((total, volume) => total + volume[key], 0);

const tests = {
  async "the numbers are the record's, in every frame"(browser) {
    const [, ...frames] = readRecord("run.ndjson");
    const [, ...spheres] = readRecord("sphere.ndjson");
    const tab = await open(browser, "both.html");
    let truths = 0;
    for (const [n, frame] of frames.entries()) {
      await tab.read(`sdop.seek(${frame.frame})`);
      await expectNumbers(tab, "", frame);
      await expectNumbers(tab, "-2", { ...spheres[n], meets: frame.meets });
      assert.equal(await shown(tab, "frame"), frame.frame);
      truths += frame.meets.length;
    }
    assert.ok(truths > 20, `${truths} pairs meet: too few to tell`);
  },

  async "keys play, step, switch, pick and turn"(browser) {
    const tab = await open(browser, "run.html");
    const frame = () => shown(tab, "frame");
    for (const [key, expected] of [[".", 1], [".", 2], [",", 1], [">", 11], ["<", 1], ["End", 39], ["Home", 0]]) {
      await tab.key(key);
      assert.equal(await frame(), expected, key);
    }
    for (let slower = 0; slower < 3; slower++) await tab.key("["); // so that a busy machine doesn't reach the end
    await tab.key(" ");
    assert.equal(await tab.read("sdop.playing"), true);
    await until(async () => (await frame()) > 2, "it plays");
    await tab.key(" ");
    assert.equal(await tab.read("sdop.playing"), false);
    const stopped = await frame();
    await sleep(120);
    assert.equal(await frame(), stopped, "paused");
    for (const [key, name] of [["1", "spheres"], ["2", "ordops"], ["3", "boxes"], ["4", "pairs"], ["5", "cells"]]) {
      await tab.key(key);
      assert.match(await tab.read("location.hash"), new RegExp(`show=[a-z,]*${name}`), key);
    }
    assert.equal(await tab.read("document.querySelectorAll('#switches [aria-pressed=true]').length"), 5);
    await tab.key("n");
    await tab.key("n");
    assert.match(await tab.read("document.getElementById('picked-text').textContent"), /^Body 1: /);
    await tab.key("Escape");
    assert.equal(await tab.read("document.getElementById('picked').hidden"), true);
    for (const key of ["ArrowLeft", "ArrowUp", "+", "-"]) {
      const before = await tab.read("location.hash");
      await tab.key(key);
      assert.notEqual(await tab.read("location.hash"), before, key);
    }
    await tab.key("?");
    assert.equal(await tab.read("document.getElementById('about').open"), true);
    await tab.key("Escape");
    // From button to button with Tab; the one with the focus shows it.
    await tab.read("document.getElementById('back').focus()");
    await tab.key("Tab");
    assert.equal(await tab.read("document.activeElement.id"), "play");
    assert.notEqual(await tab.read("getComputedStyle(document.activeElement).outlineStyle"), "none");
    await tab.key("Enter");
    assert.equal(await tab.read("sdop.playing"), true, "Enter presses the button");
    await tab.read("sdop.pause()");
  },

  async "mouse and touch turn, zoom, scrub and pick"(browser) {
    const tab = await open(browser, "run.html");
    const { x, y, width, height } = await tab.read("document.getElementById('picture').getBoundingClientRect().toJSON()");
    // The address holds the camera once it has left its first position.
    const camera = () => tab.read("location.hash.match(/camera=([^&]*)/)?.[1] ?? 'home'");
    let before = await camera();
    await tab.mouse("mousePressed", x + 60, y + 60, { button: "left", clickCount: 1 });
    await tab.mouse("mouseMoved", x + 160, y + 90, { button: "left", buttons: 1 });
    await tab.mouse("mouseReleased", x + 160, y + 90, { button: "left", clickCount: 1 });
    await tab.settle();
    assert.notEqual(await camera(), before, "drag");
    before = await camera();
    await tab.mouse("mouseWheel", x + width / 2, y + height / 2, { deltaX: 0, deltaY: -300 });
    await until(async () => (await camera()) !== before, "the wheel zooms");
    await tab.settle();
    before = await camera();
    // Somewhere in the middle there is a body.
    let picked = false;
    for (let step = 0; step < 12 && !picked; step++) {
      await tab.click(x + width * (0.35 + 0.027 * step), y + height * 0.5);
      picked = await tab.read("!document.getElementById('picked').hidden");
    }
    assert.ok(picked, "a click picks a body");
    assert.equal(await camera(), before, "and doesn't turn the camera");
    await tab.read("document.getElementById('picked-fly').click()");
    assert.notEqual(await camera(), before, "flown to");
    const slider = await tab.read("document.getElementById('scrub').getBoundingClientRect().toJSON()");
    await tab.click(slider.x + slider.width / 2, slider.y + slider.height / 2);
    assert.ok(Math.abs((await shown(tab, "frame")) - 20) <= 2, "scrubbed to the middle");

    const phone = await open(browser, "run.html", "", { width: 390, height: 844, touch: true });
    before = await phone.read("location.hash");
    const touch = (type, ...points) => phone.client.Input.dispatchTouchEvent({ type, touchPoints: points });
    await touch("touchStart", { x: 100, y: 200 });
    await touch("touchMove", { x: 180, y: 230 });
    await touch("touchEnd");
    await phone.settle();
    assert.notEqual(await phone.read("location.hash"), before, "touch turns");
    assert.ok(await phone.read("document.documentElement.scrollWidth <= innerWidth"), "nothing is wider than a phone");
  },

  async "an address shows the same again"(browser) {
    const tab = await open(browser, "both.html");
    await tab.read("sdop.seek(17)");
    for (const key of ["1", "4", "n", "v", "v", "ArrowLeft", "]"]) await tab.key(key);
    const hash = await tab.read("location.hash");
    for (const part of ["frame=17", "show=spheres,pairs", "body=0", "sides=both", "speed=2"]) assert.ok(hash.includes(part), `${part} in ${hash}`);
    const again = await open(browser, "both.html", hash);
    assert.equal(await again.read("location.hash"), hash);
    assert.equal(await shown(again, "frame"), 17);
  },

  async "bodies have the colours of their pairs, in both themes"(browser) {
    for (const dark of [false, true]) {
      const tab = await open(browser, "run.html", "#frame=10", { dark });
      await until(async () => {
        const seen = await colours(browser, await tab.screenshot(), 800, 700);
        return seen.blue > 300 && seen.orange > 100 && (dark ? seen.dark : seen.light) > 100_000;
      }, `meeting and reported bodies on ${dark ? "dark" : "light"} ground`);
    }
  },

  async "a missed pair is listed, flashes, and is flown to"(browser) {
    const [, ...frames] = readRecord("run.ndjson");
    const { frame, pair } = missed;
    const tab = await open(browser, "missed.html");
    assert.equal(await tab.read("document.getElementById('missed-section').hidden"), false);
    assert.equal(await shown(tab, "missed-count"), 1);
    await tab.read("document.querySelector('#missed button').click()");
    assert.equal(await shown(tab, "frame"), frame);
    assert.equal(await shown(tab, "reported"), frames[frame].pairs.length - 1);
    assert.equal(await shown(tab, "true"), frames[frame].meets.length);
    assert.match(await tab.read("document.querySelector('#missed button').textContent"), new RegExp(`${pair[0]} – ${pair[1]}`));
    const reds = [];
    await until(async () => {
      reds.push((await colours(browser, await tab.screenshot(), 800, 700)).red);
      return Math.max(...reds) > 3 * Math.min(...reds) + 500;
    }, "red comes and goes");
    const calm = await open(browser, "missed.html", await tab.read("location.hash"), { still: true });
    let [last, same] = [null, 0];
    await until(async () => {
      const picture = await calm.screenshot();
      same = last?.equals(picture) ? same + 1 : 0;
      last = picture;
      await sleep(150);
      return same === 6; // longer than the flashes' period
    }, "nothing moves where less motion is wanted");
    assert.ok((await colours(browser, last, 800, 700)).red > 500, "and what is missed is red");
  },

  async "a counter-example opens at its missed pair, in two hues with labels"(browser) {
    const labels = (tab) => tab.read("[...document.querySelectorAll('#labels span')].map((label) => label.textContent)");
    const tab = await open(browser, "counter.html");
    assert.equal(await shown(tab, "frame"), 1);
    const [first, second, point] = await labels(tab);
    assert.deepEqual([Number(second), point], [Number(first) + 1, "shared point"]);
    assert.match(await tab.read("location.hash"), /show=[a-z,]*boxes/);
    assert.match(await tab.read("document.getElementById('legend').textContent"), new RegExp(`body ${first}.*body ${second}`));
    const pictured = async (tab) => colours(browser, await tab.screenshot(), 800, 700);
    const seen = await until(async () => {
      const seen = await pictured(tab);
      return seen.teal > 500 && seen.purple > 500 && seen;
    }, "both bodies and their boxes have their own hues");
    // What is red is the shared point, not the boxes.
    assert.ok(seen.red > 20 && seen.red < seen.teal / 2, JSON.stringify(seen));
    // A frame by its address, without the missed pair, is not empty, though the bodies are far
    // apart there.
    for (const frame of [0, 2]) {
      const other = await open(browser, "counter.html", `#frame=${frame}`);
      assert.equal(await shown(other, "frame"), frame);
      await until(async () => {
        const { teal, purple } = await pictured(other);
        return teal + purple > 100; // far away, it is little more than its label
      }, `frame ${frame} shows a body`);
    }
  },

  async "the boxes of a case take the place of its meshes"(browser) {
    const tab = await open(browser, "tiny.html", "", { still: true });
    const ground = async () => (await colours(browser, await finished(tab), 800, 700)).light;
    const around = await ground();
    assert.ok(around > 300_000, `${around} pixels of ground about two small boxes`);
    const { x, y, width, height } = await tab.read("document.getElementById('picture').getBoundingClientRect().toJSON()");
    await tab.click(x + width / 2, y + height / 2);
    assert.match(await tab.read("document.getElementById('picked-text').textContent"), /^Body [01]:/);
    await tab.key("Escape");
    // Without the boxes, the meshes are there, which are far larger.
    await tab.key("3");
    const left = await ground();
    assert.ok(left < around / 2, `${left} pixels of ground, and ${around} about the boxes`);
  },

  async "picking a body keeps colours and legend"(browser) {
    const tab = await open(browser, "run.html", "#frame=10", { still: true });
    const legend = () => tab.read("document.getElementById('legend').textContent");
    const before = await legend();
    assert.match(before, /[1-9]/);
    const unpicked = await finished(tab);
    const shares = [];
    for (let body = 0; body < 5; body++) {
      await tab.key("n");
      assert.match(await tab.read("document.getElementById('picked-text').textContent"), new RegExp(`^Body ${body}:`));
      assert.equal(await legend(), before, `legend with body ${body}`);
      const { coloured, same } = await kept(browser, unpicked, await finished(tab), 800, 700);
      assert.ok(coloured > 1000, `${coloured} coloured pixels: too few to tell`);
      shares.push(same / coloured);
    }
    // A body that hides the picked one isn't drawn, and a ring is.
    const mean = shares.reduce((a, b) => a + b) / shares.length;
    assert.ok(mean > 0.85 && Math.min(...shares) > 0.5, `shares of pixels that keep their colour: ${shares}`);
    await tab.key("Escape");
    const { coloured, same } = await kept(browser, unpicked, await finished(tab), 800, 700);
    assert.equal(same, coloured, "without a picked body, all is as before");
  },

  async "broken and old records are explained in the page"(browser) {
    const message = (tab) => tab.read("document.getElementById('message').hidden ? '' : document.getElementById('message').textContent");
    const newer = await open(browser, "newer.html");
    assert.match(await message(newer), /the record has version 2; this program reads version 1/);
    const cut = await open(browser, "cut.html");
    assert.equal(await message(cut), "");
    assert.match(await cut.read("document.getElementById('notes').textContent"), /the file ends inside this line/);
    assert.equal(await cut.read("document.getElementById('last').textContent"), "38");
    const old = await open(browser, "old.html");
    assert.deepEqual(await Promise.all(["nu", "nv", "hits"].map((id) => shown(old, id))), [null, null, null]);
    assert.equal(await shown(old, "reported"), readRecord("run.ndjson")[1].pairs.length);
    writeFileSync(file("torn.html"), readFileSync(file("run.html"), "utf8").replace(/(id="block-poses">)[^<]{100}/, "$1"));
    assert.match(await message(await open(browser, "torn.html")), /block poses has .* cut off or changed/);
  },

  async "the guide's command draws a frame"(browser) {
    const options = ["--headless", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars"];
    if (process.getuid?.() === 0) options.push("--no-sandbox");
    options.push(`--user-data-dir=${file("still")}`, "--window-size=640,480", `--screenshot=${file("still.png")}`);
    assert.equal(spawnSync(find(), [...options, url("run.html", "#frame=11&still")]).status, 0);
    const png = readFileSync(file("still.png"));
    assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [640, 480]);
    const seen = await colours(browser, png, 640, 480);
    assert.ok(seen.blue > 50, JSON.stringify(seen));
  },
};

async function expectNumbers(tab, suffix, frame) {
  const expected = {
    nu: sum(frame, "updates"),
    nv: sum(frame, "tests"),
    hits: frame.counters[0].hits,
    reported: frame.pairs.length,
    true: frame.meets.length,
  };
  const seen = {};
  for (const id of Object.keys(expected)) seen[id] = await shown(tab, id + suffix);
  assert.deepEqual(seen, expected, `frame ${frame.frame}${suffix}`);
}

const tabs = [];

async function open(browser, name, hash = "", options = {}) {
  const tab = await Tab.open(browser.port, options);
  tab.name = name;
  tabs.push(tab);
  await tab.go(url(name, hash));
  return tab;
}

/** The pair that is taken out of the record, so that it is missed. */
let missed;

function makePages() {
  run("run", scene, "--frames", "40", "--truth", "--record", file("run.ndjson"));
  run("run", scene, "--frames", "40", "--strategy", "sphere", "--record", file("sphere.ndjson"));
  run("view", file("run.ndjson"), "--out", file("run.html"));
  run("view", file("run.ndjson"), "--beside", file("sphere.ndjson"), "--no-prices", "--out", file("both.html"));
  const lines = readFileSync(file("run.ndjson"), "utf8").trim().split("\n");
  const write = (name, changed) => {
    writeFileSync(file(`${name}.ndjson`), changed);
    // A broken record is an error, and a page all the same.
    const { status } = spawnSync(sdop, ["view", file(`${name}.ndjson`), "--no-prices", "--out", file(`${name}.html`)]);
    return status;
  };
  const frames = lines.slice(1).map((line) => JSON.parse(line));
  const frame = frames.findIndex((candidate) => candidate.meets.length > 0);
  missed = { frame, pair: frames[frame].meets[0] };
  frames[frame].pairs = frames[frame].pairs.filter((pair) => String(pair) !== String(missed.pair));
  assert.equal(write("missed", [lines[0], ...frames.map((f) => JSON.stringify(f))].join("\n")), 0);
  run("cases", "--claims", "aabb", "--case", "churn/teleport/0004", "--out", file("cases"));
  // The first frame is answered rightly, with all pairs; all others without any.
  const all = [...Array(12).keys()].flatMap((j) => [...Array(j).keys()].map((i) => [i, j]));
  const answers = [0, 1, 2, 3, 4, 5].map((frame) => JSON.stringify({ frame, pairs: frame ? [] : all }));
  writeFileSync(file("answers.ndjson"), answers.join("\n"));
  run("view", file("cases/churn/teleport/0004.ndjson"), "--answers", file("answers.ndjson"), "--no-prices", "--out", file("counter.html"));
  const given = readFileSync(file("cases/churn/teleport/0004.ndjson"), "utf8").trim().split("\n").map((line) => JSON.parse(line));
  // In the frame with the miss, both bodies of the pair have one small box.
  const [lower, upper] = [given[2].boxes[0].slice(0, 3), given[2].boxes[0].slice(3)];
  const small = [...lower, ...lower.map((low, axis) => Math.fround(low + (upper[axis] - low) / 16))];
  given[2].boxes.splice(0, 2, small, small);
  writeFileSync(file("tiny.ndjson"), given.map((line) => JSON.stringify(line)).join("\n"));
  run("view", file("tiny.ndjson"), "--answers", file("answers.ndjson"), "--no-prices", "--out", file("tiny.html"));
  assert.equal(write("newer", lines.join("\n").replace('"version":1', '"version":2')), 2);
  assert.equal(write("cut", lines.join("\n").slice(0, -30)), 2);
  const old = lines.map((line) => {
    const { counters, effects, cull, minor, program, ...rest } = JSON.parse(line);
    return JSON.stringify(rest);
  });
  assert.equal(write("old", old.join("\n")), 0);
}

let failed = 0;
const browser = await launch();
try {
  makePages();
  for (const [name, test] of Object.entries(tests)) {
    try {
      await test(browser);
      for (const tab of tabs) {
        assert.deepEqual(tab.errors, [], `${tab.name}: console`);
        assert.deepEqual(tab.requests.filter((request) => !request.startsWith(`file://${directory}`) && !request.startsWith("data:")), [], `${tab.name}: requests`);
      }
      console.log(`ok      ${name}`);
    } catch (error) {
      failed++;
      console.log(`FAILED  ${name}\n${error.stack}`);
    }
    for (const tab of tabs.splice(0)) await tab.close();
  }
} finally {
  await browser.close();
  rmSync(directory, { recursive: true, force: true });
}
process.exit(failed > 0 ? 1 : 0);
