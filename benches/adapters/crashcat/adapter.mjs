// crashcat: broadphase.intersectAABB, with a box shape per body in one world for all frames.

import * as crashcat from "crashcat";
import { centresAndHalves, checkSides, serve } from "../wire.mjs";

crashcat.registerAll();

await serve("crashcat", ({ boxes, groups, excluded, objects, gone, kept }) => {
  const given = centresAndHalves(boxes, (x) => x);
  checkSides(given);
  kept.world ??= empty();
  const { world, layer } = kept.world;
  gone.forEach((body) => crashcat.rigidBody.remove(world, body));
  given.forEach((box, number) => {
    objects[number] ??= added(world, layer);
    place(world, objects[number], box);
    if (groups) [objects[number].collisionGroups, objects[number].collisionMask] = groups[number];
  });
  return pairs(world, objects, boxes, excluded ?? []);
});

function empty() {
  const settings = crashcat.createWorldSettings();
  const layer = crashcat.addObjectLayer(settings, crashcat.addBroadphaseLayer(settings));
  crashcat.enableCollision(settings, layer, layer);
  return { world: crashcat.createWorld(settings), layer };
}

function added(world, objectLayer) {
  const shape = crashcat.box.create({ halfExtents: [1, 1, 1], convexRadius: 0 });
  return crashcat.rigidBody.create(world, { shape, objectLayer, motionType: crashcat.MotionType.KINEMATIC });
}

function place(world, body, { centre, half }) {
  if (half.some((length, axis) => length !== body.shape.halfExtents[axis])) {
    body.shape.halfExtents = half;
    crashcat.box.update(body.shape);
    crashcat.rigidBody.updateShape(world, body);
  }
  crashcat.rigidBody.setPosition(world, body, centre, true);
}

function pairs(world, objects, boxes, excluded) {
  const numbers = new Map(objects.map((body, number) => [body, number]));
  const parted = new Set(excluded.flatMap(([i, j]) => [i * boxes.length + j, j * boxes.length + i]));
  const filter = crashcat.filter.forWorld(world);
  const found = [];
  boxes.forEach((box, number) => {
    [filter.collisionGroups, filter.collisionMask] = [objects[number].collisionGroups, objects[number].collisionMask];
    filter.bodyFilter = (body) => !parted.has(number * boxes.length + numbers.get(body));
    const visitor = { shouldExit: false, visit: (body) => found.push([number, numbers.get(body)]) };
    crashcat.broadphase.intersectAABB(world, box, filter, visitor);
  });
  return found;
}
