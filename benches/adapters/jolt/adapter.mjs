// Jolt by its WebAssembly port: BroadPhaseQuery.CollideAABox, for a box shape per body.

import initialise from "jolt-physics/wasm-compat";
import { CaseSkipped, centresAndHalves, serve } from "../wire.mjs";

const jolt = await initialise();
const settings = new jolt.JoltSettings();
settings.mMaxBodies = 4096;
const layers = new jolt.ObjectLayerPairFilterTable(1);
layers.EnableCollision(0, 0);
const broad = new jolt.BroadPhaseLayerInterfaceTable(1, 1);
broad.MapObjectToBroadPhaseLayer(0, new jolt.BroadPhaseLayer(0));
settings.mObjectLayerPairFilter = layers;
settings.mBroadPhaseLayerInterface = broad;
settings.mObjectVsBroadPhaseLayerFilter = new jolt.ObjectVsBroadPhaseLayerFilterTable(broad, 1, layers, 1);
const physics = new jolt.JoltInterface(settings).GetPhysicsSystem();
const [interfaceOfBodies, query] = [physics.GetBodyInterface(), physics.GetBroadPhaseQuery()];
const anyLayer = new jolt.BroadPhaseLayerFilter();
const anyObject = new jolt.ObjectLayerFilter();

await serve("jolt-physics", ({ boxes }) => {
  const given = centresAndHalves(boxes);
  if (given.some(({ half }) => half.some((length) => length <= 0))) throw new CaseSkipped("its boxes have sides above zero");
  const numbers = new Map();
  const bodies = given.map(({ centre, half }, number) => {
    const shape = new jolt.BoxShape(new jolt.Vec3(...half), 0);
    const place = new jolt.RVec3(...centre);
    const made = new jolt.BodyCreationSettings(shape, place, jolt.Quat.prototype.sIdentity(), jolt.EMotionType_Kinematic, 0);
    const body = interfaceOfBodies.CreateBody(made);
    jolt.destroy(made);
    jolt.destroy(place);
    interfaceOfBodies.AddBody(body.GetID(), jolt.EActivation_DontActivate);
    numbers.set(body.GetID().GetIndexAndSequenceNumber(), number);
    return body;
  });
  const found = [];
  const collector = new jolt.CollideShapeBodyCollectorJS();
  let asking = 0;
  collector.Reset = () => {};
  collector.AddHit = (id) => found.push([asking, numbers.get(jolt.wrapPointer(id, jolt.BodyID).GetIndexAndSequenceNumber())]);
  boxes.forEach((box, number) => {
    asking = number;
    const [lower, upper] = [new jolt.Vec3(...box.slice(0, 3)), new jolt.Vec3(...box.slice(3))];
    const asked = new jolt.AABox(lower, upper);
    query.CollideAABox(asked, collector, anyLayer, anyObject);
    [asked, lower, upper].forEach((it) => jolt.destroy(it));
  });
  jolt.destroy(collector);
  for (const body of bodies) {
    interfaceOfBodies.RemoveBody(body.GetID());
    interfaceOfBodies.DestroyBody(body.GetID());
  }
  return found;
});
