// What the adapters in JavaScript share: the judge's wire.

import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import readline from "node:readline";

/** The library does not claim to do this case. */
export class CaseSkipped extends Error {}

/** The next number above one that is not below zero, of those that `round` gives. */
function above(x, round) {
  for (let step = Number.MIN_VALUE; ; step *= 2) {
    if (round(x + step) > x) return round(x + step);
  }
}

/**
 * Centres and half sides of boxes, rounded to float32 by default. A box that they can't represent
 * is replaced by a larger one around it: additional pairs are no failure.
 */
export function centresAndHalves(boxes, round = Math.fround) {
  return boxes.map(([x0, y0, z0, x1, y1, z1]) => {
    const [centre, half] = [[], []];
    for (const [lower, upper] of [[x0, x1], [y0, y1], [z0, z1]]) {
      const middle = round(lower / 2 + upper / 2);
      let length = Math.max(round(upper - middle), round(middle - lower));
      while (round(middle - length) > lower || round(middle + length) < upper) length = above(length, round);
      centre.push(middle);
      half.push(length);
    }
    return { centre, half };
  });
}

/** Skips a case in which a box is flat. */
export function checkSides(given) {
  if (given.some(({ half }) => half.some((length) => length <= 0))) throw new CaseSkipped("its boxes have sides above zero");
}

/** Pairs that a library has found, in any order and maybe twice, as the judge takes them. */
function asked(found, bodies) {
  const seen = new Map();
  for (const [a, b] of found) {
    const [i, j] = a < b ? [a, b] : [b, a];
    if (i < j && !(bodies[i].static && bodies[j].static)) seen.set(i * bodies.length + j, [i, j]);
  }
  return [...seen.values()];
}

/** Carries the objects of bodies that stay to their new numbers, and lists those of the others. */
function change(head, bodies) {
  const stay = new Set(bodies.map(({ was }) => was));
  head.gone.push(...head.objects.filter((object, number) => object !== undefined && !stay.has(number)));
  head.objects = bodies.map(({ was }) => head.objects[was]);
  head.bodies = bodies;
}

/**
 * Answers cases on standard input until it ends. `find` returns the pairs of a frame, which has
 * `boxes` or `poses`, the other inputs of its claim, `bodies` and `shapes`, and what stays for the
 * whole case: `kept`, an object; `objects`, for whatever the library has for each body, undefined
 * for a new one; and `gone`, those of bodies that are removed. With `restore`, bodies and objects
 * are those of the saved state. With `--version`, prints the version of a package.
 */
export async function serve(name, find) {
  if (process.argv.includes("--version")) {
    const found = createRequire(import.meta.url).resolve.paths(name).map((folder) => `${folder}/${name}/package.json`);
    for (const path of found) {
      try {
        console.log(JSON.parse(readFileSync(path)).version);
        break;
      } catch {}
    }
    process.exit();
  }
  // Libraries print too; standard output is for answers alone.
  console.log = console.warn = console.error;
  let head = null;
  for await (const line of readline.createInterface({ input: process.stdin })) {
    const frame = JSON.parse(line);
    if (frame.format) {
      head = { ...frame, kept: {}, gone: [], objects: frame.bodies.map(() => undefined) };
      continue;
    }
    if (head === null) continue; // the rest of a case that it has skipped
    if (frame.restore) Object.assign(head, { ...head.saved, objects: [...head.saved.objects] });
    if (frame.bodies) change(head, frame.bodies);
    let answer;
    const start = process.hrtime.bigint();
    try {
      const { shapes, bodies, kept, objects } = head;
      if (bodies.some((body) => body.parts)) throw new CaseSkipped("its bodies are single shapes");
      const found = await find({ ...frame, shapes, bodies, kept, objects, gone: head.gone.splice(0) });
      answer = { pairs: asked(found, head.bodies), ns: Number(process.hrtime.bigint() - start) };
      if (frame.save) head.saved = { bodies: head.bodies, objects: [...objects] };
    } catch (error) {
      if (!(error instanceof CaseSkipped)) throw error;
      answer = { skipped: error.message };
      head = null;
    }
    process.stdout.write(`${JSON.stringify({ frame: frame.frame, ...answer })}\n`);
  }
}
