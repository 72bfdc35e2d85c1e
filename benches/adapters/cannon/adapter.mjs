// cannon-es: the pairs of its broad phases by bounding boxes, for a box per body.

import * as cannon from "cannon-es";
import { CaseSkipped, centresAndHalves, serve } from "../wire.mjs";

const PHASES = { naive: cannon.NaiveBroadphase, sweep: cannon.SAPBroadphase };

await serve("cannon-es", ({ boxes, bodies, groups, excluded }) => {
  if (excluded?.length) throw new CaseSkipped("its broad phase has no excluded pairs, only groups");
  const given = centresAndHalves(boxes, (x) => x);
  if (given.some(({ half }) => half.some((length) => length <= 0))) throw new CaseSkipped("its boxes have sides above zero");
  const world = new cannon.World();
  const phase = new PHASES[process.argv[2]](world);
  phase.useBoundingBoxes = true;
  world.broadphase = phase;
  given.forEach(({ centre, half }, number) => {
    const body = new cannon.Body({ mass: bodies[number].static ? 0 : 1, position: new cannon.Vec3(...centre) });
    if (groups) [body.collisionFilterGroup, body.collisionFilterMask] = groups[number];
    body.addShape(new cannon.Box(new cannon.Vec3(...half)));
    world.addBody(body);
  });
  const [first, second] = [[], []];
  phase.collisionPairs(world, first, second);
  return first.map((body, n) => [body.index, second[n].index]);
});
