// Jolt by its WebAssembly port: BroadPhaseQuery.CollideAABox, with a box shape per body in one
// system for all frames. Filters are object layers, one per body.

import initialise from "jolt-physics/wasm-compat";
import { CaseSkipped, centresAndHalves, checkSides, serve } from "../wire.mjs";

const jolt = await initialise();
const anyLayer = new jolt.BroadPhaseLayerFilter();
const anyObject = new jolt.ObjectLayerFilter();
const identity = jolt.Quat.prototype.sIdentity();
let last = null;

await serve("jolt-physics", ({ boxes, groups, excluded, save, restore, objects, gone, kept }) => {
  const given = centresAndHalves(boxes);
  checkSides(given);
  if (!kept.system) {
    if (last) jolt.destroy(last.whole);
    kept.system = last = system(groups ? 2 * boxes.length : 1);
  }
  const { whole, bodies, layerCount } = kept.system;
  if (groups && boxes.length > layerCount) throw new CaseSkipped("the number of layers is fixed");
  if (restore) {
    if (kept.changed) throw new CaseSkipped("a state is of the bodies that it was saved with");
    kept.saved.Rewind();
    kept.system.physics.RestoreState(kept.saved);
  }
  kept.changed ||= gone.length > 0 || objects.includes(undefined);
  for (const { id } of gone) {
    bodies.RemoveBody(id);
    bodies.DestroyBody(id);
  }
  given.forEach((box, number) => {
    objects[number] ??= added(bodies);
    if (groups) bodies.SetObjectLayer(objects[number].id, number);
    place(bodies, objects[number], box);
  });
  whole.Step(1 / 60, 1);
  if (groups) kept.system.filter(groups, excluded);
  const found = pairs(kept.system, objects, boxes, groups);
  if (save) {
    if (kept.saved) jolt.destroy(kept.saved);
    kept.saved = new jolt.StateRecorderImpl();
    kept.system.physics.SaveState(kept.saved);
    kept.changed = false;
  }
  return found;
});

function system(layerCount) {
  const settings = new jolt.JoltSettings();
  settings.mMaxBodies = 131072;
  const layers = new jolt.ObjectLayerPairFilterTable(layerCount);
  const broad = new jolt.BroadPhaseLayerInterfaceTable(layerCount, 1);
  const only = new jolt.BroadPhaseLayer(0);
  for (let layer = 0; layer < layerCount; layer++) {
    broad.MapObjectToBroadPhaseLayer(layer, only);
    for (let other = 0; other <= layer; other++) layers.EnableCollision(layer, other);
  }
  settings.mObjectLayerPairFilter = layers;
  settings.mBroadPhaseLayerInterface = broad;
  settings.mObjectVsBroadPhaseLayerFilter = new jolt.ObjectVsBroadPhaseLayerFilterTable(broad, 1, layers, layerCount);
  const whole = new jolt.JoltInterface(settings);
  const physics = whole.GetPhysicsSystem();
  physics.SetGravity(new jolt.Vec3(0, 0, 0));
  const filter = (groups, excluded) => {
    const parted = new Set(excluded.map(([i, j]) => i * layerCount + j));
    groups.forEach(([inB, meetsB], j) => {
      groups.slice(0, j).forEach(([inA, meetsA], i) => {
        const meets = (inA & meetsB) !== 0 && (inB & meetsA) !== 0 && !parted.has(i * layerCount + j);
        if (meets) layers.EnableCollision(i, j);
        else layers.DisableCollision(i, j);
      });
    });
  };
  return { whole, physics, layers, layerCount, filter, bodies: physics.GetBodyInterface(), query: physics.GetBroadPhaseQuery() };
}

function added(bodies) {
  const [half, centre] = [new jolt.Vec3(1, 1, 1), new jolt.RVec3(0, 0, 0)];
  const settings = new jolt.BodyCreationSettings(new jolt.BoxShape(half, 0), centre, identity, jolt.EMotionType_Kinematic, 0);
  const id = bodies.CreateBody(settings).GetID();
  bodies.AddBody(id, jolt.EActivation_DontActivate);
  [settings, half, centre].forEach((it) => jolt.destroy(it));
  return { id, half: [1, 1, 1] };
}

function place(bodies, object, { centre, half }) {
  if (half.some((length, axis) => length !== object.half[axis])) {
    const sides = new jolt.Vec3(...half);
    bodies.SetShape(object.id, new jolt.BoxShape(sides, 0), false, jolt.EActivation_DontActivate);
    jolt.destroy(sides);
    object.half = half;
  }
  const place = new jolt.RVec3(...centre);
  bodies.SetPosition(object.id, place, jolt.EActivation_DontActivate);
  jolt.destroy(place);
}

function pairs({ query, layers }, objects, boxes, groups) {
  const number = (id) => id.GetIndexAndSequenceNumber();
  const numbers = new Map(objects.map(({ id }, body) => [number(id), body]));
  const found = [];
  const collector = new jolt.CollideShapeBodyCollectorJS();
  let asking = 0;
  collector.Reset = () => {};
  collector.AddHit = (id) => found.push([asking, numbers.get(number(jolt.wrapPointer(id, jolt.BodyID)))]);
  boxes.forEach((box, body) => {
    asking = body;
    const [lower, upper] = [new jolt.Vec3(...box.slice(0, 3)), new jolt.Vec3(...box.slice(3))];
    const asked = new jolt.AABox(lower, upper);
    const filter = groups ? new jolt.DefaultObjectLayerFilter(layers, body) : anyObject;
    query.CollideAABox(asked, collector, anyLayer, filter);
    [asked, lower, upper].forEach((it) => jolt.destroy(it));
    if (groups) jolt.destroy(filter);
  });
  jolt.destroy(collector);
  return found;
}
