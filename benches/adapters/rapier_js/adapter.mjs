// rapier by its WebAssembly port: World.collidersWithAabbIntersectingAabb, for a cuboid per body.

import rapier from "@dimforge/rapier3d-compat";
import { centresAndHalves, serve } from "../wire.mjs";

await rapier.init();

await serve("@dimforge/rapier3d-compat", ({ boxes }) => {
  const given = centresAndHalves(boxes);
  const world = new rapier.World({ x: 0, y: 0, z: 0 });
  const vector = ([x, y, z]) => ({ x, y, z });
  const numbers = new Map();
  given.forEach(({ centre, half }, number) => {
    const body = world.createRigidBody(rapier.RigidBodyDesc.fixed().setTranslation(...centre));
    numbers.set(world.createCollider(rapier.ColliderDesc.cuboid(...half), body).handle, number);
  });
  world.step();
  const found = [];
  given.forEach(({ centre, half }, number) => {
    world.collidersWithAabbIntersectingAabb(vector(centre), vector(half), (collider) => {
      found.push([number, numbers.get(collider.handle)]);
      return true;
    });
  });
  world.free();
  return found;
});
