"""Collision culling that never misses a touching pair, and an exact judge for any culler.

>>> import numpy as np, sdop
>>> boxes = np.array([[0, 0, 0, 1, 1, 1], [1, 0, 0, 2, 1, 1], [5, 5, 5, 6, 6, 6]], dtype=np.float32)
>>> sdop.box_pairs(boxes)
array([[0, 1]], dtype=uint32)

>>> corners, triangles = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
>>> shape = sdop.Shape(corners, triangles)
>>> culler = sdop.Culler([shape], body_shapes=[0, 0, 0], dynamic=[True, True, False])
>>> rotations, translations = [[0, 0, 0, 1]] * 3, [[0, 0, 0], [0.5, 0, 0], [9, 0, 0]]
>>> culler.cull(rotations, translations)
array([[0, 1]], dtype=uint32)
>>> sdop.exact_meet(shape, (rotations[0], translations[0]), shape, (rotations[1], translations[1]))
True

>>> world = sdop.World([shape])
>>> i, j = [world.insert(0, rotations[k], translations[k], margin=0.01) for k in (0, 1)]
>>> world.cull().tolist() == world.events().begun.tolist() == [[i, j]]
True
>>> index = sdop.QueryIndex()
>>> index.update(world)
>>> index.touching_balls([[2, 0, 0]], radii=[0.5]).tolist() == [[0, j]]
True

Lengths have any one unit. Axes are right-handed; rotations are quaternions x, y, z, w of any
non-zero norm that turn a body's frame into the world's. Arrays are float32 or float64. No pair of
float64 input is missed: boxes that float32 can't hold are rounded outward, and bodies are grown by
what rounding their rotations, translations or vertices may move. float32 input isn't changed; with
`exact=True`, a call rejects numbers that float32 can't hold.

Classes may be used from several threads; calls on one object take turns, and other threads of
Python run meanwhile. Arrays are read in place: don't write to one while a call reads it.
"""

from __future__ import annotations

from ._sdop import (
    BoxCuller,
    BoxWorld,
    CaseSkipped,
    Compound,
    Culler,
    Events,
    PartCuller,
    PeriodicBoxes,
    PeriodicEvents,
    PeriodicWorld,
    QueryIndex,
    Scene,
    SdopError,
    Shape,
    World,
    __version__,
    box_pairs,
    exact_meet,
    rounded_outward,
)
from .collision import CollisionManager
from .laboratory import MissedPair, Verdict, cost, judge, tradeoff

__all__ = [
    "BoxCuller",
    "BoxWorld",
    "CaseSkipped",
    "CollisionManager",
    "Compound",
    "Culler",
    "Events",
    "MissedPair",
    "PartCuller",
    "PeriodicBoxes",
    "PeriodicEvents",
    "PeriodicWorld",
    "QueryIndex",
    "Scene",
    "SdopError",
    "Shape",
    "Verdict",
    "World",
    "__version__",
    "box_pairs",
    "cost",
    "exact_meet",
    "judge",
    "rounded_outward",
    "tradeoff",
]
