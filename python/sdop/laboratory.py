"""The judge and the measurements."""

from __future__ import annotations

import csv
import io
import json
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _sdop
from ._sdop import Scene, SdopError


@dataclass(frozen=True)
class MissedPair:
    """The smallest case that a culler still fails."""

    case: str
    frame: int
    pair: tuple[int, int]
    point: tuple[float, float, float] | None
    """A point that both bodies share, rounded to float64."""
    depth_ulps: int | None
    """The least shift that separates them, in float32 steps at the pair; None if all tried shifts
    were too short."""
    boxes: NDArray[np.float32] = field(repr=False)
    """The boxes of that frame, shape (n, 6)."""
    files: dict[str, bytes] = field(repr=False)
    """The case for ``sdop view`` and ``sdop judge --replay``, and its meshes."""

    def save(self, folder: str | os.PathLike[str]) -> None:
        """Writes the files into a folder, which must exist."""
        for name, content in self.files.items():
            Path(folder, name).write_bytes(content)


@dataclass(frozen=True)
class Verdict:
    """The judge's verdict on a culler; true if it is a pass."""

    passed: bool
    text: str = field(repr=False)
    """The summary, as the command prints it."""
    data: dict[str, Any] = field(repr=False)
    """Every case, in the form of the command's ``--format json``."""
    missed: MissedPair | None = None
    """The smallest case of a miss, if there is one."""

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        return self.text

    @property
    def cases(self) -> list[dict[str, Any]]:
        """A row for each case that was run."""
        cases: list[dict[str, Any]] = self.data["cases"]
        return cases


def judge(
    make: Callable[[Scene], Any],
    claims: _sdop._Claim = "mesh",
    *,
    cases: str = "*",
    seed: int | None = None,
    extra_limit: float | None = None,
    fail_fast: bool = False,
) -> Verdict:
    """Judges a culler against the exact reference.

    Parameters
    ----------
    make : a class, or anything else that makes a culler of a `Scene`
        The culler has ``frame(rotations, translations)``, or with a claim about boxes
        ``frame(boxes)``, which returns the pairs i < j as an array of shape (m, 2). If its set of
        bodies can change, it has ``change(body_shapes, dynamic, was)``, where ``was`` holds each
        body's former number, or -1. Cases that need a method which it lacks are skipped. A culler
        that can't answer a case raises `CaseSkipped` with the reason.
    claims : str
        What it never misses, touching included:

        - "mesh": meshes that share a point, or one in a closed part of the other
        - "hull", "or-dop", "sphere": convex hulls, oriented k-DOPs, or balls that share a point
        - "aabb": boxes that share a point, which all claims below are about, except for "parts"
        - "filter": without pairs excluded by ``filter(groups, excluded)``, given before a frame
        - "margin": boxes nearer on each axis than both ``margins(margins)`` reach
        - "order": the same pairs in whatever order bodies come
        - "restore": the same pairs again after ``save()`` and ``restore()``
        - "periodic": any image of a box, with ``periods(periods)``: a period or None for each axis
        - "parts": as "mesh" for bodies of several shapes, with ``body_parts(parts)``: for each body
          a list of (shape number, pose), which is empty for a body that is its shape alone
    cases : str
        Names of cases; ``*`` matches any text.
    seed : int, optional
        Adds fresh cases.
    extra_limit : float, optional
        The most extra pairs for each required one; otherwise they are only counted.
    fail_fast : bool
        Whether to stop at the first failure.
    """
    passed, text, data, smallest = _sdop.judge(make, claims, cases, seed, extra_limit, fail_fast)
    if smallest is None:
        return Verdict(passed, text, json.loads(data))
    found, boxes, files = smallest
    missed = MissedPair(**json.loads(found), boxes=boxes, files={name: bytes(content) for name, content in files})
    return Verdict(passed, text, json.loads(data), missed)


def cost(scene: str | os.PathLike[str], *flags: str) -> list[dict[str, str | float]]:
    """What each strategy costs on a scene: T = Nu·Cu + Nv·Cv + Co (+ F), predicted and measured.

    Parameters
    ----------
    scene : path of a scene file
    flags : str
        Further flags of ``sdop cost``, such as ``"--strategy=s-dop-batch"``.

    Returns
    -------
    list of dict
        The rows of ``sdop cost --format csv``, for ``pandas.DataFrame``.
    """
    return _rows("cost", scene, *flags)


def tradeoff(scene: str | os.PathLike[str], *flags: str) -> list[dict[str, str | float]]:
    """What accuracy costs in time on a scene, for every volume and strategy.

    Parameters and result as for `cost`; the rows are those of ``sdop tradeoff --format csv``.
    """
    return _rows("tradeoff", scene, *flags)


def _rows(name: str, scene: str | os.PathLike[str], *flags: str) -> list[dict[str, str | float]]:
    """Runs the command in a separate process, which can be interrupted, and reads its table."""
    with open(scene):  # a missing file is a FileNotFoundError
        pass
    command = [sys.executable, "-m", "sdop", name, os.fspath(scene), *flags, "--format", "csv"]
    run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, encoding="utf-8")
    if run.returncode == 2:
        raise SdopError(run.stderr.strip())
    table = csv.DictReader(io.StringIO(run.stdout))
    return [{name: _number(text) for name, text in row.items()} for row in table]


def _number(text: str) -> str | float:
    try:
        return float(text)
    except ValueError:
        return text
