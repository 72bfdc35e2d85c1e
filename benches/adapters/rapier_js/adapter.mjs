// rapier by its WebAssembly port: World.collidersWithAabbIntersectingAabb, for a cuboid per body.
// The world is new in each frame; with the argument `snapshots` it stays for a case, its cuboids
// are moved, and it is saved and restored when the judge says so.

import rapier from "@dimforge/rapier3d-compat";
import { CaseSkipped, centresAndHalves, serve } from "../wire.mjs";

await rapier.init();
const staysForCase = process.argv.includes("snapshots");
const vector = ([x, y, z]) => ({ x, y, z });

await serve("@dimforge/rapier3d-compat", ({ boxes, save, restore, kept }) => {
  const given = centresAndHalves(boxes);
  if (restore || !staysForCase) kept.world?.free();
  if (restore) kept.world = rapier.World.restoreSnapshot(kept.saved);
  else if (!kept.world || !staysForCase) kept.world = filled(given);
  const { world } = kept;
  // A collider's handle is its number when all are made in one go.
  const colliders = world.colliders.getAll().sort((a, b) => a.handle - b.handle);
  if (colliders.length !== given.length) throw new CaseSkipped("it keeps the bodies of the first frame");
  if (staysForCase) moved(colliders, given);
  world.step();
  const found = pairs(world, colliders, given);
  if (save) kept.saved = world.takeSnapshot();
  return found;
});

/** A world with a fixed cuboid for each box. */
function filled(given) {
  const world = new rapier.World({ x: 0, y: 0, z: 0 });
  for (const { centre, half } of given) {
    const body = world.createRigidBody(rapier.RigidBodyDesc.fixed().setTranslation(...centre));
    world.createCollider(rapier.ColliderDesc.cuboid(...half), body);
  }
  return world;
}

function moved(colliders, given) {
  given.forEach(({ centre, half }, number) => {
    colliders[number].parent().setTranslation(vector(centre), true);
    colliders[number].setHalfExtents(vector(half));
  });
}

function pairs(world, colliders, given) {
  const numbers = new Map(colliders.map(({ handle }, number) => [handle, number]));
  const found = [];
  given.forEach(({ centre, half }, number) => {
    world.collidersWithAabbIntersectingAabb(vector(centre), vector(half), (collider) => {
      found.push([number, numbers.get(collider.handle)]);
      return true;
    });
  });
  return found;
}
