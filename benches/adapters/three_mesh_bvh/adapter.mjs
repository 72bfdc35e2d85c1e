// three-mesh-bvh: MeshBVH.intersectsGeometry, for every pair of bodies.

import * as three from "three";
import { MeshBVH } from "three-mesh-bvh";
import { CaseSkipped, serve } from "../wire.mjs";

await serve("three-mesh-bvh", ({ shapes, bodies, poses }) => {
  const trees = shapes.map((shape) => {
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.Float32BufferAttribute(shape.vertices.flat(), 3));
    geometry.setIndex(shape.triangles.flat());
    geometry.boundsTree = new MeshBVH(geometry);
    return geometry;
  });
  const placed = poses.map(([x, y, z, w, ...place]) => {
    if (![x, y, z].every((c) => c === 0) || w !== 1) throw new CaseSkipped("its matrices are made of rounded products where a body is turned");
    return new three.Matrix4().makeTranslation(...place);
  });
  const bounds = placed.map((matrix, number) => trees[bodies[number].shape].boundsTree.getBoundingBox(new three.Box3()).applyMatrix4(matrix));
  const found = [];
  for (let j = 0; j < poses.length; j++) {
    for (let i = 0; i < j; i++) {
      if (bounds[i].containsBox(bounds[j]) || bounds[j].containsBox(bounds[i])) throw new CaseSkipped("one mesh may lie inside of another, and it tests surfaces");
      const [one, other] = [trees[bodies[i].shape], trees[bodies[j].shape]];
      const between = placed[i].clone().invert().multiply(placed[j]);
      if (one.boundsTree.intersectsGeometry(other, between)) found.push([i, j]);
    }
  }
  return found;
});
