"""Pairs of boxes by other libraries: each class is made once for a number of boxes and called once
per frame.

Making it is not timed. A call takes boxes of shape (n, 6), float32, and returns the pairs i < j as
rows of two, in any order, or what can be asked whether it has them. ``most`` is the largest number
of boxes that is timed in reasonable time.
"""

from __future__ import annotations

from importlib.metadata import version

import numpy as np

Array = np.ndarray


class Sdop:
    """``sdop.box_pairs``: nothing is kept from frame to frame."""

    name, package = "sdop.box_pairs", "sdop"
    most = 1_000_000

    def __init__(self, boxes: Array):
        import sdop

        self.box_pairs = sdop.box_pairs

    def __call__(self, boxes: Array) -> Array:
        return self.box_pairs(boxes)


class SdopFrames(Sdop):
    """``sdop.BoxCuller``: what one frame finds serves the next."""

    name = "sdop.BoxCuller"

    def __init__(self, boxes: Array):
        import sdop

        self.box_pairs = sdop.BoxCuller().cull


class Numpy:
    """Every pair, one row against all later ones at a time."""

    name, package = "numpy, all pairs", "numpy"
    most = 10_000

    def __init__(self, boxes: Array):
        pass

    def __call__(self, boxes: Array) -> Array:
        lower, upper = boxes[:, :3], boxes[:, 3:]
        found = []
        for i in range(len(boxes) - 1):
            meets = (lower[i + 1 :] <= upper[i]).all(axis=1) & (upper[i + 1 :] >= lower[i]).all(axis=1)
            later = np.flatnonzero(meets) + (i + 1)
            found.append(np.column_stack([np.full(len(later), i), later]))
        return np.concatenate(found)


class PrTree:
    """One tree per frame, and one query for all boxes."""

    name, package = "python-prtree", "python-prtree"
    most = 100_000

    def __init__(self, boxes: Array):
        from python_prtree import PRTree3D

        self.tree = PRTree3D
        self.numbers = np.arange(len(boxes))

    def __call__(self, boxes: Array) -> Array:
        found = self.tree(self.numbers, boxes).batch_query(boxes)
        first = np.repeat(self.numbers, [len(near) for near in found])
        second = np.fromiter((j for near in found for j in near), dtype=np.int64, count=len(first))
        return np.column_stack([first, second])[first < second]


class Rtree:
    """One index per frame, loaded in bulk, and one query for all boxes."""

    name, package = "Rtree", "rtree"
    most = 100_000

    def __init__(self, boxes: Array):
        from rtree import index

        self.index = index
        self.properties = index.Property(dimension=3)
        self.numbers = np.arange(len(boxes))

    def __call__(self, boxes: Array) -> Array:
        wide = boxes.astype(np.float64)
        lower, upper = wide[:, :3].copy(), wide[:, 3:].copy()
        stream = (self.numbers, lower, upper)
        tree = self.index.Index(stream, properties=self.properties)
        found, counts = tree.intersection_v(lower, upper)
        first = np.repeat(self.numbers, counts.astype(np.int64))
        return np.column_stack([first, found])[first < found]


def centres_and_sides(boxes: Array) -> tuple[Array, Array]:
    wide = boxes.astype(np.float64)
    return (wide[:, :3] + wide[:, 3:]) / 2, wide[:, 3:] - wide[:, :3]


class PythonFcl:
    """A tree of objects, moved in each frame, and its call for all pairs. It calls Python once per
    candidate, with an object that can be known by its centre alone.
    """

    name, package = "python-fcl, broad phase", "python-fcl"
    most = 10_000

    def __init__(self, boxes: Array):
        import fcl

        _, sides = centres_and_sides(boxes)
        self.objects = [fcl.CollisionObject(fcl.Box(*it), fcl.Transform()) for it in sides]
        self.manager = fcl.DynamicAABBTreeCollisionManager()
        self.manager.registerObjects(self.objects)
        self.manager.setup()

    def __call__(self, boxes: Array) -> Array:
        centres, _ = centres_and_sides(boxes)
        for it, centre in zip(self.objects, centres, strict=True):
            it.setTranslation(centre)
        self.manager.update(self.objects)
        numbers = {tuple(centre): number for number, centre in enumerate(centres.tolist())}
        found = []

        def take(a: object, b: object, _: object) -> bool:
            found.append((numbers[tuple(a.getTranslation().tolist())], numbers[tuple(b.getTranslation().tolist())]))
            return False

        self.manager.collide(None, take)
        return np.sort(np.array(found, dtype=np.int64).reshape(-1, 2), axis=1)


class Coal:
    """The same by coal, whose Python can't be called back, nor read the pairs that were collected:
    it says how many there are, and whether two objects are one. So its time is without handing them
    out.
    """

    name, package = "coal, broad phase", "coal"
    most = 10_000

    def __init__(self, boxes: Array):
        import coal

        self.collect = coal.CollisionCallBackCollect
        _, sides = centres_and_sides(boxes)
        self.objects = [coal.CollisionObject(coal.Box(*it)) for it in sides]
        self.manager = coal.DynamicAABBTreeCollisionManager()
        for it in self.objects:
            self.manager.registerObject(it)
        self.manager.setup()

    def __call__(self, boxes: Array) -> Collected:
        centres, _ = centres_and_sides(boxes)
        for it, centre in zip(self.objects, centres, strict=True):
            it.setTranslation(centre)
            it.computeAABB()
        self.manager.update()
        collected = self.collect(64 * len(boxes))
        self.manager.collide(collected)
        return Collected(collected, self.objects)


class Collected:
    """Pairs that coal has found and doesn't hand out."""

    def __init__(self, collected: object, objects: list):
        self.collected, self.objects = collected, objects

    def is_same(self, pairs: Array) -> bool:
        """Whether these pairs are all that were found."""
        it = self.objects
        exist = self.collected.exist
        return self.collected.numCollisionPairs() == len(pairs) and all(
            exist(it[i], it[j]) or exist(it[j], it[i]) for i, j in pairs.tolist()
        )


LIBRARIES = [Sdop, SdopFrames, PrTree, Rtree, Coal, PythonFcl, Numpy]


def version_of(library: type) -> str:
    return version(library.package)
