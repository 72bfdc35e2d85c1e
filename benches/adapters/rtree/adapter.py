"""Rtree: one index for all frames, loaded in bulk and then changed by deletions and insertions, and
one query for each box."""

from rtree import index
from wire import ObjectCuller, serve


class Adapter(ObjectCuller):
    """An object is an entry: its id and its box."""

    tree = None

    def frame(self, boxes):
        if self.tree is None and len(boxes):
            self.next, wide = len(boxes), boxes.astype(float).tolist()
            properties = index.Property(dimension=3)
            self.tree = index.Index(((number, box, None) for number, box in enumerate(wide)), interleaved=True, properties=properties)
            self.objects = list(enumerate(wide))
        return super().frame(boxes)

    def placed(self, it, box):
        wide = box.astype(float).tolist()
        if it is None:
            it, self.next = (self.next, None), self.next + 1
        if it[1] != wide:
            self.remove(it)
            self.tree.insert(it[0], wide)
        return it[0], wide

    def remove(self, it):
        if it[1] is not None:
            self.tree.delete(*it)

    def found(self, boxes):
        numbers = {identity: number for number, (identity, _) in enumerate(self.objects)}
        return [(numbers[identity], numbers[other]) for identity, box in self.objects for other in self.tree.intersection(box)]


if __name__ == "__main__":
    serve(Adapter, "Rtree")
