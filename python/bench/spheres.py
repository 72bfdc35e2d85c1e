"""Pairs of equal balls by libraries for particles: each class is made once for a number of balls
and called once per frame.

Making it is not timed. A call takes points of shape (n, 3), float64, and returns the pairs i < j of
those no farther apart than ``REACH``, as rows of two, in any order. ``period`` is the side of the
periodic cell from the origin on, in which all points are, or None. ``most`` is the largest number
of balls that is timed in reasonable time.

Points are multiples of 2⁻⁸, so that their squared distances are multiples of 2⁻¹⁶, and the squared
reach is half a step beyond one of them: no library can round a pair to the other side.
"""

from __future__ import annotations

import numpy as np

Array = np.ndarray

STEP = 2.0**-8
REACH = (1.0 + STEP * STEP / 2.0) ** 0.5
SKIN = 0.25
UNTURNED = np.float32([0, 0, 0, 1])


def ball():
    """A mesh whose smallest ball has the diameter ``REACH`` and its centre at the origin."""
    import sdop

    corners = np.float32([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
    faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    return sdop.Shape(corners, faces, radius=REACH / 2.0)


class Sdop:
    """``sdop.Culler``, or ``sdop.PeriodicWorld``, with the strategy "sphere"."""

    name, package, most = "sdop", "sdop", 1_000_000

    def __init__(self, points: Array, period: float | None):
        import sdop

        self.rotations = np.tile(UNTURNED, (len(points), 1))
        self.world = None
        if period is None:
            self.culler = sdop.Culler([ball()], np.zeros(len(points), np.uint32), strategy="sphere")
        else:
            self.world = sdop.PeriodicWorld([ball()], [period] * 3, strategy="sphere")
            self.ids = np.array([self.world.insert(0, UNTURNED, point) for point in points], np.uint64)

    def __call__(self, points: Array) -> Array:
        if self.world is None:
            return self.culler.cull(self.rotations, points.astype(np.float32))
        self.world.set_poses(self.ids, self.rotations, points)
        found, _ = self.world.cull()
        return np.searchsorted(self.ids, found)


class Vesin:
    """Cell lists in float64."""

    name, package, most = "vesin", "vesin", 1_000_000
    skin = 0.0

    def __init__(self, points: Array, period: float | None):
        from vesin import NeighborList

        self.list = NeighborList(cutoff=REACH, full_list=False, skin=self.skin, n_threads=1)
        self.box = np.eye(3) * (period or 0.0)
        self.is_periodic = period is not None

    def __call__(self, points: Array) -> Array:
        pairs = self.list.compute(points, self.box, self.is_periodic, quantities="P")[0]
        return np.sort(pairs.astype(np.int64), axis=1)


class VesinSkin(Vesin):
    """The same with a list that is kept until a point has moved by half a skin."""

    name, skin = f"vesin, skin {SKIN}", SKIN


class Freud:
    """A tree of boxes in float32. Its cells are always periodic, so that one without a period is
    large enough for nothing to wrap around.
    """

    name, package, most = "freud, AABBQuery", "freud-analysis", 1_000_000

    def __init__(self, points: Array, period: float | None):
        import freud

        freud.parallel.set_num_threads(1)
        self.freud = freud
        self.is_periodic = period is not None
        self.side = period or 2.0 * float(np.abs(points).max()) + 4.0

    def query(self, points: Array):
        return self.freud.AABBQuery(self.freud.box.Box.cube(self.side), points)

    def __call__(self, points: Array) -> Array:
        points = points.astype(np.float32)
        if self.is_periodic:
            points -= self.side / 2.0  # its cell has the origin in the middle
        found = self.query(points).query(points, {"mode": "ball", "r_max": REACH, "exclude_ii": True})
        pairs = found.toNeighborList()[:].astype(np.int64)
        return pairs[pairs[:, 0] < pairs[:, 1]]


class FreudCells(Freud):
    """Cell lists in float32, which take seconds per frame for 10,000 points."""

    name, most = "freud, LinkCell", 1_000

    def query(self, points: Array):
        return self.freud.LinkCell(self.freud.box.Box.cube(self.side), points, REACH)


class Scipy:
    """A k-d tree per frame, in float64; its answer is what the others' are compared with."""

    name, package, most = "scipy, cKDTree", "scipy", 1_000_000

    def __init__(self, points: Array, period: float | None):
        from scipy.spatial import cKDTree

        self.tree, self.period = cKDTree, period

    def __call__(self, points: Array) -> Array:
        return self.tree(points, boxsize=self.period).query_pairs(REACH, output_type="ndarray")


REFERENCE = Scipy
LIBRARIES = [Sdop, Vesin, VesinSkin, Freud, FreudCells, Scipy]


def frames_of_points(n: int, frames: int, pairs_per_ball: float, seed: int) -> tuple[list[Array], float]:
    """Drifting points in a cube from the origin on, and its side, which may be its period."""
    draws = np.random.default_rng(seed)
    # A ball meets those whose centres are within `REACH`, and each pair belongs to two.
    volume = n * (4.0 / 3.0 * np.pi) * REACH**3 / (2.0 * pairs_per_ball)
    side = 2.0 * STEP * round(volume ** (1 / 3) / (2.0 * STEP))

    def grid(values: Array) -> Array:
        return np.round(values / STEP) * STEP

    start, speed = grid(draws.uniform(0, side, (n, 3))), grid(draws.normal(0, 0.02, (n, 3)))
    return [np.mod(start + t * speed, side) for t in range(frames)], side
