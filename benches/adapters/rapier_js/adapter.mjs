// rapier by its WebAssembly port: World.collidersWithAabbIntersectingAabb, with a cuboid per body
// in one world for all frames, which is saved and restored when the judge says so.

import rapier from "@dimforge/rapier3d-compat";
import { centresAndHalves, serve } from "../wire.mjs";

await rapier.init();
const vector = ([x, y, z]) => ({ x, y, z });
let world = null;

// An object is a collider's handle, which stays the same in a restored world.
await serve("@dimforge/rapier3d-compat", ({ boxes, save, restore, kept, objects, gone }) => {
  const given = centresAndHalves(boxes);
  if (restore) {
    world.free();
    world = rapier.World.restoreSnapshot(kept.saved);
  } else if (!kept.begun) {
    world?.free();
    world = new rapier.World({ x: 0, y: 0, z: 0 });
    kept.begun = true;
  }
  gone.forEach((handle) => world.removeRigidBody(world.getCollider(handle).parent()));
  given.forEach((box, number) => {
    objects[number] ??= added();
    const collider = world.getCollider(objects[number]);
    collider.parent().setTranslation(vector(box.centre), true);
    collider.setHalfExtents(vector(box.half));
  });
  world.step();
  const found = pairs(objects, given);
  if (save) kept.saved = world.takeSnapshot();
  return found;
});

function added() {
  const body = world.createRigidBody(rapier.RigidBodyDesc.fixed());
  return world.createCollider(rapier.ColliderDesc.cuboid(1, 1, 1), body).handle;
}

function pairs(objects, given) {
  const numbers = new Map(objects.map((handle, number) => [handle, number]));
  const found = [];
  given.forEach(({ centre, half }, number) => {
    world.collidersWithAabbIntersectingAabb(vector(centre), vector(half), ({ handle }) => {
      found.push([number, numbers.get(handle)]);
      return true;
    });
  });
  return found;
}
