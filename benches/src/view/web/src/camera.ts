// The camera: orbit, pan and zoom by mouse, touch (three's controls) and keys, and flights to a
// point.

import { PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { EXTENT } from "./space.ts";
import { reducedMotion } from "./theme.ts";

const FLIGHT_MS = 600;

/** Where the camera looks from at first; the whole box is in view. */
const HOME = new Vector3(0.55, 0.42, 1).normalize();

/** The part of the view's width and height that the box fills; the legend has room under it. */
const FILLED_PART = 0.9;

export class Camera {
  readonly lens = new PerspectiveCamera(40, 1, EXTENT / 1000, 1000 * EXTENT);
  private readonly controls: OrbitControls;
  private flight: { start: number; from: [Vector3, Vector3]; to: [Vector3, Vector3] } | null = null;
  /** Position and target that `home` took last. */
  private readonly rest: [Vector3, Vector3] = [new Vector3(), new Vector3()];

  /**
   * `headroom` is the part of the view's height that titles take. `changed` is called whenever the
   * picture must be drawn again, `moved` when a movement by hand has ended.
   */
  constructor(
    element: HTMLElement,
    private readonly headroom: number,
    changed: () => void,
    moved: () => void,
  ) {
    this.controls = new OrbitControls(this.lens, element);
    this.controls.minDistance = EXTENT / 500;
    this.controls.maxDistance = 200 * EXTENT;
    this.controls.addEventListener("change", changed);
    this.controls.addEventListener("start", () => {
      this.flight = null;
    });
    this.controls.addEventListener("end", moved);
    this.home();
  }

  /** Shows the whole box, centred and as large as fits. */
  home(): void {
    this.flight = null;
    const right = new Vector3(0, 1, 0).cross(HOME).normalize();
    const up = HOME.clone().cross(right);
    const slope = Math.tan((this.lens.fov * Math.PI) / 360);
    const [across, rise] = [FILLED_PART * slope * this.lens.aspect, FILLED_PART * slope * (1 - this.headroom)];
    const [target, position] = [new Vector3(), new Vector3()];
    // What is near looks larger, so the box isn't in the middle of the view when the camera looks
    // at its centre.
    for (let turn = 0; turn < 8; turn++) {
      const seen = CORNERS.map((corner) => corner.clone().sub(target));
      const need = (c: Vector3) => c.dot(HOME) + Math.max(Math.abs(c.dot(right)) / across, Math.abs(c.dot(up)) / rise);
      const distance = Math.max(...seen.map(need));
      position.copy(target).addScaledVector(HOME, distance);
      for (const axis of [right, up]) {
        const slopes = seen.map((c) => c.dot(axis) / (distance - c.dot(HOME)));
        target.addScaledVector(axis, ((Math.min(...slopes) + Math.max(...slopes)) / 2) * distance);
      }
    }
    const under = up.multiplyScalar(this.headroom * slope * position.distanceTo(target));
    target.add(under);
    this.controls.target.copy(target);
    this.lens.position.copy(position.add(under));
    this.controls.update();
    this.rest[0].copy(this.lens.position);
    this.rest[1].copy(target);
  }

  /** From the point looked at to the camera. */
  get back(): Vector3 {
    return this.lens.position.clone().sub(this.controls.target);
  }

  /** Whether the camera is where `home` took it. */
  private get atHome(): boolean {
    const near = (a: Vector3, b: Vector3) => a.distanceTo(b) < EXTENT / 1e5;
    return near(this.lens.position, this.rest[0]) && near(this.controls.target, this.rest[1]) && !this.flight;
  }

  resize(aspect: number): void {
    const { atHome, widening } = this;
    this.lens.aspect = aspect;
    this.lens.updateProjectionMatrix();
    if (atHome) this.home();
    else this.zoom(this.widening / widening);
  }

  /** The factor on distances that keeps the same things in view if it is higher than wide. */
  private get widening(): number {
    const { fov, aspect } = this.lens;
    const half = (fov * Math.PI) / 360;
    return Math.sin(half) / Math.sin(Math.min(half, Math.atan(Math.tan(half) * aspect)));
  }

  /** The distance from which a ball of this radius fills the view. */
  private distanceFor(radius: number): number {
    return (radius * this.widening) / Math.sin((this.lens.fov * Math.PI) / 360);
  }

  /** Flies to a ball. Jumps if `jump` is set, or if the user prefers reduced motion. */
  flyTo(centre: Vector3, radius: number, jump = false): void {
    const away = this.back.normalize();
    const target = centre.clone();
    const position = target.clone().addScaledVector(away, this.distanceFor(Math.max(2.2 * radius, EXTENT / 200)));
    if (jump || reducedMotion()) {
      this.flight = null;
      this.controls.target.copy(target);
      this.lens.position.copy(position);
      this.controls.update();
    } else {
      const from: [Vector3, Vector3] = [this.lens.position.clone(), this.controls.target.clone()];
      this.flight = { start: performance.now(), from, to: [position, target] };
    }
  }

  /** Moves on a flight; true while there is one. */
  advance(now: number): boolean {
    if (!this.flight) return false;
    const part = Math.min(1, (now - this.flight.start) / FLIGHT_MS);
    const eased = part * part * (3 - 2 * part);
    this.lens.position.lerpVectors(this.flight.from[0], this.flight.to[0], eased);
    this.controls.target.lerpVectors(this.flight.from[1], this.flight.to[1], eased);
    this.controls.update();
    if (part === 1) this.flight = null;
    return true;
  }

  /** Turns by these angles, in radians. */
  orbit(right: number, up: number): void {
    const offset = this.back;
    const radius = offset.length();
    const polar = Math.acos(Math.max(-1, Math.min(1, offset.y / radius)));
    const azimuth = Math.atan2(offset.x, offset.z) + right;
    const clamped = Math.max(0.01, Math.min(Math.PI - 0.01, polar - up));
    offset.setFromSphericalCoords(radius, clamped, azimuth);
    this.lens.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  /** Shifts by parts of the distance. */
  pan(right: number, up: number): void {
    const distance = this.lens.position.distanceTo(this.controls.target);
    const shift = new Vector3(right * distance, up * distance, 0).applyQuaternion(this.lens.quaternion);
    this.lens.position.add(shift);
    this.controls.target.add(shift);
    this.controls.update();
  }

  /** Nearer below 1, farther above. */
  zoom(factor: number): void {
    const offset = this.back.multiplyScalar(factor);
    this.lens.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  /** The picture's origin has moved by this much. */
  shift([x, y, z]: [number, number, number]): void {
    this.lens.position.sub(new Vector3(x, y, z));
    this.controls.target.sub(new Vector3(x, y, z));
    this.controls.update();
  }

  /**
   * Position, then target, as six numbers, as on a view that is as wide as high; none while the
   * whole box is seen.
   */
  get state(): number[] | null {
    if (this.atHome) return null;
    const [position, target] = this.flight ? this.flight.to : [this.lens.position, this.controls.target];
    const offset = position.clone().sub(target).divideScalar(this.widening);
    return [...target.clone().add(offset).toArray(), ...target.toArray()];
  }

  set state(numbers: number[]) {
    this.flight = null;
    this.lens.position.fromArray(numbers, 0);
    this.controls.target.fromArray(numbers, 3);
    this.zoom(this.widening);
  }
}

/** Of the box from −EXTENT to EXTENT. */
const CORNERS = [0, 1, 2, 3, 4, 5, 6, 7].map((n) => new Vector3(n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1).multiplyScalar(EXTENT));
