"""python-prtree: one tree for all frames, made of the first one's boxes and then changed by erasing
and inserting, and one query for all boxes."""

import numpy as np
from python_prtree import PRTree3D
from wire import ObjectCuller, serve


class Adapter(ObjectCuller):
    """An object is an entry: its id and its box."""

    tree = None

    def frame(self, boxes):
        if self.tree is None and len(boxes):
            self.next = len(boxes)
            self.tree = PRTree3D(np.arange(len(boxes)), boxes)
            self.objects = [(number, box.copy()) for number, box in enumerate(boxes)]
        return super().frame(boxes)

    def placed(self, it, box):
        if it is None:
            it, self.next = (self.next, None), self.next + 1
        if it[1] is None or (it[1] != box).any():
            self.remove(it)
            self.tree.insert(it[0], box)
        return it[0], box.copy()

    def remove(self, it):
        if it[1] is not None:
            self.tree.erase(it[0])

    def found(self, boxes):
        if len(boxes) == 0:
            return []
        numbers = {identity: number for number, (identity, _) in enumerate(self.objects)}
        near = self.tree.batch_query(boxes)
        return [(number, numbers[other]) for number, found in enumerate(near) for other in found]


if __name__ == "__main__":
    serve(Adapter, "python-prtree")
