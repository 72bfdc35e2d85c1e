// A run as the page uses it: frames by index, each with poses, pairs and counts.

import { DataError, type Header, MEETS, type Numbers, REPORTED, SPHERES } from "./data.ts";

/** The sums of a frame's counters for one strategy; null if they aren't recorded. */
export interface Counts {
  nu: number | null;
  nv: number | null;
  /** Pairs that pass the first volume test. */
  hits: number | null;
  reported: number;
  /** Reported pairs whose meshes don't meet; all reported pairs if the truth is unknown. */
  apart: number;
  true: number | null;
  missed: number;
  /** Seconds: Nu·Cu, F, Nv·Cv. */
  terms: [number, number, number] | null;
}

/** A pair of one frame. */
export interface Pair {
  i: number;
  j: number;
  flags: number;
}

/** The state of a pair, or of a body by its worst pair; a worse state is larger. */
export enum State {
  Idle = 0,
  Spheres = 1,
  Reported = 2,
  Meets = 3,
  Missed = 4,
}

export class Run {
  readonly numbers: Uint32Array;
  readonly shapeOf: Numbers;
  readonly fixed: Numbers;
  private readonly moving: Numbers;
  private readonly first: Float32Array;
  private readonly poses: Float32Array;
  private readonly starts: Float64Array;
  private readonly pairs: Numbers;
  private readonly flags: Uint8Array;
  private readonly counters: (Float64Array | null)[];
  private readonly terms: (Float64Array | null)[];
  /**
   * The boxes that a case gives with its frames, six numbers per body and frame: the lower corner,
   * then the upper one.
   */
  private readonly boxes: Float32Array | null;
  /** Three periods per frame, 0 along an axis without one. */
  private readonly periods: Float64Array | null;
  /** The poses of all bodies in the last requested frame: q (x, y, z, w), then t. */
  private readonly posed: Float32Array;
  private posedFrame = -1;

  constructor(
    readonly header: Header,
    readonly blocks: Map<string, Numbers>,
  ) {
    const { bodies, moving, frames, pairs, runs } = header;
    const block = <T extends Numbers>(name: string, length: number): T => {
      const numbers = blocks.get(name);
      if (!numbers) throw new DataError(`block ${name} is missing`);
      if (numbers.length !== length) throw new DataError(`block ${name} has ${numbers.length} numbers, not ${length}`);
      return numbers as T;
    };
    this.numbers = block("numbers", frames);
    this.shapeOf = block("shape", bodies);
    this.fixed = block("static", bodies);
    this.moving = block("moving", moving);
    this.first = block("first", 7 * bodies);
    this.poses = block("poses", 7 * moving * frames);
    this.starts = block("starts", frames + 1);
    this.pairs = block("pairs", 2 * pairs);
    this.flags = block("flags", pairs);
    this.counters = runs.map((run, r) => (run.volumes ? block<Float64Array>(`counters-${r}`, 3 * run.volumes.length * frames) : null));
    this.terms = runs.map((run, r) => (run.construct === null ? null : block<Float64Array>(`terms-${r}`, 3 * frames)));
    this.boxes = blocks.has("boxes") ? block<Float32Array>("boxes", 6 * bodies * frames) : null;
    this.periods = blocks.has("periods") ? block<Float64Array>("periods", 3 * frames) : null;
    this.posed = this.first.slice();
  }

  get frames(): number {
    return this.header.frames;
  }

  /** All bodies' poses, seven floats each. The array is used again by the next call. */
  posesAt(frame: number): Float32Array {
    if (frame !== this.posedFrame) {
      const { moving, posed } = this;
      let from = frame * 7 * moving.length;
      for (let m = 0; m < moving.length; m++, from += 7) {
        posed.set(this.poses.subarray(from, from + 7), 7 * moving[m]);
      }
      this.posedFrame = frame;
    }
    return this.posed;
  }

  /** The boxes that were given with a frame, six floats per body; null where none were. */
  boxesAt(frame: number): Float32Array | null {
    const length = 6 * this.header.bodies;
    return this.boxes && this.boxes.subarray(frame * length, (frame + 1) * length);
  }

  /** The periods of a frame, 0 along an axis without one; null where space doesn't repeat. */
  periodsAt(frame: number): Float64Array | null {
    const periods = this.periods?.subarray(3 * frame, 3 * frame + 3);
    return periods?.some((period) => period > 0) ? periods : null;
  }

  /** How far a body is moved to its image nearest to another; null if that is the body itself. */
  wayToImage(frame: number, body: number, other: number): [number, number, number] | null {
    const periods = this.periodsAt(frame);
    if (!periods) return null;
    const [from, to] = [body, other].map((number) => this.cubeAbout(frame, number).centre);
    const along = (axis: number) => (periods[axis] > 0 ? Math.round((to[axis] - from[axis]) / periods[axis]) * periods[axis] : 0);
    const way: [number, number, number] = [along(0), along(1), along(2)];
    return way.some((x) => x !== 0) ? way : null;
  }

  /** A cube about a body, in the world: about its given box, or about its mesh in any rotation. */
  cubeAbout(frame: number, body: number): { centre: [number, number, number]; half: number } {
    const boxes = this.boxesAt(frame);
    if (boxes) {
      const ends = [0, 1, 2].map((axis) => [boxes[6 * body + axis], boxes[6 * body + axis + 3]]);
      const centre = ends.map(([low, high]) => (low + high) / 2) as [number, number, number];
      return { centre, half: Math.max(...ends.map(([low, high]) => (high - low) / 2)) };
    }
    const poses = this.posesAt(frame);
    const p = 7 * body + 4;
    return { centre: [poses[p], poses[p + 1], poses[p + 2]], half: this.header.shapes[this.shapeOf[body]].reach };
  }

  /** The frame's pairs: overlapping spheres, reported by a strategy, or truly meeting. */
  *pairsAt(frame: number): Generator<Pair> {
    for (let p = this.starts[frame]; p < this.starts[frame + 1]; p++) {
      yield { i: this.pairs[2 * p], j: this.pairs[2 * p + 1], flags: this.flags[p] };
    }
  }

  /** How the strategy `run` treats a pair with these flags. */
  state(flags: number, run: number): State {
    const reported = (flags & (REPORTED << run)) !== 0;
    if (flags & MEETS) return reported || this.header.runs[run].control ? State.Meets : State.Missed;
    if (reported) return State.Reported;
    return flags & SPHERES ? State.Spheres : State.Idle;
  }

  /** What the panel shows of a frame. */
  counts(frame: number, run: number): Counts {
    let [reported, apart, meeting, missed] = [0, 0, 0, 0];
    for (let p = this.starts[frame]; p < this.starts[frame + 1]; p++) {
      const flags = this.flags[p];
      if (flags & (REPORTED << run)) reported++;
      if (flags & MEETS) meeting++;
      const state = this.state(flags, run);
      if (state === State.Reported) apart++;
      if (state === State.Missed) missed++;
    }
    const volumes = this.volumes(frame, run);
    const sum = (get: (v: Volume) => number) => volumes && volumes.reduce((total, v) => total + get(v), 0);
    const terms = this.terms[run];
    return {
      nu: sum((v) => v.updates),
      nv: sum((v) => v.tests),
      hits: volumes && (volumes[0]?.hits ?? 0),
      reported,
      apart,
      true: this.header.truth ? meeting : null,
      missed,
      terms: terms && [terms[3 * frame], terms[3 * frame + 1], terms[3 * frame + 2]],
    };
  }

  /** Each volume's counters in a frame; null where the record has none. */
  volumes(frame: number, run: number): Volume[] | null {
    const [names, counters] = [this.header.runs[run].volumes, this.counters[run]];
    if (!names || !counters) return null;
    return names.map((name, v) => {
      const at = 3 * (frame * names.length + v);
      return { name, updates: counters[at], tests: counters[at + 1], hits: counters[at + 2] };
    });
  }

  /** Every missed pair of the run, at most `most` of them, and how many there are. */
  missed(run: number, most: number): { list: { frame: number; pair: Pair }[]; count: number } {
    const list: { frame: number; pair: Pair }[] = [];
    let count = 0;
    for (let frame = 0; frame < this.frames; frame++) {
      for (let p = this.starts[frame]; p < this.starts[frame + 1]; p++) {
        if (this.state(this.flags[p], run) !== State.Missed) continue;
        count++;
        if (list.length < most) {
          list.push({ frame, pair: { i: this.pairs[2 * p], j: this.pairs[2 * p + 1], flags: this.flags[p] } });
        }
      }
    }
    return { list, count };
  }

  /** The index of the frame with this number, or of the last one before it. */
  indexOf(number: number): number {
    let [low, high] = [0, this.frames - 1];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.numbers[middle] <= number) low = middle;
      else high = middle - 1;
    }
    return Math.max(low, 0);
  }
}

/** One volume's counters. */
export interface Volume {
  name: string;
  updates: number;
  tests: number;
  hits: number;
}
