// One wire figure drawn many times: spheres, or-DOPs, boxes, cells. An instance is turned, scaled
// and moved in the shader.

import {
  BufferAttribute,
  type Color,
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  LineSegments,
  ShaderMaterial,
} from "three";
import type { Triple, Turn } from "./figures.ts";

const VERTEX = `
attribute vec3 offset;
attribute vec4 turn;
attribute vec3 size;
attribute vec3 tint;
varying vec3 colour;
void main() {
  vec3 p = position * size;
  p += 2.0 * cross(turn.xyz, cross(turn.xyz, p) + turn.w * p);
  gl_Position = projectionMatrix * viewMatrix * vec4(p + offset, 1.0);
  colour = tint;
}`;

const FRAGMENT = `
varying vec3 colour;
uniform float opacity;
void main() {
  gl_FragColor = vec4(colour, opacity);
  #include <colorspace_fragment>
}`;

/** Wire figures of one kind. `begin`, any number of `put`, `end` make a frame. */
export class Wires extends LineSegments<InstancedBufferGeometry, ShaderMaterial> {
  private room = 0;
  private offset = new Float32Array(0) as Float32Array<ArrayBuffer>;
  private turn = new Float32Array(0) as Float32Array<ArrayBuffer>;
  private size = new Float32Array(0) as Float32Array<ArrayBuffer>;
  private tint = new Float32Array(0) as Float32Array<ArrayBuffer>;
  private used = 0;

  /** `segments`: ends of the figure's lines, three floats each. */
  constructor(segments: ArrayLike<number>, opacity: number, overAll = false) {
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(segments), 3));
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { opacity: { value: opacity } },
      transparent: opacity < 1 || overAll,
      depthTest: !overAll,
      depthWrite: false,
    });
    super(geometry, material);
    this.frustumCulled = false;
    this.renderOrder = overAll ? 1 : 0;
    this.reserve(16);
  }

  begin(): void {
    this.used = 0;
  }

  put(offset: Triple, turn: Turn, size: Triple, tint: Color): void {
    if (this.used === this.room) this.reserve(2 * this.room);
    const n = this.used++;
    this.offset.set(offset, 3 * n);
    this.turn.set(turn, 4 * n);
    this.size.set(size, 3 * n);
    this.tint[3 * n] = tint.r;
    this.tint[3 * n + 1] = tint.g;
    this.tint[3 * n + 2] = tint.b;
  }

  end(): void {
    this.geometry.instanceCount = this.used;
    this.visible = this.used > 0;
    for (const name of ["offset", "turn", "size", "tint"]) {
      this.geometry.getAttribute(name).needsUpdate = true;
    }
  }

  private reserve(room: number): void {
    this.room = room;
    const grown = (old: Float32Array, width: number) => {
      const array = new Float32Array(width * room);
      array.set(old);
      return array;
    };
    this.offset = grown(this.offset, 3);
    this.turn = grown(this.turn, 4);
    this.size = grown(this.size, 3);
    this.tint = grown(this.tint, 3);
    // The renderer frees the buffers of the arrays that are replaced.
    this.geometry.dispose();
    const columns: [string, Float32Array, number][] = [
      ["offset", this.offset, 3],
      ["turn", this.turn, 4],
      ["size", this.size, 3],
      ["tint", this.tint, 3],
    ];
    for (const [name, array, width] of columns) {
      const attribute = new InstancedBufferAttribute(array, width);
      attribute.setUsage(DynamicDrawUsage);
      this.geometry.setAttribute(name, attribute);
    }
  }
}
