"""python-fcl: the dynamic tree of boxes, and its call for all pairs."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))

import fcl
import numpy as np
from wire import CaseSkipped, Culler, centres_and_halves, serve


class Adapter(Culler):
    def frame(self, boxes):
        centres, halves = centres_and_halves(boxes)
        # An object in a callback can only be identified by its position.
        numbers = {tuple(centre): number for number, centre in enumerate((centres + 0.0).tolist())}
        if len(numbers) < len(boxes):
            raise CaseSkipped("two boxes have one centre, and python-fcl's callback does not tell them apart")
        manager = fcl.DynamicAABBTreeCollisionManager()
        objects = [
            fcl.CollisionObject(fcl.Box(*2.0 * half), fcl.Transform(np.eye(3), centre))
            for half, centre in zip(halves, centres + 0.0, strict=True)
        ]
        manager.registerObjects(objects)
        manager.setup()
        found = []

        def take(a, b, _):
            found.append([numbers[tuple(it.getTranslation().tolist())] for it in (a, b)])
            return False

        manager.collide(None, take)
        return self.pairs(found)


if __name__ == "__main__":
    serve(Adapter, "python-fcl")
