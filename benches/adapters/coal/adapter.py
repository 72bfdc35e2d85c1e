"""coal: the dynamic tree of boxes, and its call for all pairs."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))

import coal
from wire import Culler, centres_and_halves, serve


class Adapter(Culler):
    def frame(self, boxes):
        centres, halves = centres_and_halves(boxes)
        objects = []
        manager = coal.DynamicAABBTreeCollisionManager()
        for half, centre in zip(halves, centres, strict=True):
            it = coal.CollisionObject(coal.Box(*2.0 * half))
            it.setTranslation(centre)
            it.computeAABB()
            objects.append(it)
            manager.registerObject(it)
        manager.setup()
        collected = coal.CollisionCallBackCollect(len(boxes) ** 2 + 1)
        manager.collide(collected)
        # Its Python does not return the pairs; it says whether one is among them.
        has = collected.exist
        n = range(len(boxes))
        found = [(i, j) for i in n for j in n if i < j and (has(objects[i], objects[j]) or has(objects[j], objects[i]))]
        assert len(found) == collected.numCollisionPairs()
        return self.pairs(found)


if __name__ == "__main__":
    serve(Adapter, "coal")
