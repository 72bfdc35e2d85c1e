"""Bullet by pybullet: getOverlappingObjects, which asks the broad phase, for a box shape per
body."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))

import numpy as np
import pybullet
from wire import Culler, centres_and_halves, serve

WORLD = None if "--version" in sys.argv else pybullet.connect(pybullet.DIRECT)


class Adapter(Culler):
    def frame(self, boxes):
        centres, halves = centres_and_halves(boxes, np.float32)
        pybullet.resetSimulation()
        numbers = {}
        for number, (centre, half) in enumerate(zip(centres.tolist(), halves.tolist(), strict=True)):
            shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half)
            numbers[pybullet.createMultiBody(0, shape, basePosition=centre)] = number
        pybullet.performCollisionDetection()
        found = []
        for number, box in enumerate(boxes.astype(float).tolist()):
            near = pybullet.getOverlappingObjects(box[:3], box[3:]) or []
            found += [(number, numbers[body]) for body, _ in near]
        return self.pairs(found)


if __name__ == "__main__":
    serve(Adapter, "pybullet")
