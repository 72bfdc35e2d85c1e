"""What all adapters share: a culler's bodies, and the judge's wire.

An adapter is a class like those that `sdop.judge` takes: it is made of a scene, and its ``frame`` returns the pairs of a frame.
``serve`` makes a program of it that ``sdop judge`` runs; ``board.py`` hands it to `sdop.judge`.
"""

from __future__ import annotations

import json
import sys
from types import SimpleNamespace

import numpy as np

try:
    from sdop import CaseSkipped
except ImportError:

    class CaseSkipped(Exception):
        """The library does not claim to do this case."""


Array = np.ndarray


class Culler:
    """The bodies of a case: their shapes, and which of them may move."""

    def __init__(self, scene: SimpleNamespace):
        self.shapes = scene.shapes
        self.body_shapes, self.dynamic = np.asarray(scene.body_shapes), np.asarray(scene.dynamic)

    def change(self, body_shapes: Array, dynamic: Array, was: Array) -> None:
        self.body_shapes, self.dynamic = np.asarray(body_shapes), np.asarray(dynamic)

    def pairs(self, found: object) -> Array:
        """Pairs that a library has found, in any order and maybe twice, as the judge takes them."""
        rows = np.sort(np.asarray(found, dtype=np.int64).reshape(-1, 2), axis=1)
        rows = np.unique(rows[rows[:, 0] < rows[:, 1]], axis=0)
        return rows[self.dynamic[rows].any(axis=1)]


def centres_and_sides(boxes: Array) -> tuple[Array, Array]:
    """Boxes by their centres and sides in float64; skips a case whose boxes that can't hold."""
    lower, upper = boxes.astype(np.float64)[:, :3], boxes.astype(np.float64)[:, 3:]
    centres, sides = (lower + upper) / 2, upper - lower
    if not (np.array_equal(centres - sides / 2, lower) and np.array_equal(centres + sides / 2, upper)):
        raise CaseSkipped("float64 can't hold the boxes as centres and sides")
    return centres, sides


def serve(make: type[Culler]) -> None:
    """Answers a case on standard input, in the encoding ndjson."""
    head = json.loads(sys.stdin.readline())
    culler = None
    shapes = [{**it, "ball": (it["ball"][:3], it["ball"][3])} for it in head["shapes"]]
    bodies = head["bodies"]
    for line in sys.stdin:
        frame = json.loads(line)
        was = [body.get("was", -1) for body in frame.get("bodies", [])]
        bodies = frame.get("bodies", bodies)
        numbers, dynamic = [body["shape"] for body in bodies], [not body["static"] for body in bodies]
        try:
            if culler is None:
                culler = make(SimpleNamespace(shapes=shapes, body_shapes=numbers, dynamic=dynamic))
            elif "bodies" in frame:
                culler.change(numbers, dynamic, np.array(was))
            poses = np.array(frame["poses"], dtype=np.float32).reshape(-1, 7)
            given = (np.array(frame["boxes"], np.float32).reshape(-1, 6),) if "boxes" in frame else (poses[:, :4], poses[:, 4:])
            answer = {"pairs": culler.frame(*given).tolist()}
        except CaseSkipped as reason:
            answer = {"skipped": str(reason)}
        print(json.dumps({"frame": frame["frame"], **answer}), flush=True)
        if "skipped" in answer:
            return
