// cannon-es: the pairs of its broad phases by bounding boxes, with a box per body in one world for
// all frames.

import * as cannon from "cannon-es";
import { CaseSkipped, centresAndHalves, checkSides, serve } from "../wire.mjs";

const PHASES = { naive: cannon.NaiveBroadphase, sweep: cannon.SAPBroadphase };

await serve("cannon-es", ({ boxes, bodies, groups, excluded, objects, gone, kept }) => {
  if (excluded?.length) throw new CaseSkipped("its broad phase has no excluded pairs, only groups");
  const given = centresAndHalves(boxes, (x) => x);
  checkSides(given);
  kept.world ??= empty();
  gone.forEach((body) => kept.world.removeBody(body));
  given.forEach((box, number) => {
    const body = (objects[number] ??= added(kept.world));
    body.type = bodies[number].static ? cannon.Body.STATIC : cannon.Body.DYNAMIC;
    if (groups) [body.collisionFilterGroup, body.collisionFilterMask] = groups[number];
    place(body, box);
  });
  const numbers = new Map(objects.map((body, number) => [body, number]));
  const [first, second] = [[], []];
  kept.world.broadphase.dirty = true; // as its own step does after it has moved bodies
  kept.world.broadphase.collisionPairs(kept.world, first, second);
  return first.map((body, n) => [numbers.get(body), numbers.get(second[n])]);
});

function empty() {
  const world = new cannon.World();
  const phase = new PHASES[process.argv[2]](world);
  phase.useBoundingBoxes = true;
  world.broadphase = phase;
  return world;
}

function added(world) {
  const body = new cannon.Body({ mass: 1 });
  body.addShape(new cannon.Box(new cannon.Vec3(1, 1, 1)));
  world.addBody(body);
  return body;
}

function place(body, { centre, half }) {
  const [box] = body.shapes;
  box.halfExtents.set(...half);
  box.updateConvexPolyhedronRepresentation();
  box.updateBoundingSphereRadius();
  body.updateBoundingRadius();
  body.position.set(...centre);
  body.aabbNeedsUpdate = true;
}
