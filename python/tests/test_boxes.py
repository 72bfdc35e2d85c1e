"""Boxes: the pairs that numpy finds by brute force, and what is refused."""

import hashlib
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import sdop


def boxes(n, seed=0, extent=10.0):
    random = np.random.default_rng(seed)
    lower = random.uniform(0, extent, (n, 3))
    return np.concatenate([lower, lower + random.uniform(0, 1, (n, 3))], axis=1).astype(np.float32)


def brute_force(boxes):
    lower, upper = boxes[:, None, :3], boxes[None, :, 3:]
    meet = (lower <= upper).all(axis=2)
    i, j = np.nonzero(np.triu(meet & meet.T, k=1))
    return np.stack([i, j], axis=1).astype(np.uint32)


@pytest.mark.parametrize("n", [0, 1, 2, 17, 1000])
@pytest.mark.parametrize("threads", [1, 2])
def test_pairs_are_those_of_brute_force(n, threads):
    given = boxes(n)
    found = sdop.box_pairs(given, sort=True, threads=threads)
    assert found.dtype == np.uint32 and found.shape == (len(found), 2)
    np.testing.assert_array_equal(found, brute_force(given))


def test_touching_is_meeting():
    row = [[x, 0, 0, x + 1, 1, 1] for x in range(4)]
    assert sdop.box_pairs(row, sort=True).tolist() == [[0, 1], [1, 2], [2, 3]]


def test_corners_columns_and_strides_are_read_alike():
    given = boxes(200)
    wanted = sdop.box_pairs(given, sort=True)
    wide = np.zeros((200, 12), dtype=np.float32)
    wide[:, ::2] = given
    for same in (given.reshape(-1, 2, 3), np.asfortranarray(given), wide[:, ::2], given.astype(np.float64), given.tolist()):
        np.testing.assert_array_equal(sdop.box_pairs(same, sort=True), wanted)


@pytest.mark.parametrize(
    ("given", "error", "text"),
    [
        (np.zeros((3, 5), np.float32), sdop.SdopError, r"shape \[3, 5\]"),
        (np.zeros(6, np.float32), sdop.SdopError, r"\(n, 6\)"),
        ([[0, 0, 0, np.nan, 1, 1]], sdop.SdopError, "box"),
        ([[2, 0, 0, 1, 1, 1]], sdop.SdopError, "min"),
        ([[0.2, 0, 0, 0.1, 1, 1]], sdop.SdopError, "min"),
        ([[0.1, 0, 0, 1e39, 1, 1]], sdop.SdopError, "inf"),
        (np.ma.masked_less(np.zeros((3, 6)), 1), sdop.SdopError, r"boxes is a masked array.*\n.*filled"),
        (np.zeros((3, 6), complex), TypeError, "complex128; accepted are float32, float64"),
        (np.zeros((3, 6), np.longdouble), TypeError, "longdouble|float128; accepted are float32"),
        ("no boxes", TypeError, "dtype"),
        (np.zeros((3, 6), object), TypeError, "object"),
    ],
)
def test_what_is_no_column_of_boxes_is_refused(given, error, text):
    with pytest.raises(error, match=text):
        sdop.box_pairs(given)


def test_boxes_of_float64_rounded_outward_contain_the_given():
    wide = np.random.default_rng(1).uniform(-1, 1, (1000, 6)) * 10.0 ** np.arange(-300, 30, 55)
    wide.sort(axis=1)
    narrow = sdop.rounded_outward(wide)
    assert narrow.dtype == np.float32
    assert (narrow[:, :3] <= wide[:, :3]).all() and (narrow[:, 3:] >= wide[:, 3:]).all()
    exact = boxes(10)
    np.testing.assert_array_equal(sdop.rounded_outward(exact.astype(np.float64)), exact)


def test_boxes_of_float64_lose_no_pair():
    wide = np.random.default_rng(2).random((1000, 6)) / 8
    wide[:, 3:] += wide[:, :3]
    wide[1::2, :3] = wide[::2, 3:]  # each second one touches the one before
    wide[1::2, 3:] += wide[1::2, :3]
    found = sdop.box_pairs(wide)
    truth = {tuple(pair) for pair in brute_force(wide).tolist()}
    assert truth <= {tuple(pair) for pair in found.tolist()} and len(truth) > 500 and len(found) < 1.01 * len(truth)
    np.testing.assert_array_equal(found, sdop.BoxCuller().cull(sdop.rounded_outward(wide)))
    world = sdop.BoxWorld()
    ids = [world.insert(box) for box in wide]
    assert world.cull().tolist() == [[ids[i], ids[j]] for i, j in sorted(found.tolist())]
    world.set_many(ids, wide + 1)
    index = sdop.QueryIndex()
    index.update(world)
    corners = np.concatenate([wide[:, 3:], wide[:, 3:]], axis=1) + 1
    assert {(i, ids[i]) for i in range(1000)} <= {tuple(row) for row in index.touching_boxes(corners).tolist()}


@pytest.mark.parametrize(
    "call",
    [
        lambda box: sdop.box_pairs([box], exact=True),
        lambda box: sdop.BoxCuller().cull([box], exact=True),
        lambda box: sdop.BoxWorld().insert(box, exact=True),
        lambda box: sdop.BoxWorld().set_bounds(1, box, exact=True),
        lambda box: sdop.BoxWorld().set_many([1], [box], exact=True),
    ],
)
def test_exact_boxes_are_float32(call):
    with pytest.raises(sdop.SdopError, match=r"(boxes|bounds)\[0, 0\] is 0.1.*\n.*leave `exact` out"):
        call([0.1, 0, 0, 1, 1, 1])


def test_groups_exclude_pairs():
    given = np.zeros((3, 6), np.float32)
    groups = [[1, 1], [2, 2], [3, 3]]
    assert sdop.box_pairs(given, groups=groups, sort=True).tolist() == [[0, 2], [1, 2]]
    with pytest.raises(sdop.SdopError, match="groups has 2 rows for 3 bodies"):
        sdop.box_pairs(given, groups=groups[:2])


def test_a_culler_follows_moving_boxes_of_any_number():
    culler = sdop.BoxCuller(finder="sweep")
    for seed in range(20):
        given = boxes(100 + seed % 3, seed)
        np.testing.assert_array_equal(culler.cull(given, sort=True), brute_force(given))
    with pytest.raises(sdop.SdopError, match="sweep"):
        sdop.BoxCuller(finder="sweeep")


def test_a_world_of_boxes_reports_changes():
    world = sdop.BoxWorld()
    floor = world.insert([-9, -9, -1, 9, 9, 0], motion="fixed")
    crates = [world.insert([x, 0, 0, x + 1, 1, 1]) for x in (0, 5)]
    assert world.cull().tolist() == [[floor, crates[0]], [floor, crates[1]]]
    saved = world.snapshot()
    assert len(world.events().begun) == 2
    world.set_many(crates, [[0, 0, 1, 1, 1, 2], [0.5, 0, 1, 1, 1, 2]])
    assert world.cull().tolist() == [crates]
    events = world.events()
    assert (events.begun.tolist(), len(events.persisting), len(events.ended)) == ([crates], 0, 2)
    world.remove(crates[0])
    assert crates[0] not in world and len(world) == 2
    with pytest.raises(sdop.SdopError, match="no longer in this world"):
        world.set_bounds(crates[0], np.zeros(6))
    other = sdop.BoxWorld()
    other.restore(saved)
    assert crates[0] in other and len(other.events().begun) == 2
    with pytest.raises(sdop.SdopError, match="no snapshot"):
        other.restore(b"{}")


def test_pairs_are_those_of_rust_to_the_bit():
    """The hash is the one of the same boxes in `tests/boxes/main.rs`."""
    i = np.arange(3000, dtype=np.uint32)
    lower = np.stack([(i * k) % 1021 for k in (7, 131, 577)], axis=1).astype(np.float32) / 16
    sides = np.stack([(i * k) % 61 for k in (3, 11, 29)], axis=1).astype(np.float32) / 16
    found = sdop.box_pairs(np.concatenate([lower, lower + sides], axis=1), sort=True)
    assert hashlib.sha256(found.astype("<u4").tobytes()).hexdigest() == HASH


HASH = "bf3a97d3cf6860a4eba71ead750f8e5a0928f8a2a647e078928cac46621b6769"


def test_the_time_of_a_call_is_kept():
    culler = sdop.BoxCuller()
    assert culler.seconds == 0
    start = time.perf_counter()
    culler.cull(np.zeros((1000, 6), np.float32))
    assert 0 < culler.seconds < time.perf_counter() - start


def test_a_forked_child_has_its_own_threads():
    crowd = boxes(60_000, extent=60.0)  # enough work to wake threads
    culler = sdop.BoxCuller(threads=2)
    pairs = len(culler.cull(crowd))
    assert len(culler.cull(crowd)) == pairs
    child = os.fork()
    if child == 0:
        signal.alarm(60)  # a child that hangs is ended
        found = [len(culler.cull(crowd)) for _ in range(3)]
        os._exit(0 if found == [pairs] * 3 else 1)
    assert os.waitpid(child, 0)[1] == 0


CROWD = """
import resource, numpy, sdop
crowd = numpy.tile(numpy.float32([0, 0, 0, 1, 1, 1]), (20_000, 1))
assert len(sdop.box_pairs(crowd[:1000])) == 1000 * 999 // 2
resource.setrlimit(resource.RLIMIT_AS, (1_500_000 * 1024,) * 2)
world = sdop.BoxWorld()
for box in crowd:
    world.insert(box)
shape = sdop.Shape(numpy.float32([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
many = sdop.Compound([shape], [0] * 7_000, [[0, 0, 0, 1]] * 7_000, numpy.zeros((7_000, 3)))
bodies, parts = sdop.World([many.shape]), sdop.PartCuller()
parts.set_parts(0, many)
for x in range(2):
    bodies.insert(0, [0, 0, 0, 1], [0, 0, 0])
assert len(bodies.cull()) == 1
for call in [lambda: sdop.box_pairs(crowd), world.cull, lambda: world.cull(limit=9), lambda: parts.cull(bodies)]:
    try:
        call()
    except sdop.SdopError as error:
        print(error)
"""


def test_pairs_beyond_memory_or_limit_are_an_error():
    done = subprocess.run([sys.executable, "-P", "-c", CROWD], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("there is no memory for the frame's pairs\nhelp: ") == 2
    assert "the frame has 199990000 pairs, but at most 9 are allowed" in done.stdout
    assert "there is no memory for the pairs of parts" in done.stdout
    with pytest.raises(sdop.SdopError, match="at most 3 are allowed"):
        sdop.box_pairs(boxes(1000), limit=3)
    cell, world, index = sdop.PeriodicBoxes([50, 50, 50]), sdop.BoxWorld(), sdop.QueryIndex(limit=2)
    for _ in range(20):
        cell.insert([0, 0, 0, 1, 1, 1]), world.insert([0, 0, 0, 1, 1, 1])
    with pytest.raises(sdop.SdopError, match="the frame has 190 pairs, but at most 3 are allowed"):
        cell.cull(limit=3)
    index.update(world)
    with pytest.raises(sdop.SdopError, match="answers 20 in all, of at most 2"):
        index.touching_boxes([[0, 0, 0, 1, 1, 1]])
