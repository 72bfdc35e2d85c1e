// From the world's coordinates to those of the picture.
//
// Worlds lie anywhere up to 2⁶⁰ and have any size, and the GPU computes in f32: so positions are taken relative to an
// origin and scaled in f64 first. Flying far moves the origin along.

import type { Run } from "./run.ts";

/** Half the picture's extent in its own units. */
export const EXTENT = 10;

/** Past this distance from the origin, in the picture's units, f32 gets coarse. */
const FAR = 1000 * EXTENT;

export class Space {
  /** In the world's units. */
  origin: [number, number, number] = [0, 0, 0];
  /** The picture's units per unit of the world. */
  scale = 1;

  constructor(run: Run) {
    const bounds = run.header.side ? { centre: this.origin, half: run.header.side / 2 } : boundsOf(run, 0);
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

  /** Moves the origin when a place lies too far away from it; returns by how much the picture moved. */
  rebase(place: [number, number, number]): [number, number, number] | null {
    const at = [this.x(place[0]), this.y(place[1]), this.z(place[2])];
    if (at.every((x) => Math.abs(x) < FAR)) return null;
    this.origin = place;
    return at as [number, number, number];
  }
}

/** A cube about all bodies of a frame. */
export function boundsOf(run: Run, frame: number): { centre: [number, number, number]; half: number } {
  const poses = run.posesAt(frame);
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (let body = 0; body < run.header.bodies; body++) {
    const reach = run.header.shapes[run.shapeOf[body]].reach;
    for (let axis = 0; axis < 3; axis++) {
      const t = poses[7 * body + 4 + axis];
      low[axis] = Math.min(low[axis], t - reach);
      high[axis] = Math.max(high[axis], t + reach);
    }
  }
  if (run.header.bodies === 0) return { centre: [0, 0, 0], half: 1 };
  const centre = [0, 1, 2].map((axis) => (low[axis] + high[axis]) / 2) as [number, number, number];
  const half = Math.max(...[0, 1, 2].map((axis) => (high[axis] - low[axis]) / 2));
  return { centre, half };
}
