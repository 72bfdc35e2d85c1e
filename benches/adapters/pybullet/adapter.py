"""Bullet by pybullet, with a box shape per body in one world for all frames: getOverlappingObjects,
which asks the broad phase, or with the argument `contacts` getContactPoints, which knows masks and
pairs that are not to collide."""

import sys

import numpy as np
import pybullet
from wire import ObjectCuller, centres_and_halves, cover, serve

WORLD = None if "--version" in sys.argv else pybullet.connect(pybullet.DIRECT)
CONTACTS = "contacts" in sys.argv


class Adapter(ObjectCuller):
    """An object is a body's id, and the half sides of its shape."""

    def __init__(self, scene):
        super().__init__(scene)
        pybullet.resetSimulation()

    def frame(self, boxes):
        if self.given.get("restore"):
            pybullet.restoreState(self.saved)
        pairs = super().frame(boxes)
        if self.given.get("save"):
            self.saved = pybullet.saveState()
        return pairs

    def placed(self, it, box):
        (centre,), (half,) = centres_and_halves(box[None], np.float32)
        if it is not None and cover(it[1], half):
            pybullet.resetBasePositionAndOrientation(it[0], centre.tolist(), [0, 0, 0, 1])
            return it
        if it is not None:
            self.remove(it)
        shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half.tolist())
        return pybullet.createMultiBody(1 if CONTACTS else 0, shape, basePosition=centre.tolist()), half

    def remove(self, it):
        pybullet.removeBody(it[0])

    def found(self, boxes):
        numbers = {body: number for number, (body, _) in enumerate(self.objects)}
        if CONTACTS:
            self.filter()
        pybullet.performCollisionDetection()
        if CONTACTS:
            return [(numbers[contact[1]], numbers[contact[2]]) for contact in pybullet.getContactPoints() or []]
        found = []
        for number, box in enumerate(boxes.astype(float).tolist()):
            near = pybullet.getOverlappingObjects(box[:3], box[3:]) or []
            found += [(number, numbers[body]) for body, _ in near]
        return found

    def filter(self):
        signed = np.array(self.given["groups"], np.uint32).astype(np.int32).tolist()
        for (body, _), (group, mask) in zip(self.objects, signed, strict=True):
            pybullet.setCollisionFilterGroupMask(body, -1, group, mask)
        excluded = {tuple(pair) for pair in self.given.get("excluded", [])}
        for pair in getattr(self, "parted", set()) ^ excluded:
            one, other = (self.objects[number][0] for number in pair)
            pybullet.setCollisionFilterPair(one, other, -1, -1, int(pair not in excluded))
        self.parted = excluded


if __name__ == "__main__":
    serve(Adapter, "pybullet")
