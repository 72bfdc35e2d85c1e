// The picture: meshes and overlays of one frame, for one strategy or for two side by side.

import {
  Color,
  DoubleSide,
  FrontSide,
  type PerspectiveCamera,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { Bodies } from "./bodies.ts";
import { Camera } from "./camera.ts";
import { cubeLines } from "./figures.ts";
import { Wires } from "./lines.ts";
import { type Label, Labels } from "./labels.ts";
import { type Moment, Overlays, type Switches } from "./overlays.ts";
import { Pace } from "./quality.ts";
import { type Run, State } from "./run.ts";
import { EXTENT, Space } from "./space.ts";
import { reducedMotion, type Theme, theme } from "./theme.ts";

/** What a picture shows. */
export interface Shown {
  frame: number;
  /** The strategies shown, one or two. */
  sides: number[];
  switches: Switches;
  picked: number | null;
  /** Whether the picture moves: then speed matters more than sharpness. */
  moving: boolean;
  /** Whether this is a still picture, in which nothing flashes. */
  still: boolean;
}

/** The part of the picture's height under the strategies' names. */
const TITLE_PART = 0.12;

/** Half a period of the flashing of missed bodies: slow enough for photosensitive people. */
const FLASH_MS = 350;

export class Stage {
  readonly camera: Camera;
  readonly space: Space;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly bodies: Bodies;
  private readonly overlays: Overlays;
  private readonly walls = new Wires(cubeLines(), 1);
  private readonly states: Uint8Array;
  private readonly related: Uint8Array;
  private readonly pace = new Pace();
  private readonly labels: Labels;
  private flashing = false;
  private phase = -1;
  private still = false;

  constructor(
    private readonly run: Run,
    private readonly canvas: HTMLCanvasElement,
    labels: HTMLElement,
    changed: () => void,
    moved: () => void,
  ) {
    this.labels = new Labels(labels);
    this.renderer = new WebGLRenderer({ canvas, antialias: false, powerPreference: "high-performance" });
    this.space = new Space(run);
    this.camera = new Camera(canvas, run.header.runs.length > 1 ? TITLE_PART : 0, changed, moved);
    this.bodies = new Bodies(run, this.space);
    this.overlays = new Overlays(run, this.space, this.bodies);
    this.scene.add(this.bodies, this.overlays, this.walls);
    this.states = new Uint8Array(run.header.bodies);
    this.related = new Uint8Array(run.header.bodies);
    new ResizeObserver(changed).observe(canvas);
  }

  /** Draws one moment. */
  draw(shown: Shown, now: number): void {
    const quality = this.pace.at(now, shown.moving);
    this.resize(shown.sides.length, quality.sharpness);
    const colours = theme();
    this.dress(colours);
    // Decimated meshes have slits. The back faces hide them, except in pictures of a movement.
    this.bodies.surface.side = shown.moving ? FrontSide : DoubleSide;
    this.bodies.place(shown.frame, shown.switches.boxes);
    const { width, height } = this.canvas.getBoundingClientRect();
    const part = width / shown.sides.length;
    this.renderer.setScissorTest(shown.sides.length > 1);
    this.flashing = false;
    this.still = shown.still;
    shown.sides.forEach((side, place) => {
      this.renderer.setViewport(place * part, 0, part, height);
      this.renderer.setScissor(place * part + (place > 0 ? 1 : 0), 0, part, height);
      this.judge(shown.frame, side, shown.picked);
      const covers = this.covering(shown.picked);
      this.bodies.arrange(this.camera.lens, height, quality.coarseness, covers);
      this.paint(shown, side, colours, now);
      this.renderer.render(this.scene, this.camera.lens);
    });
  }

  /** Whether the picture changes by itself: during a flight, or while missed bodies flash. */
  restless(now: number): boolean {
    return this.camera.advance(now) || (this.flashing && this.phaseAt(now) !== this.phase);
  }

  private phaseAt(now: number): number {
    return this.still || reducedMotion() ? 0 : Math.floor(now / FLASH_MS) % 2;
  }

  private paint(shown: Shown, side: number, colours: Theme, now: number): void {
    const { frame, picked, switches } = shown;
    this.phase = this.phaseAt(now);
    const bright = colours.dark ? new Color("#ffffff") : new Color("#ffd9c9");
    const colour = (body: number): Color => {
      const state: State = this.states[body];
      const hue = this.hue(body, colours);
      if (hue) return hue;
      if (state === State.Missed) return this.phase === 1 ? bright : colours.states[state];
      if (state >= State.Reported) return colours.states[state];
      return this.run.fixed[body] ? colours.fixed : colours.moving;
    };
    this.bodies.paint(colour);
    const overlay = (body: number): Color | null => {
      if (this.isAway(body, picked)) return null;
      const state: State = this.states[body];
      return this.hue(body, colours) ?? (state >= State.Reported ? colours.states[state] : colours.volumes);
    };
    const moment: Moment = { frame, run: side, switches, picked, theme: colours, colour: overlay, eye: this.camera.lens.position };
    this.overlays.update(moment, this.marks(picked, colours));
    this.label(shown, colours);
  }

  /** The colour of one of the two bodies of a counter-example. */
  private hue(body: number, colours: Theme): Color | null {
    return colours.pair[this.run.header.focus?.bodies.indexOf(body) ?? -1] ?? null;
  }

  /** Names the two bodies of a counter-example, and the point that they share. */
  private label({ frame, sides }: Shown, colours: Theme): void {
    const { focus } = this.run.header;
    const { width, height } = this.canvas.getBoundingClientRect();
    const labels: Label[] = [];
    const put = (text: string, [x, y, z]: number[], colour: Color) => {
      labels.push({ text, at: [this.space.x(x), this.space.y(y), this.space.z(z)], colour: `#${colour.getHexString()}` });
    };
    // There is no room for them side by side.
    if (focus && sides.length === 1) {
      focus.bodies.forEach((body, n) => put(String(body), this.run.cubeAbout(frame, body).centre, colours.pair[n]));
      if (focus.point && frame === focus.frame) put("shared point", focus.point, colours.states[State.Missed]);
    }
    this.labels.show(spread(labels, this.camera.lens), this.camera.lens, width, height);
  }

  /** If a body is picked: the bodies that hide a part of it, which aren't drawn. */
  private covering(picked: number | null): (body: number) => boolean {
    if (picked === null) return () => false;
    const seen = (body: number) => {
      const { centre, radius } = this.bodies.ball(body);
      const way = new Vector3(...centre).sub(this.camera.lens.position);
      return { way, radius, distance: way.length() };
    };
    const own = seen(picked);
    const angle = (radius: number, distance: number) => Math.asin(Math.min(1, radius / Math.max(distance, 1e-9)));
    return (body) => {
      if (!this.isAway(body, picked)) return false;
      const { way, radius, distance } = seen(body);
      const isBefore = distance - radius < own.distance;
      return isBefore && way.angleTo(own.way) < angle(radius, distance) + angle(own.radius, own.distance);
    };
  }

  /** If a body is picked: whether this one has no pair with it, and no missed pair. */
  private isAway(body: number, picked: number | null): boolean {
    return picked !== null && body !== picked && this.related[body] === State.Idle && this.states[body] !== State.Missed;
  }

  /** Each body's state by its worst pair, and by its worst pair with the picked body. */
  private judge(frame: number, side: number, picked: number | null): void {
    this.states.fill(State.Idle);
    this.related.fill(State.Idle);
    for (const { i, j, flags } of this.run.pairsAt(frame)) {
      const state = this.run.state(flags, side);
      if (state === State.Missed) this.flashing = true;
      for (const body of [i, j]) {
        this.states[body] = Math.max(this.states[body], state);
        if (i === picked || j === picked) this.related[body] = Math.max(this.related[body], state);
      }
    }
  }

  private marks(picked: number | null, colours: Theme): Map<number, Color> {
    const marked = new Map<number, Color>();
    for (const body of this.run.header.interest) marked.set(body, colours.cells);
    this.states.forEach((state, body) => {
      if (state === State.Missed) marked.set(body, colours.states[state]);
    });
    if (picked !== null) {
      this.related.forEach((state, body) => {
        if (state >= State.Reported) marked.set(body, colours.states[state]);
      });
      marked.set(picked, colours.picked);
    }
    return marked;
  }

  private dress(colours: Theme): void {
    this.renderer.setClearColor(colours.background);
    this.bodies.surface.light(colours, this.camera.back);
    this.walls.begin();
    const { side } = this.run.header;
    if (side) {
      const half = (side / 2) * this.space.scale;
      const centre = [this.space.x(0), this.space.y(0), this.space.z(0)] as [number, number, number];
      this.walls.put(centre, [0, 0, 0, 1], [half, half, half], colours.walls);
    }
    this.walls.end();
  }

  private resize(sides: number, sharpness: number): void {
    const { width, height } = this.canvas.getBoundingClientRect();
    const size = this.renderer.getSize(new Vector2());
    if (size.x !== width || size.y !== height || this.renderer.getPixelRatio() !== sharpness) {
      this.renderer.setPixelRatio(sharpness);
      this.renderer.setSize(width, height, false);
    }
    const aspect = width / sides / Math.max(height, 1);
    if (aspect > 0 && Math.abs(aspect - this.camera.lens.aspect) > 1e-6) this.camera.resize(aspect);
  }

  /** The body under a point of the canvas, in CSS pixels from its corner. */
  pick(x: number, y: number, sides: number): number | null {
    const { width, height } = this.canvas.getBoundingClientRect();
    const part = width / sides;
    const at = new Vector2(((x % part) / part) * 2 - 1, 1 - (y / height) * 2);
    const raycaster = new Raycaster();
    raycaster.setFromCamera(at, this.camera.lens);
    return this.bodies.pick(raycaster);
  }

  /** Flies to bodies, one or the two of a pair, or jumps there. */
  flyTo(frame: number, bodies: number[], jump = false): void {
    const cubes = bodies.map((body) => this.run.cubeAbout(frame, body));
    const moved = this.space.rebase(cubes[0].centre);
    if (moved) this.camera.shift(moved);
    const { space } = this;
    const places = cubes.map(({ centre: [x, y, z] }) => new Vector3(space.x(x), space.y(y), space.z(z)));
    const centre = new Vector3();
    for (const place of places) centre.addScaledVector(place, 1 / places.length);
    const radii = cubes.map(({ half }, n) => places[n].distanceTo(centre) + half * space.scale);
    this.camera.flyTo(centre, Math.max(...radii), jump);
  }

  /**
   * Shows the subject of a frame: the missed pair of a counter-example, otherwise everything, or
   * one body if none is near.
   */
  look(frame: number): void {
    const { focus, bodies, side } = this.run.header;
    if (focus?.frame === frame) return this.flyTo(frame, focus.bodies, true);
    this.bodies.place(frame);
    const isNear = (body: number) => this.bodies.placement(body).offset.every((x) => Math.abs(x) < 2 * EXTENT);
    for (let body = 0; body < bodies; body++) if (isNear(body)) return this.camera.home();
    if (bodies === 0 || side) return this.camera.home();
    this.flyTo(frame, [focus?.bodies[0] ?? 0], true);
  }
}

/** Labels that would hide one another are moved apart, up and down the picture. */
function spread(labels: Label[], lens: PerspectiveCamera): Label[] {
  const up = new Vector3(0, 1, 0).applyQuaternion(lens.quaternion);
  const placed: Vector3[] = [];
  return labels.map((label) => {
    const at = new Vector3(...label.at);
    const step = 0.05 * at.distanceTo(lens.position);
    const hides = (other: Vector3) => other.distanceTo(at) < step;
    while (placed.some(hides)) at.addScaledVector(up, -step);
    placed.push(at);
    return { ...label, at: at.toArray() };
  });
}
