// From the world's coordinates to those of the picture.
//
// A world can be anywhere up to 2⁶⁰ and have any size, but the GPU computes in f32. Therefore
// positions are first taken relative to an origin and scaled, in f64. A long flight moves the
// origin along.

import type { Run } from "./run.ts";

/** Half the picture's extent in its own units. */
export const EXTENT = 10;

/** Past this distance from the origin, in the picture's units, f32 gets coarse. */
const MAX_OFFSET = 1000 * EXTENT;

export class Space {
  /** In the world's units. */
  origin: [number, number, number] = [0, 0, 0];
  /** The picture's units per unit of the world. */
  scale = 1;

  constructor(run: Run) {
    const bounds = run.header.side ? { centre: this.origin, half: run.header.side / 2 } : boundsOfRun(run);
    this.origin = bounds.centre;
    this.scale = bounds.half > 0 && Number.isFinite(bounds.half) ? EXTENT / bounds.half : 1;
  }

  x(world: number): number {
    return (world - this.origin[0]) * this.scale;
  }

  y(world: number): number {
    return (world - this.origin[1]) * this.scale;
  }

  z(world: number): number {
    return (world - this.origin[2]) * this.scale;
  }

  /** Moves the origin if a point is too far from it. Returns how far the picture moved. */
  rebase(place: [number, number, number]): [number, number, number] | null {
    const at = [this.x(place[0]), this.y(place[1]), this.z(place[2])];
    if (at.every((x) => Math.abs(x) < MAX_OFFSET)) return null;
    this.origin = place;
    return at as [number, number, number];
  }
}

type Cube = { centre: [number, number, number]; half: number };

/** A missed pair that takes a smaller part of the picture can't be made out. */
const SMALL_PART = 1 / 100;

/**
 * The space around the bodies of the first frame. For a counter-example, around those of the frame
 * with the missed pair, or around that pair if it is small.
 */
function boundsOfRun(run: Run): Cube {
  const { focus } = run.header;
  if (!focus) return boundsOf(run, 0);
  const [all, pair] = [boundsOf(run, focus.frame), boundsOf(run, focus.frame, focus.bodies)];
  return pair.half < SMALL_PART * all.half ? { centre: pair.centre, half: pair.half / SMALL_PART } : all;
}

/** A cube about all bodies of a frame, or about some. */
export function boundsOf(run: Run, frame: number, bodies?: number[]): Cube {
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  const count = bodies?.length ?? run.header.bodies;
  if (count === 0) return { centre: [0, 0, 0], half: 1 };
  for (let n = 0; n < count; n++) {
    const { centre, half } = run.cubeAbout(frame, bodies ? bodies[n] : n);
    for (let axis = 0; axis < 3; axis++) {
      low[axis] = Math.min(low[axis], centre[axis] - half);
      high[axis] = Math.max(high[axis], centre[axis] + half);
    }
  }
  const centre = [0, 1, 2].map((axis) => (low[axis] + high[axis]) / 2) as [number, number, number];
  const half = Math.max(...[0, 1, 2].map((axis) => (high[axis] - low[axis]) / 2));
  return { centre, half };
}
