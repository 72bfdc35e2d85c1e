// Do Oimo.js's three broad phases find a box's contact with what it meets?
//
//     npm install oimo && node missed_pairs.mjs
//
// First a box falls on a floor, from y = 2; it should rest at 0.5. Then one drifts into another at
// 0.06 per second; a contact should be made when they meet. Only World.add, step and the bodies'
// positions and velocities are used. Exit code 1 if neither shows a missing contact.

import OIMO from "oimo";

function fall(broadphase) {
  const world = new OIMO.World({ broadphase });
  world.add({ size: [10, 1, 10], pos: [0, -0.5, 0] });
  const box = world.add({ size: [1, 1, 1], pos: [0, 2, 0], move: true });
  for (let step = 0; step < 200; step++) world.step();
  return box.getPosition().y;
}

/** How deep the boxes overlap when they have a contact at last, or after 300 steps. */
function drift(broadphase) {
  const world = new OIMO.World({ broadphase, gravity: [0, 0, 0] });
  const [still, box] = [0, 1.05].map((x) => world.add({ size: [1, 1, 1], pos: [x, 0, 0], move: true, neverSleep: true }));
  box.linearVelocity.set(-0.06, 0, 0);
  let depth = 0;
  for (let step = 0; step < 300 && world.numContacts === 0; step++) {
    depth = 1 - (box.getPosition().x - still.getPosition().x);
    world.step();
  }
  return depth;
}

console.log("oimo", OIMO.REVISION);
const missing = [[1, "all pairs"], [2, "sweep"], [3, "tree"]].filter(([broadphase, name]) => {
  const [y, depth] = [fall(broadphase), drift(broadphase)];
  console.log(`${name}: the box is at y = ${y.toFixed(2)}; the boxes overlap by ${depth.toFixed(3)} before they have a contact`);
  return y < 0 || depth > 0.01;
});
process.exit(missing.length === 0 ? 1 : 0);
