"""python-fcl: one dynamic tree of boxes for all frames, and its call for all pairs."""

import fcl
import numpy as np
from wire import CaseSkipped, ObjectCuller, centres_and_halves, cover, serve


class Adapter(ObjectCuller):
    def __init__(self, scene):
        super().__init__(scene)
        self.manager = fcl.DynamicAABBTreeCollisionManager()

    def frame(self, boxes):
        centres, _ = centres_and_halves(boxes)
        # An object in a callback can only be identified by its position.
        self.numbers = {tuple(centre): number for number, centre in enumerate((centres + 0.0).tolist())}
        if len(self.numbers) < len(boxes):
            raise CaseSkipped("two boxes have one centre, and python-fcl's callback does not tell them apart")
        return super().frame(boxes)

    def placed(self, it, box):
        (centre,), (half,) = centres_and_halves(box[None])
        if it is not None and cover(it[1], half):
            it[0].setTranslation(centre + 0.0)
            self.manager.update(it[0])
            return it
        if it is not None:
            self.remove(it)
        made = fcl.CollisionObject(fcl.Box(*2.0 * half), fcl.Transform(np.eye(3), centre + 0.0))
        self.manager.registerObject(made)
        return made, half

    def remove(self, it):
        self.manager.unregisterObject(it[0])

    def found(self, boxes):
        self.manager.setup()
        found = []

        def take(a, b, _):
            found.append([self.numbers[tuple(it.getTranslation().tolist())] for it in (a, b)])
            return False

        self.manager.collide(None, take)
        return found


if __name__ == "__main__":
    serve(Adapter, "python-fcl")
