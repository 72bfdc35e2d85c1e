"""coal: one dynamic tree of boxes for all frames, and its call for all pairs."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))

import coal
from wire import ObjectCuller, centres_and_halves, serve


class Adapter(ObjectCuller):
    def __init__(self, scene):
        super().__init__(scene)
        self.manager = coal.DynamicAABBTreeCollisionManager()

    def placed(self, it, box):
        (centre,), (half,) = centres_and_halves(box[None])
        shape = coal.Box(*2.0 * half)
        if it is None:
            it = coal.CollisionObject(shape)
            put_in = self.manager.registerObject
        else:
            it.setCollisionGeometry(shape, True)
            put_in = self.manager.update
        it.setTranslation(centre)
        it.computeAABB()
        put_in(it)
        return it

    def remove(self, it):
        self.manager.unregisterObject(it)

    def found(self, boxes):
        self.manager.setup()
        collected = coal.CollisionCallBackCollect(len(boxes) ** 2 + 1)
        self.manager.collide(collected)
        # Its Python does not return the pairs; it says whether one is among them.
        has, objects = collected.exist, self.objects
        n = range(len(boxes))
        found = [(i, j) for i in n for j in n if i < j and (has(objects[i], objects[j]) or has(objects[j], objects[i]))]
        assert len(found) == collected.numCollisionPairs()
        return found


if __name__ == "__main__":
    serve(Adapter, "coal")
