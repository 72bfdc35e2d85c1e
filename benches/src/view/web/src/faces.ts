// The boxes of a case as bodies, with transparent faces.

import { BoxGeometry, type Color, DoubleSide, InstancedMesh, Matrix4, MeshBasicMaterial } from "three";
import type { Triple } from "./figures.ts";

const MATRIX = new Matrix4();

/** Faces of world-aligned boxes. `begin`, at most `count` times `put`, `end` make a frame. */
export class Faces extends InstancedMesh<BoxGeometry, MeshBasicMaterial> {
  constructor(count: number) {
    const material = new MeshBasicMaterial({ transparent: true, opacity: 0.45, depthWrite: false, side: DoubleSide });
    super(new BoxGeometry(2, 2, 2), material, count);
    this.frustumCulled = false;
  }

  begin(): void {
    this.count = 0;
  }

  put(centre: Triple, half: Triple, colour: Color): void {
    const n = this.count++;
    this.setMatrixAt(n, MATRIX.makeScale(...half).setPosition(...centre));
    this.setColorAt(n, colour);
  }

  end(): void {
    this.visible = this.count > 0;
    this.instanceMatrix.needsUpdate = true;
    if (this.instanceColor) this.instanceColor.needsUpdate = true;
  }
}
