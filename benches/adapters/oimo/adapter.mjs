// Oimo.js: the pairs of its broad phases, with a box per body in one world for all frames. A box of
// another size is a new body. The tree finds pairs of boxes that have moved; like those of a step,
// its pairs are kept until their boxes are apart.

import OIMO from "oimo";
import { CaseSkipped, centresAndHalves, checkSides, serve } from "../wire.mjs";

const PHASES = { naive: OIMO.BR_BRUTE_FORCE, sweep: OIMO.BR_SWEEP_AND_PRUNE, tree: OIMO.BR_BOUNDING_VOLUME_TREE };

await serve("oimo", ({ boxes, bodies, groups, excluded, kept, objects, gone }) => {
  if (excluded?.length) throw new CaseSkipped("its broad phases have no excluded pairs, only groups");
  const given = centresAndHalves(boxes, (x) => x);
  checkSides(given);
  const world = (kept.world ??= new OIMO.World({ broadphase: PHASES[process.argv[2]] }));
  gone.forEach((body) => world.removeRigidBody(body));
  given.forEach((box, number) => {
    objects[number] = placed(world, objects[number], box, !bodies[number].static);
    if (groups) [objects[number].shapes.belongsTo, objects[number].shapes.collidesWith] = groups[number];
  });
  world.broadPhase.detectPairs();
  let pairs = world.broadPhase.pairs;
  if (process.argv[2] === "tree") pairs = kept.pairs = together(kept.pairs ?? [], pairs);
  const numbers = new Map(objects.map((body, number) => [body, number]));
  return pairs.map(({ shape1, shape2 }) => [numbers.get(shape1.parent), numbers.get(shape2.parent)]);
});

function placed(world, body, { centre, half }, isDynamic) {
  if (body && isSame(body, half, isDynamic)) {
    body.resetPosition(...centre);
    body.syncShapes();
    return body;
  }
  if (body) world.removeRigidBody(body);
  return world.add({ size: half.map((length) => 2 * length), pos: centre, move: isDynamic, neverSleep: true });
}

function isSame({ shapes: box, isDynamic }, [x, y, z], isToBeDynamic) {
  return box.halfWidth === x && box.halfHeight === y && box.halfDepth === z && isDynamic === isToBeDynamic;
}

/** The pairs so far whose boxes still meet, and those that are new. */
function together(before, found) {
  const isKept = ({ shape1, shape2 }) => shape1.proxy && shape2.proxy && !shape1.aabb.intersectTest(shape2.aabb);
  const key = ({ shape1, shape2 }) => Math.min(shape1.id, shape2.id) * 2 ** 26 + Math.max(shape1.id, shape2.id);
  return [...new Map([...before.filter(isKept), ...found].map((pair) => [key(pair), pair])).values()];
}
