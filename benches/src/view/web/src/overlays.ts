// Overlays that can be switched on: spheres, or-DOPs, world boxes, pairs, grid cells. The cell of a
// space that repeats is always shown.

import { Group } from "three";
import type { Color, Vector3 } from "three";
import type { Bodies } from "./bodies.ts";
import { MEETS } from "./data.ts";
import { cubeLines, extent, plus, rotate, sphereLines, type Triple, turnFromX, UPRIGHT } from "./figures.ts";
import { Faces } from "./faces.ts";
import { Wires } from "./lines.ts";
import { halfSpaces, polytope } from "./polytope.ts";
import { type Run, State } from "./run.ts";
import { boundsOf, type Space } from "./space.ts";
import type { Theme } from "./theme.ts";

/** The overlays, by their names in the page's address. */
export const LAYERS = ["spheres", "ordops", "boxes", "pairs", "cells"] as const;
export type Layer = (typeof LAYERS)[number];
export type Switches = Record<Layer, boolean>;

/** What the overlays need to know about the picture. */
export interface Moment {
  frame: number;
  run: number;
  switches: Switches;
  picked: number | null;
  theme: Theme;
  /** A body's colour, or null if nothing of it is drawn. */
  colour: (body: number) => Color | null;
  /** Where the camera is. */
  eye: Vector3;
}

/** Five lines close together: WebGL draws none thicker than a pixel. */
const THICK_SEGMENT = [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]].flatMap(([y, z]) => [-1, y, z, 1, y, z]);

/** The radius of the ball about a shared point, as a part of its distance from the eye. */
const POINT_RADIUS = 0.012;

/** Half the thickness of a line, as a part of its distance from the eye. */
const LINE_HALF_THICKNESS = 7e-4;

export class Overlays extends Group {
  private readonly spheres = new Wires(sphereLines(), 0.55);
  private readonly ordops: Wires[];
  private readonly boxes = new Wires(cubeLines(), 0.7);
  private readonly faces: Faces;
  private readonly cells = new Wires(cubeLines(), 0.35);
  private readonly images = new Wires(cubeLines(), 0.3);
  private readonly halos = new Wires(THICK_SEGMENT, 0.9, true);
  private readonly pairs = new Wires(THICK_SEGMENT, 0.9, true);
  private readonly marks = new Wires(sphereLines(40), 1, true);
  private readonly markedPairs = new Wires(THICK_SEGMENT, 1, true);
  private readonly all: (Wires | Faces)[];
  private readonly hulls: Float64Array[];
  private readonly widest: number;

  constructor(
    private readonly run: Run,
    private readonly space: Space,
    private readonly bodies: Bodies,
  ) {
    super();
    const { shapes } = run.header;
    this.ordops = shapes.map(({ ordop, reach }) => {
      const unit = reach > 0 ? reach : 1;
      const scaled = (ends: number[]) => ends.map((x) => x / unit);
      const { corners, edges } = polytope(halfSpaces(ordop.k, ordop.basis, scaled(ordop.lo), scaled(ordop.hi)), 1);
      return new Wires(
        edges.flatMap(([a, b]) => [...corners[a], ...corners[b]]),
        0.8,
      );
    });
    this.hulls = shapes.map(({ hull: [start, count] }) =>
      Float64Array.from(run.blocks.get("hull")!.subarray(3 * start, 3 * (start + count))),
    );
    this.faces = new Faces(run.boxesAt(0) ? run.header.bodies : 0);
    this.widest = Math.max(0, ...Array.from(new Set(run.shapeOf), (shape) => shapes[shape].ball[3]));
    const { spheres, ordops, boxes, faces, cells, images, halos, pairs, marks, markedPairs } = this;
    this.all = [spheres, ...ordops, boxes, faces, cells, images, halos, pairs, marks, markedPairs];
    this.add(...this.all);
  }

  /**
   * Draws the overlays that are switched on. `marked` are bodies with a ring, each with its colour.
   */
  update(moment: Moment, marked: Map<number, Color>): void {
    const { switches } = moment;
    for (const wires of this.all) wires.begin();
    if (switches.spheres) this.addSpheres(moment);
    if (switches.ordops) this.addOrDops(moment);
    if (switches.boxes) this.addBoxes(moment);
    if (switches.cells) this.addCells(moment);
    this.addPeriods(moment);
    this.addPairs(moment);
    this.addSharedPoint(moment);
    this.addFormerPlaces(moment);
    for (const [body, colour] of marked) {
      const ball = this.bodies.ball(body);
      const radius = 1.08 * ball.radius;
      this.marks.put(ball.centre, UPRIGHT, [radius, radius, radius], colour);
    }
    for (const wires of this.all) wires.end();
  }

  private *shown(moment: Moment): Generator<[number, Color]> {
    for (let body = 0; body < this.run.header.bodies; body++) {
      const colour = moment.colour(body);
      if (colour) yield [body, colour];
    }
  }

  private addSpheres(moment: Moment): void {
    for (const [body, colour] of this.shown(moment)) {
      const { ball } = this.run.header.shapes[this.run.shapeOf[body]];
      const { turn, offset } = this.bodies.placement(body);
      const centre = rotate(turn, [ball[0], ball[1], ball[2]], this.space.scale);
      const radius = ball[3] * this.space.scale;
      this.spheres.put(plus(offset, centre), turn, [radius, radius, radius], colour);
    }
  }

  private addOrDops(moment: Moment): void {
    for (const [body, colour] of this.shown(moment)) {
      const { turn, offset } = this.bodies.placement(body);
      const size = this.bodies.radius(body);
      this.ordops[this.run.shapeOf[body]].put(offset, turn, [size, size, size], colour);
    }
  }

  /**
   * World-aligned boxes: with faces those of the frame, if it has boxes, otherwise boxes around the
   * posed hulls.
   */
  private addBoxes(moment: Moment): void {
    for (const [body, colour] of this.shown(moment)) {
      const given = this.bodies.box(body);
      if (given) {
        this.boxes.put(given.centre, UPRIGHT, given.half, colour);
        this.faces.put(given.centre, given.half, colour);
        continue;
      }
      const { turn, offset } = this.bodies.placement(body);
      const { low, high } = extent(this.hulls[this.run.shapeOf[body]], turn);
      const half = [0, 1, 2].map((axis) => ((high[axis] - low[axis]) / 2) * this.space.scale) as Triple;
      const centre = [0, 1, 2].map((axis) => ((high[axis] + low[axis]) / 2) * this.space.scale) as Triple;
      this.boxes.put(plus(offset, centre), UPRIGHT, half, colour);
    }
  }

  /**
   * The cells of a uniform grid that contain a body's origin. A cell is as wide as the largest
   * ball.
   */
  private addCells(moment: Moment): void {
    const cell = 2 * this.widest * this.space.scale;
    if (!(cell > 0)) return;
    const seen = new Set<string>();
    for (const [body] of this.shown(moment)) {
      const at = this.bodies.placement(body).offset.map((x) => Math.floor(x / cell)) as Triple;
      const name = at.join();
      if (seen.has(name)) continue;
      seen.add(name);
      const centre = at.map((x) => (x + 0.5) * cell) as Triple;
      this.cells.put(centre, UPRIGHT, [cell / 2, cell / 2, cell / 2], moment.theme.cells);
    }
  }

  /**
   * Where space repeats: a cell, which begins at the origin along axes with a period, and the
   * images of boxes that meet others across a border.
   */
  private addPeriods(moment: Moment): void {
    const { run, space } = this;
    const periods = run.periodsAt(moment.frame);
    if (!periods) return;
    const { centre, half } = boundsOf(run, moment.frame);
    const halves = [0, 1, 2].map((axis) => (periods[axis] > 0 ? periods[axis] / 2 : half)) as Triple;
    const [x, y, z] = [0, 1, 2].map((axis) => (periods[axis] > 0 ? halves[axis] : centre[axis]));
    const size = halves.map((length) => length * space.scale) as Triple;
    this.images.put([space.x(x), space.y(y), space.z(z)], UPRIGHT, size, moment.theme.cells);
    for (const { i, j, flags } of run.pairsAt(moment.frame)) {
      if (!(flags & MEETS)) continue;
      this.addImage(i, j, moment);
      this.addImage(j, i, moment);
    }
  }

  private addImage(body: number, other: number, { frame, colour }: Moment): void {
    const [way, box, tint] = [this.run.wayToImage(frame, body, other), this.bodies.box(body), colour(body)];
    if (!way || !box || !tint) return;
    this.images.put(plus(box.centre, way.map((x) => x * this.space.scale) as Triple), UPRIGHT, box.half, tint);
  }

  /**
   * Lines between the origins of a pair's bodies: always for missed pairs, others if switched on.
   */
  private addPairs(moment: Moment): void {
    const { states, spheres } = moment.theme;
    for (const { i, j, flags } of this.run.pairsAt(moment.frame)) {
      const state = this.run.state(flags, moment.run);
      if (state === State.Missed) this.line(this.markedPairs, i, j, states[state], moment);
      if (!moment.switches.pairs || state === State.Idle) continue;
      if (moment.picked !== null && i !== moment.picked && j !== moment.picked) continue;
      this.line(this.pairs, i, j, state === State.Spheres ? spheres : states[state], moment);
    }
  }

  /**
   * For a counter-example, a ball at the point that the missed pair shares. It looks equally large
   * from any distance.
   */
  private addSharedPoint({ frame, eye, theme }: Moment): void {
    const { focus } = this.run.header;
    if (!focus?.point || frame !== focus.frame) return;
    const [x, y, z] = focus.point;
    const at: Triple = [this.space.x(x), this.space.y(y), this.space.z(z)];
    const radius = POINT_RADIUS * Math.hypot(at[0] - eye.x, at[1] - eye.y, at[2] - eye.z);
    this.marks.put(at, UPRIGHT, [radius, radius, radius], theme.states[State.Missed]);
  }

  /** For a counter-example, where its bodies were before: a box each, or one about a mesh. */
  private addFormerPlaces({ frame, colour }: Moment): void {
    const { run, space } = this;
    const { focus } = run.header;
    if (!focus || frame !== focus.frame) return;
    for (const body of focus.bodies) {
      const [now, tint] = [run.cubeAbout(frame, body).centre, colour(body)];
      for (let before = frame - 1; tint && before >= 0; before--) {
        const { centre, half } = run.cubeAbout(before, body);
        if (centre.every((x, axis) => x === now[axis])) continue;
        const boxes = run.boxesAt(before)?.subarray(6 * body);
        const size = [0, 1, 2].map((axis) => (boxes ? (boxes[axis + 3] - boxes[axis]) / 2 : half) * space.scale);
        this.images.put([space.x(centre[0]), space.y(centre[1]), space.z(centre[2])], UPRIGHT, size as Triple, tint);
        break;
      }
    }
  }

  private line(wires: Wires, i: number, j: number, colour: Color, { eye, theme }: Moment): void {
    const [a, b] = [this.bodies.ball(i).centre, this.bodies.ball(j).centre];
    const half = [0, 1, 2].map((axis) => (b[axis] - a[axis]) / 2) as Triple;
    const length = Math.hypot(...half);
    const middle = [0, 1, 2].map((axis) => (a[axis] + b[axis]) / 2) as Triple;
    const thickness = LINE_HALF_THICKNESS * Math.hypot(middle[0] - eye.x, middle[1] - eye.y, middle[2] - eye.z);
    const turn = turnFromX(half, length);
    // A halo in the background's colour shows a line in front of bodies of the line's colour.
    this.halos.put(middle, turn, [length, 3 * thickness, 3 * thickness], theme.background);
    wires.put(middle, turn, [length, thickness, thickness], colour);
  }
}
