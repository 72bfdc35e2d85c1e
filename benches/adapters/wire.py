"""What the adapters in Python share: a culler's bodies, and the judge's wire.

An adapter is a class: it is made of a case's first frame, and its ``frame`` returns the pairs of a
frame. ``serve`` makes a program of it that ``sdop judge --keep`` and ``sdop board`` run.
"""

from __future__ import annotations

import importlib.metadata
import json
import os
import sys
import time
from types import SimpleNamespace
from typing import Any

import numpy as np


class CaseSkipped(Exception):
    """The library does not claim to do this case."""


Array = np.ndarray


class Culler:
    """The bodies of a case: their shapes, and which of them may move."""

    def __init__(self, scene: SimpleNamespace):
        self.shapes = scene.shapes
        self.body_shapes, self.dynamic = np.asarray(scene.body_shapes), np.asarray(scene.dynamic, dtype=bool)

    takes_parts = False
    """Whether its bodies may have parts; without that, cases of the claim parts are skipped."""

    given: dict[str, Any]
    """The frame as the judge gives it, for what a claim adds: groups, excluded pairs, margins,
    periods, and the parts of each body."""

    def change(self, body_shapes: Array, dynamic: Array, was: Array) -> None:
        self.body_shapes, self.dynamic = np.asarray(body_shapes), np.asarray(dynamic, dtype=bool)

    def pairs(self, found: object) -> Array:
        """Pairs that a library has found, in any order and maybe twice, as the judge takes them."""
        i, j = np.asarray(found, dtype=np.int64).reshape(-1, 2).T
        is_asked = (i != j) & (self.dynamic[i] | self.dynamic[j])
        i, j = i[is_asked], j[is_asked]
        # One number per pair: sorting numbers takes a tenth of the time of numpy's unique rows, and
        # this counts as the library's time.
        bodies = max(len(self.dynamic), 1)
        keys = np.sort(np.minimum(i, j) * bodies + np.maximum(i, j))
        keys = keys[np.diff(keys, prepend=-1) > 0]
        return np.stack([keys // bodies, keys % bodies], axis=1)

    def reach(self) -> float:
        """The distance of two bodies' origins within which balls may meet, for libraries that take
        points and one distance: twice the radius where all balls are equal and about the origin.
        More pairs are no failure."""
        balls = [self.shapes[number]["ball"] for number in set(self.body_shapes.tolist())]
        far = [float(np.nextafter(np.linalg.norm(np.asarray(c, np.float64)), np.inf)) if np.any(c) else 0.0 for c, _ in balls]
        sums = [offset + float(np.float32(radius)) for offset, (_, radius) in zip(far, balls, strict=True)]
        return 2.0 * max(float(np.nextafter(it, np.inf)) if offset else it for it, offset in zip(sums, far, strict=True))


class ObjectCuller(Culler):
    """A culler that keeps an object of the library for each body, from frame to frame. An adapter
    has ``placed``, which takes a body's object (``None`` for a new body) and its box and returns
    its object; ``remove`` for the object of a body that goes; and ``found``, all pairs."""

    def __init__(self, scene: SimpleNamespace):
        super().__init__(scene)
        self.objects: list[Any] = [None] * len(self.body_shapes)

    def change(self, body_shapes: Array, dynamic: Array, was: Array) -> None:
        super().change(body_shapes, dynamic, was)
        stay = set(was.tolist())
        for number, gone in enumerate(self.objects):
            if number not in stay:
                self.remove(gone)
        self.objects = [self.objects[number] if number >= 0 else None for number in was.tolist()]

    def frame(self, boxes: Array) -> Array:
        self.objects = [self.placed(it, box) for it, box in zip(self.objects, boxes, strict=True)]
        return self.pairs(self.found(boxes))

    def placed(self, it: Any, box: Array) -> Any:
        raise NotImplementedError

    def remove(self, it: Any) -> None:
        raise NotImplementedError

    def found(self, boxes: Array) -> object:
        raise NotImplementedError


def centres_and_halves(boxes: Array, dtype: type = np.float64) -> tuple[Array, Array]:
    """Centres and half sides of boxes. A box that they can't represent is replaced by a larger one
    around it: additional pairs are no failure."""
    lower, upper = boxes.astype(dtype)[:, :3], boxes.astype(dtype)[:, 3:]
    centres = lower / 2 + upper / 2
    halves = np.maximum(upper - centres, centres - lower)
    while (small := (centres - halves > lower) | (centres + halves < upper)).any():
        halves = np.where(small, np.nextafter(halves, dtype(np.inf)), halves)
    return centres, halves


def in_cell(boxes: Array, periods: list[float | None]) -> tuple[Array, Array, float]:
    """Boxes in space that repeats, for libraries that take points, one cell and one distance.
    Returns the boxes' centres, wrapped into a cell that starts at zero; the sides of the cell; and
    a distance that the centres of two boxes never exceed if the boxes meet, even when rounded to
    float32. Along an axis without a period, the cell is so long that nothing meets across its
    ends."""
    centres, halves = centres_and_halves(boxes)
    repeats = np.array([period is not None for period in periods])
    lengths = np.array([period or 1.0 for period in periods])
    points = np.where(repeats, np.fmod(centres, lengths), centres - centres.min(axis=0))
    points = np.where(points < 0.0, points + lengths, points)
    points = np.where(repeats & (points >= lengths), 0.0, points)
    size = max(float(points.max()), float(lengths.max()))
    reach = 2.0 * float(np.linalg.norm(halves.max(axis=0))) + 2.0**-20 * size
    return points, np.where(repeats, lengths, points.max(axis=0) + 2.0 * reach), reach


def cover(kept: Array, halves: Array) -> bool:
    """Whether half sides that a library has are those of a box, or larger by rounding alone."""
    return bool(((kept >= halves) & (kept <= halves * (1.0 + 2.0**-20))).all())


def serve(make: type[Culler], package: str) -> None:
    """Answers cases on standard input, in the encoding ndjson, until it ends. With `--version`,
    prints the version of a package."""
    if "--version" in sys.argv:
        print(importlib.metadata.version(package))
        return
    # Libraries print to standard output too; what the judge reads goes through a copy of it.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    culler, head = None, None
    for line in sys.stdin:
        frame = json.loads(line)
        if "format" in frame:
            culler, head, changed = None, frame, False
            shapes = [{**it, "ball": (it["ball"][:3], it["ball"][3])} for it in head["shapes"]]
            bodies = head["bodies"]
            continue
        if head is None:
            continue  # the rest of a case that it has skipped
        was = [body.get("was", -1) for body in frame.get("bodies", [])]
        bodies = frame.get("bodies", bodies)
        # A body with parts has the shape of the first; a culler that claims parts takes all of them
        # from `given`.
        parts = [body.get("parts", []) for body in bodies]
        numbers = [body["shape"] if "shape" in body else body["parts"][0]["shape"] for body in bodies]
        dynamic = [not body["static"] for body in bodies]
        poses = np.array(frame["poses"], dtype=np.float32).reshape(-1, 7)
        given = (np.array(frame["boxes"], np.float32).reshape(-1, 6),) if "boxes" in frame else (poses[:, :4], poses[:, 4:])
        start = time.perf_counter_ns()
        try:
            if any(parts) and not make.takes_parts:
                raise CaseSkipped("its bodies are single shapes")
            if changed and "restore" in frame:
                raise CaseSkipped("a state is of the bodies that it was saved with")
            changed = (changed or "bodies" in frame) and "save" not in frame
            if culler is None:
                culler = make(SimpleNamespace(shapes=shapes, body_shapes=numbers, dynamic=dynamic))
            elif "bodies" in frame:
                culler.change(numbers, dynamic, np.array(was))
            culler.given = {**frame, "parts": parts}
            found = culler.frame(*given)
            answer = {"pairs": found.tolist(), "ns": time.perf_counter_ns() - start}
        except CaseSkipped as reason:
            answer, head = {"skipped": str(reason)}, None
        print(json.dumps({"frame": frame["frame"], **answer}), file=answers, flush=True)
