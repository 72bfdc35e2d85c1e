"""Three tables as JSON: what a call costs beyond Rust, pairs of boxes, and pairs of equal balls, by
`sdop` and by other libraries.

    python python/bench/tables.py > python.json
    python python/bench/tables.py --quick      # small sizes and few rounds: a trial

Every answer is checked before anything is timed. Then all take turns, each round in another order,
on the same frames; a figure is the median over the rounds, with a 95 per cent interval from order
statistics, which assumes nothing about the distribution. `python/bench/run` makes an environment
with the pinned libraries and a wheel of release quality.
"""

from __future__ import annotations

import argparse
import json
import platform
import random
import time
from collections.abc import Callable
from math import comb

import numpy as np
import sdop
import spheres
from libraries import LIBRARIES, Array, Collected, version_of

FRAMES = 8
"""Frames that a round goes through at most; the time is per frame."""
SLOW = 0.1
"""Seconds per frame above which a library goes through one frame per round, in fewer rounds."""
FEW_ROUNDS = 7
PAIRS_PER_BOX = 2.0
SEED = 44


def median(values: list[float]) -> dict[str, float]:
    """The median, and the order statistics that cover it with 95 per cent; below six rounds the
    least and the largest."""
    ordered, n = sorted(values), len(values)
    below = [sum(comb(n, k) for k in range(cut + 1)) / 2**n for cut in range(n)]
    cut = max((cut for cut in range(n // 2) if below[cut] <= 0.025), default=-1) + 1
    return {"median": float(np.median(ordered)), "low": ordered[max(cut - 1, 0)], "high": ordered[n - max(cut, 1)], "rounds": n}


def frames_of_boxes(n: int) -> list[Array]:
    """Boxes of sides 0.5 to 2 that drift, in a space that gives about `PAIRS_PER_BOX`.

    All numbers are multiples of 2⁻¹⁰, so that sides stay the same in float32 and centres are exact:
    some libraries take those.
    """
    draws = np.random.default_rng(SEED)

    def grid(values: Array) -> Array:
        return np.round(values * 1024) / 1024

    sides = grid(draws.uniform(0.5, 2.0, (n, 3)))
    # Two boxes meet in a share (E[a + b] / extent)³ of the space: 2.5 on average along each axis.
    extent = (n * 2.5**3 / (2 * PAIRS_PER_BOX)) ** (1 / 3)
    lower = grid(draws.uniform(0, extent, (n, 3)))
    speed = grid(draws.normal(0, 0.05, (n, 3)))
    places = [lower + t * speed for t in range(FRAMES)]
    return [np.hstack([place, place + sides]).astype(np.float32) for place in places]


def in_order(pairs: Array) -> Array:
    rows = np.asarray(pairs, dtype=np.int64)
    return rows[np.lexsort((rows[:, 1], rows[:, 0]))]


def check(name: str, answer: Array | Collected, wanted: Array) -> None:
    is_same = answer.is_same(wanted) if isinstance(answer, Collected) else np.array_equal(in_order(answer), wanted)
    if not is_same:
        raise SystemExit(f"{name} has other pairs than the reference: no time is worth printing")


def in_turns(calls: dict[str, Callable[[], float]], rounds: dict[str, int]) -> dict[str, list[float]]:
    """Each call's values, one per round; a first round warms up."""
    taken: dict[str, list[float]] = {name: [] for name in calls}
    order = random.Random(SEED)
    for turn in range(max(rounds.values()) + 1):
        for name in order.sample(sorted(calls), len(calls)):
            if turn > rounds[name]:
                continue
            value = calls[name]()
            if turn:
                taken[name].append(value)
    return taken


def compared(made: dict[str, Callable[[Array], object]], reference: str, frames: list[Array], rounds: int) -> tuple[float, dict[str, dict]]:
    """Pairs per frame, and each library's seconds per frame, also as multiples of the first one's.
    Answers are checked by those of `reference`.
    """
    counted = 0
    slowest = dict.fromkeys(made, 0.0)
    for frame in frames:
        wanted = in_order(made[reference](frame))
        counted += len(wanted)
        for name, call in made.items():
            start = time.perf_counter()
            answer = call(frame)
            slowest[name] = max(slowest[name], time.perf_counter() - start)
            check(name, answer, wanted)

    def timed(call: Callable[[Array], object], shown: list[Array]) -> Callable[[], float]:
        def run() -> float:
            start = time.perf_counter()
            for frame in shown:
                call(frame)
            return (time.perf_counter() - start) / len(shown)

        return run

    slow = {name for name, seconds in slowest.items() if seconds > SLOW}
    calls = {name: timed(call, frames[:1] if name in slow else frames) for name, call in made.items()}
    taken = in_turns(calls, {name: min(rounds, FEW_ROUNDS) if name in slow else rounds for name in made})
    ours = taken[next(iter(made))]

    def times(values: list[float]) -> dict:
        ratios = [value / our for value, our in zip(values, ours, strict=False)]
        return {"seconds": median(values), "times_ours": median(ratios)}

    return counted / len(frames), {name: times(values) for name, values in taken.items()}


def box_pairs(n: int, rounds: int) -> list[dict]:
    frames = frames_of_boxes(n)
    known = {it.name: it for it in LIBRARIES if n <= it.most}
    reference = "numpy, all pairs" if "numpy, all pairs" in known else "sdop.box_pairs"
    pairs, taken = compared({name: it(frames[0]) for name, it in known.items()}, reference, frames, rounds)
    return [
        {"boxes": n, "library": name, "version": version_of(known[name]), "pairs_per_frame": pairs, **times}
        for name, times in taken.items()
    ]


def sphere_pairs(n: int, is_periodic: bool, rounds: int) -> list[dict]:
    frames, side = spheres.frames_of_points(n, FRAMES, PAIRS_PER_BOX, SEED)
    period = side if is_periodic else None
    known = {it.name: it for it in spheres.LIBRARIES if n <= it.most}
    pairs, taken = compared({name: it(frames[0], period) for name, it in known.items()}, spheres.REFERENCE.name, frames, rounds)
    return [
        {"balls": n, "periodic": is_periodic, "library": name, "version": version_of(known[name]), "pairs_per_frame": pairs, **times}
        for name, times in taken.items()
    ]


def overhead(n: int, rounds: int) -> list[dict]:
    """A call's time without what the Rust function took inside of the same call."""
    rows = []
    boxes = frames_of_boxes(n)
    culler = sdop.BoxCuller()
    rows.append({"call": "BoxCuller.cull", "bodies": n, **beyond(lambda t: culler.cull(boxes[t]), culler, rounds)})
    corners = np.float32([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    shape = sdop.Shape(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    bodies = sdop.Culler([shape], np.zeros(n, np.uint32))
    draws = np.random.default_rng(SEED)
    rotations = draws.normal(size=(n, 4)).astype(np.float32)
    places = [np.ascontiguousarray(frame[:, :3]) for frame in boxes]
    rows.append({"call": "Culler.cull", "bodies": n, **beyond(lambda t: bodies.cull(rotations, places[t]), bodies, rounds)})
    return rows


def beyond(call: Callable[[int], Array], culler: sdop.BoxCuller | sdop.Culler, rounds: int) -> dict:
    whole, rust, over, pairs = [], [], [], 0
    for turn in range(rounds + 1):
        seconds, inside, pairs = 0.0, 0.0, 0
        for t in range(FRAMES):
            start = time.perf_counter()
            found = call(t)
            seconds += time.perf_counter() - start
            inside += culler.seconds
            pairs += len(found)
        if turn:
            whole.append(seconds / FRAMES)
            rust.append(inside / FRAMES)
            over.append((seconds - inside) / FRAMES)
    share = [more / inside for more, inside in zip(over, rust, strict=True)]
    figures = {"seconds": whole, "rust": rust, "beyond": over, "share": share}
    return {"pairs_per_frame": pairs / FRAMES, **{name: median(values) for name, values in figures.items()}}


def machine() -> dict:
    cpu = platform.processor()
    try:
        with open("/proc/cpuinfo") as file:
            cpu = next(line.split(":")[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        pass
    return {"cpu": cpu, "system": platform.platform(), "python": platform.python_version(), "numpy": np.__version__}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="small sizes and few rounds")
    parser.add_argument("--sizes", type=int, nargs="+", help="numbers of boxes and balls, without the first table")
    arguments = parser.parse_args()
    quick = arguments.quick
    sizes = arguments.sizes or ([100, 1_000] if quick else [1_000, 10_000, 100_000])
    rounds = 5 if quick else 21
    called = [] if arguments.sizes else [500] if quick else [500, 100_000]
    record = {
        "machine": machine(),
        "overhead": [row for n in called for row in overhead(n, rounds)],
        "box_pairs": [row for n in sizes for row in box_pairs(n, rounds)],
        "sphere_pairs": [row for n in sizes for periodic in (False, True) for row in sphere_pairs(n, periodic, rounds)],
    }
    print(json.dumps(record, indent=1))


if __name__ == "__main__":
    main()
