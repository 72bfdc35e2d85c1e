"""coal: one dynamic tree of boxes for all frames, and its calls for one object's pairs
and for all pairs, whose numbers must agree."""

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
        # Its Python does not return the pairs. It says whether one is among them, by a search of
        # the list, which takes too long where all pairs are in one list.
        found = [(i, j) for i, near in enumerate(map(self.near, self.objects)) for j in range(i) if self.is_in(near, i, j)]
        assert len(found) == collected.numCollisionPairs()
        return found

    def near(self, it):
        collected = coal.CollisionCallBackCollect(len(self.objects) + 1)
        self.manager.collide(it, collected)
        return collected

    def is_in(self, collected, i, j):
        one, other = self.objects[i], self.objects[j]
        return collected.exist(one, other) or collected.exist(other, one)


if __name__ == "__main__":
    serve(Adapter, "coal")
