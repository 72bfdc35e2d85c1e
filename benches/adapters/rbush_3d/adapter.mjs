// rbush-3d: one tree for all frames, from which boxes are removed and into which they are inserted,
// and one search for each box.

import { RBush3D } from "rbush-3d";
import { serve } from "../wire.mjs";

const KEYS = ["minX", "minY", "minZ", "maxX", "maxY", "maxZ"];

await serve("rbush-3d", ({ boxes, objects, gone, kept }) => {
  const tree = (kept.tree ??= new RBush3D());
  gone.forEach((entry) => tree.remove(entry));
  boxes.forEach((box, number) => {
    if (objects[number]) tree.remove(objects[number]);
    objects[number] = Object.fromEntries(KEYS.map((key, end) => [key, box[end]]));
    tree.insert(objects[number]);
  });
  const numbers = new Map(objects.map((entry, number) => [entry, number]));
  return objects.flatMap((entry, number) => tree.search(entry).map((other) => [number, numbers.get(other)]));
});
