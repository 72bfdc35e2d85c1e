// The meshes: one instanced mesh per shape and level of detail; a body's level follows its size on
// the screen.

import {
  BufferAttribute,
  BufferGeometry,
  type Color,
  DynamicDrawUsage,
  Frustum,
  Group,
  InstancedBufferAttribute,
  InstancedMesh,
  Box3,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  type PerspectiveCamera,
  type Raycaster,
  Sphere,
  Vector3,
} from "three";
import type { ShapeHeader } from "./data.ts";
import type { Triple } from "./figures.ts";
import type { Run } from "./run.ts";
import { Surface } from "./shading.ts";
import type { Space } from "./space.ts";

/** Radii in pixels above which the finer level is drawn, finest first. */
const DETAIL_RADII = [80, 24, 10];

/** Shapes with more triangles are shaded smoothly; others have visible edges. */
const MIN_SMOOTH_TRIANGLES = 200;

/** A body's position in the picture. */
export interface Placement {
  /** Rotation, normalised. */
  turn: [number, number, number, number];
  offset: [number, number, number];
}

export class Bodies extends Group {
  private readonly meshes: InstancedMesh[][];
  /** Each body's instance: its mesh and number there, or none while it is out of sight. */
  private readonly at: { mesh: InstancedMesh; index: number }[] = [];
  /** Seven numbers per body: rotation, normalised, and offset. */
  readonly placed: Float64Array;
  /** The frame's boxes, where they are drawn instead of the meshes. */
  private boxes: Float32Array | null = null;
  readonly surface = new Surface();
  private readonly frustum = new Frustum();
  /** Bodies from the nearest to the farthest, so that hidden ones cost least. */
  private readonly order: Uint32Array;
  private readonly distance: Float64Array;

  constructor(
    private readonly run: Run,
    private readonly space: Space,
  ) {
    super();
    const counts = run.header.shapes.map(() => 0);
    for (const shape of run.shapeOf) counts[shape]++;
    this.meshes = run.header.shapes.map((shape, s) => this.levels(shape, counts[s]));
    this.placed = new Float64Array(7 * run.header.bodies);
    this.order = Uint32Array.from({ length: run.header.bodies }, (_, body) => body);
    this.distance = new Float64Array(run.header.bodies);
    for (let body = 0; body < run.header.bodies; body++) this.at.push({ mesh: this.meshes[0][0], index: -1 });
  }

  private levels(shape: ShapeHeader, count: number): InstancedMesh[] {
    return shape.lods.map((_, level) => {
      const mesh = new InstancedMesh(geometry(this.run, shape, level), this.surface, count);
      mesh.instanceMatrix.setUsage(DynamicDrawUsage);
      mesh.instanceColor = new InstancedBufferAttribute(new Float32Array(3 * count), 3).setUsage(DynamicDrawUsage);
      mesh.frustumCulled = false;
      this.add(mesh);
      return mesh;
    });
  }

  /** Moves the bodies to a frame's poses. If `asBoxes`, a case's boxes replace the meshes. */
  place(frame: number, asBoxes = false): void {
    const { run, space, placed } = this;
    this.boxes = asBoxes ? run.boxesAt(frame) : null;
    const poses = run.posesAt(frame);
    for (let body = 0; body < run.header.bodies; body++) {
      const p = 7 * body;
      const norm = Math.hypot(poses[p], poses[p + 1], poses[p + 2], poses[p + 3]);
      for (let c = 0; c < 4; c++) placed[p + c] = poses[p + c] / norm;
      placed[p + 4] = space.x(poses[p + 4]);
      placed[p + 5] = space.y(poses[p + 5]);
      placed[p + 6] = space.z(poses[p + 6]);
    }
  }

  /** The box that is drawn instead of a body's mesh, if there is one. */
  box(body: number): { centre: Triple; half: Triple } | null {
    const { boxes, space } = this;
    if (!boxes) return null;
    const corner = (at: number): Triple => [space.x(boxes[at]), space.y(boxes[at + 1]), space.z(boxes[at + 2])];
    const [low, high] = [corner(6 * body), corner(6 * body + 3)];
    const half = [0, 1, 2].map((axis) => (high[axis] - low[axis]) / 2) as Triple;
    const centre = [0, 1, 2].map((axis) => (high[axis] + low[axis]) / 2) as Triple;
    return { centre, half };
  }

  /** A ball about what is drawn of a body. */
  ball(body: number): { centre: Triple; radius: number } {
    const box = this.box(body);
    if (box) return { centre: box.centre, radius: Math.hypot(...box.half) };
    return { centre: this.placement(body).offset, radius: this.radius(body) };
  }

  /** A body's radius about its origin in the picture. */
  radius(body: number): number {
    return this.run.header.shapes[this.run.shapeOf[body]].reach * this.space.scale;
  }

  placement(body: number): Placement {
    const p = 7 * body;
    const { placed } = this;
    return {
      turn: [placed[p], placed[p + 1], placed[p + 2], placed[p + 3]],
      offset: [placed[p + 4], placed[p + 5], placed[p + 6]],
    };
  }

  /**
   * Chooses each body's level of detail for this camera; `height` in pixels. Bodies count as
   * `coarseness` times smaller than they are. What is hidden or out of sight isn't drawn.
   */
  arrange(camera: PerspectiveCamera, height: number, coarseness: number, hidden: (body: number) => boolean): void {
    const { placed, run, distance } = this;
    const eye = camera.position;
    const focal = height / (2 * Math.tan((camera.fov * Math.PI) / 360)) / coarseness;
    this.frustum.setFromProjectionMatrix(MATRIX.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    for (const mesh of this.meshes.flat()) mesh.count = 0;
    for (let body = 0; body < run.header.bodies; body++) {
      const p = 7 * body;
      distance[body] = Math.hypot(placed[p + 4] - eye.x, placed[p + 5] - eye.y, placed[p + 6] - eye.z);
    }
    this.order.sort((a, b) => distance[a] - distance[b]);
    for (const body of this.order) {
      const p = 7 * body;
      const radius = this.radius(body);
      const at = this.at[body];
      SPHERE.center.set(placed[p + 4], placed[p + 5], placed[p + 6]);
      SPHERE.radius = radius;
      if (this.boxes || hidden(body) || !this.frustum.intersectsSphere(SPHERE)) {
        at.index = -1;
        continue;
      }
      const pixels = (radius * focal) / Math.max(distance[body], 1e-9);
      const levels = this.meshes[run.shapeOf[body]];
      const wanted = DETAIL_RADII.filter((limit) => pixels < limit).length;
      const mesh = levels[Math.min(wanted, levels.length - 1)];
      at.mesh = mesh;
      at.index = mesh.count++;
      compose(mesh.instanceMatrix.array as Float32Array, 16 * at.index, placed, p, radius);
    }
    for (const mesh of this.meshes.flat()) {
      mesh.visible = mesh.count > 0;
      mesh.instanceMatrix.needsUpdate = true;
    }
  }

  /** Colours the bodies; call it after `arrange`. */
  paint(colour: (body: number) => Color): void {
    for (let body = 0; body < this.run.header.bodies; body++) {
      const { mesh, index } = this.at[body];
      if (index < 0) continue;
      const { r, g, b } = colour(body);
      const array = mesh.instanceColor!.array as Float32Array;
      array[3 * index] = r;
      array[3 * index + 1] = g;
      array[3 * index + 2] = b;
    }
    for (const mesh of this.meshes.flat()) mesh.instanceColor!.needsUpdate = true;
  }

  /** The nearest body that the ray meets, by its mesh; hidden ones don't count. */
  pick(raycaster: Raycaster): number | null {
    const { ray } = raycaster;
    if (this.boxes) return this.pickBox(raycaster);
    const near: [number, number][] = [];
    for (let body = 0; body < this.run.header.bodies; body++) {
      SPHERE.center.set(...this.placement(body).offset);
      SPHERE.radius = this.radius(body);
      if (this.at[body].index < 0) continue;
      const point = ray.intersectSphere(SPHERE, POINT);
      if (point) near.push([point.distanceTo(ray.origin), body]);
    }
    near.sort((a, b) => a[0] - b[0]);
    let best: { distance: number; body: number } | null = null;
    for (const [distance, body] of near) {
      if (best && best.distance < distance) break;
      const levels = this.meshes[this.run.shapeOf[body]];
      PROBE.geometry = levels[0].geometry;
      compose(PROBE.matrixWorld.elements, 0, this.placed, 7 * body, this.radius(body));
      const [hit] = raycaster.intersectObject(PROBE, false);
      if (hit && (!best || hit.distance < best.distance)) best = { distance: hit.distance, body };
    }
    return best?.body ?? null;
  }

  private pickBox({ ray }: Raycaster): number | null {
    let best: { distance: number; body: number } | null = null;
    for (let body = 0; body < this.run.header.bodies; body++) {
      const { centre, half } = this.box(body)!;
      BOX.setFromCenterAndSize(new Vector3(...centre), new Vector3(...half).multiplyScalar(2));
      const distance = ray.intersectBox(BOX, POINT)?.distanceTo(ray.origin) ?? Infinity;
      if (distance < (best?.distance ?? Infinity)) best = { distance, body };
    }
    return best?.body ?? null;
  }
}

const MATRIX = new Matrix4();
const BOX = new Box3();
const SPHERE = new Sphere();
const POINT = new Vector3();
const PROBE = new Mesh(new BufferGeometry(), new MeshBasicMaterial());

/**
 * One level of a shape's mesh, scaled to reach 1: shapes may be smaller than f32's normal numbers.
 */
function geometry(run: Run, shape: ShapeHeader, level: number): BufferGeometry {
  const { vertices, triangles } = shape.lods[level];
  const points = run.blocks.get("vertices")!.subarray(3 * vertices[0], 3 * (vertices[0] + vertices[1]));
  const corners = run.blocks.get("triangles")!.subarray(3 * triangles[0], 3 * (triangles[0] + triangles[1]));
  const reach = shape.reach > 0 ? shape.reach : 1;
  const round = new BufferGeometry();
  round.setAttribute("position", new BufferAttribute(Float32Array.from(points, (x) => x / reach), 3));
  round.setIndex(new BufferAttribute(Uint32Array.from(corners), 1));
  // Without shared vertices each triangle has its own normal.
  const geometry = shape.triangles > MIN_SMOOTH_TRIANGLES ? round : round.toNonIndexed();
  geometry.computeVertexNormals();
  geometry.computeBoundingSphere();
  return geometry;
}

/** Writes the matrix of rotation, offset (seven numbers from `p`) and scale. */
function compose(to: Float32Array | number[], at: number, placed: Float64Array, p: number, scale: number): void {
  const [x, y, z, w] = [placed[p], placed[p + 1], placed[p + 2], placed[p + 3]];
  to[at] = scale * (1 - 2 * (y * y + z * z));
  to[at + 1] = scale * 2 * (x * y + w * z);
  to[at + 2] = scale * 2 * (x * z - w * y);
  to[at + 3] = 0;
  to[at + 4] = scale * 2 * (x * y - w * z);
  to[at + 5] = scale * (1 - 2 * (x * x + z * z));
  to[at + 6] = scale * 2 * (y * z + w * x);
  to[at + 7] = 0;
  to[at + 8] = scale * 2 * (x * z + w * y);
  to[at + 9] = scale * 2 * (y * z - w * x);
  to[at + 10] = scale * (1 - 2 * (x * x + y * y));
  to[at + 11] = 0;
  to[at + 12] = placed[p + 4];
  to[at + 13] = placed[p + 5];
  to[at + 14] = placed[p + 6];
  to[at + 15] = 1;
}
