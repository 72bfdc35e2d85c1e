// PhysX by its WebAssembly port: PxScene.overlap with the box of each body, in one scene for all
// frames.

import initialise from "physx-js-webidl";
import { CaseSkipped, centresAndHalves, serve } from "../wire.mjs";

const px = await initialise();
const top = px.PxTopLevelFunctions.prototype;
const version = top.PHYSICS_VERSION;
const foundation = top.CreateFoundation(version, new px.PxDefaultAllocator(), new px.PxDefaultErrorCallback());
const scale = new px.PxTolerancesScale();
const physics = top.CreatePhysics(version, foundation, scale);
const material = physics.createMaterial(0.5, 0.5, 0);
const [at, turn] = [new px.PxVec3(0, 0, 0), new px.PxQuat(0, 0, 0, 1)];
const pose = new px.PxTransform(at, turn);
const result = new px.PxOverlapResult();
const flags = new px.PxQueryFlags(px.PxQueryFlagEnum.eDYNAMIC | px.PxQueryFlagEnum.eSTATIC | px.PxQueryFlagEnum.eNO_BLOCK);
const everything = new px.PxQueryFilterData(flags);
let scene = null;

await serve("physx-js-webidl", ({ boxes, objects, gone, kept }) => {
  const given = centresAndHalves(boxes);
  if (given.some(({ half }) => half.some((length) => length <= 0))) throw new CaseSkipped("its boxes have sides above zero");
  if (!kept.begun) {
    scene?.release();
    scene = empty();
    kept.begun = true;
  }
  for (const { actor } of gone) {
    scene.removeActor(actor);
    actor.release();
  }
  given.forEach((box, number) => {
    objects[number] ??= added();
    place(objects[number], box);
  });
  return pairs(objects, given);
});

function empty() {
  const desc = new px.PxSceneDesc(scale);
  desc.cpuDispatcher = top.DefaultCpuDispatcherCreate(0);
  desc.filterShader = top.DefaultFilterShader();
  const scene = physics.createScene(desc);
  px.destroy(desc);
  return scene;
}

function added() {
  const geometry = new px.PxBoxGeometry(1, 1, 1);
  const shape = physics.createShape(geometry, material, true);
  const actor = physics.createRigidDynamic(pose);
  actor.setActorFlag(px.PxActorFlagEnum.eDISABLE_SIMULATION, true);
  actor.attachShape(shape);
  shape.release();
  scene.addActor(actor);
  px.destroy(geometry);
  return { actor, shape };
}

function poseAt([x, y, z]) {
  pose.p.x = x;
  pose.p.y = y;
  pose.p.z = z;
  return pose;
}

function place({ actor, shape }, { centre, half }) {
  const geometry = new px.PxBoxGeometry(...half);
  shape.setGeometry(geometry);
  px.destroy(geometry);
  actor.setGlobalPose(poseAt(centre));
}

function pairs(objects, given) {
  const numbers = new Map(objects.map(({ actor }, number) => [actor.ptr, number]));
  const found = [];
  given.forEach(({ centre, half }, number) => {
    const geometry = new px.PxBoxGeometry(...half);
    result.clear();
    scene.overlap(geometry, poseAt(centre), result, everything);
    for (let hit = 0; hit < result.getNbAnyHits(); hit++) found.push([number, numbers.get(result.getAnyHit(hit).actor.ptr)]);
    px.destroy(geometry);
  });
  return found;
}
