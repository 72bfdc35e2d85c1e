"""Periodic worlds: the pairs and images that numpy finds by brute force, and what is refused."""

import numpy as np
import pytest
import sdop

UNTURNED = np.float32([0, 0, 0, 1])
CELLS = [(6.0, 7.0, 8.0), (6.0, None, 8.0), (None, 7.0, None), (None, None, None)]


def tetrahedron():
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    return sdop.Shape(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], axes="model")


def lengths(cell):
    """The periods, 0 for an axis without one: no image moves along it."""
    return np.array([period or 0.0 for period in cell])


def images_near(cell):
    """The images by which a body of `spread` may be moved to another."""
    along = [range(-3, 4) if period else (0,) for period in cell]
    return np.stack(np.meshgrid(*along, indexing="ij"), axis=-1).reshape(-1, 3)


def spread(draws, n, cell):
    """Quarters within the period, some of them moved by a period: differences are exact."""
    inside = draws.integers(0, 24, (n, 3)) / 4
    return inside + draws.integers(-1, 2, (n, 3)) * lengths(cell)


def brute_force(boxes, cell):
    """Each pair i < j that meets, with its image."""
    found = []
    for image in images_near(cell):
        moved = boxes + np.tile(image * lengths(cell), 2)
        meet = (boxes[:, None, :3] <= moved[None, :, 3:]) & (moved[None, :, :3] <= boxes[:, None, 3:])
        pairs = np.argwhere(np.triu(meet.all(axis=2), k=1))
        found += [(*pair, *image) for pair in pairs.tolist()]
    return sorted(tuple(map(int, row)) for row in found)


def rows(ids, images, of):
    """Pairs as numbers of bodies, and their images."""
    assert ids.dtype == np.uint64 and images.dtype == np.int32
    assert ids.shape == (len(ids), 2) and images.shape == (len(ids), 3)
    number = {id: n for n, id in enumerate(of)}
    return [(number[a], number[b], *image) for (a, b), image in zip(ids.tolist(), images.tolist())]


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("threads", [1, 2])
def test_boxes_are_those_of_brute_force(cell, threads):
    draws = np.random.default_rng(6)
    world = sdop.PeriodicBoxes(cell, threads=threads)
    assert world.periods == list(cell)
    boxes = np.zeros((120, 6))
    ids = [world.insert(box) for box in boxes]
    for _ in range(4):
        lower = spread(draws, len(boxes), cell)
        boxes = np.hstack([lower, lower + draws.integers(0, 7, lower.shape) / 4])
        world.set_many(ids, boxes)
        wanted = brute_force(boxes, cell)
        found = rows(*world.cull(), ids)
        assert len(wanted) > 50 and found == wanted
        assert rows(*world.pairs(), ids) == wanted
    assert any(image for *_, image in wanted) == (cell[2] is not None)


def test_ends_of_float64_touch_exactly():
    """The period is not a tenth, and ends are compared without rounding it."""
    world = sdop.PeriodicBoxes([0.1, None, None])
    first = world.insert([0, 0, 0, 0.01, 1, 1])
    second = world.insert([0.1 - 0.02, 0, 0, 0.1, 1, 1])
    assert world.cull()[1].tolist() == [[-1, 0, 0]]
    world.set_bounds(second, [0.1 - 0.02, 0, 0, np.nextafter(0.1, 0), 1, 1])
    assert len(world.cull()[0]) == 0
    world.set_periods([np.nextafter(0.1, 0), None, None])
    assert world.cull()[0].tolist() == [[first, second]]


@pytest.mark.parametrize("cell", CELLS[:2])
def test_meshes_miss_no_image(cell):
    draws, shape, n = np.random.default_rng(7), tetrahedron(), 80
    world = sdop.PeriodicWorld([shape], cell)
    rotations, places = draws.normal(size=(n, 4)).astype(np.float32), spread(draws, n, cell)
    ids = [world.insert(0, UNTURNED, [0, 0, 0]) for _ in range(n)]
    world.set_poses(ids, rotations, places)
    found = set(rows(*world.cull(), ids))
    period, meeting = lengths(cell), set()
    for i in range(n):
        for j in range(i + 1, n):
            images = images_near(cell)
            apart = np.abs(places[j] + images * period - places[i]).max(axis=1)
            for image in images[apart <= 2]:
                moved = places[j] + image * period
                if sdop.exact_meet(shape, (rotations[i], places[i]), shape, (rotations[j], moved)):
                    meeting.add((i, j, *image.tolist()))
    assert len(meeting) > 10 and meeting <= found and len(found) < 6 * len(meeting)


def test_margins_reach_across_borders():
    world = sdop.PeriodicWorld([tetrahedron()], (8.0, None, None))
    left = world.insert(0, UNTURNED, [0, 0, 0], margin=0.25)
    right = world.insert(0, UNTURNED, [6.75, 0, 0])
    assert [column.tolist() for column in world.cull()] == [[[left, right]], [[-1, 0, 0]]]
    world.set_pose(right, UNTURNED, [6.5, 0, 0])
    assert len(world.cull()[0]) == 0
    assert world.body(left)["margin"] == 0.25 and world.body(right)["translation"] == [6.5, 0, 0]


def test_bodies_come_rest_and_go():
    world = sdop.PeriodicBoxes((8.0, 8.0, 8.0))
    placed = [(0, "fixed"), (7, "fixed"), (-1, "dynamic")]
    a, b, c = (world.insert([x, 0, 0, x + 1, 1, 1], motion=motion) for x, motion in placed)
    assert world.cull()[0].tolist() == [[a, c], [b, c]]
    world.set_motion(b, "dynamic")
    ids, images = world.cull()
    assert ids.tolist() == [[a, b], [a, c], [b, c]] and images.tolist() == [[-1, 0, 0], [0, 0, 0], [1, 0, 0]]
    assert world.events().begun[0].tolist() == [[a, b], [a, c], [b, c]]
    assert world.exclude(a, b) and not world.exclude(b, a) and len(world.cull()[0]) == 2
    assert world.include(a, b) and len(world.cull()[0]) == 3
    world.set_motion(b, "resting")
    assert len(world.cull()[0]) == 3 and len(world) == 3 and b in world
    world.remove(b)
    assert b not in world and world.cull()[0].tolist() == [[a, c]]
    events = world.events()
    assert events.persisting[0].tolist() == [[a, c]] and len(events.begun[0]) == 0
    assert [rows.tolist() for rows in events.ended] == [[[a, b], [b, c]], [[-1, 0, 0], [1, 0, 0]]]
    other = world.insert([7, 0, 0, 8, 1, 1], groups=(2, 2))
    world.set_bounds(a, [[0, 0, 0], [1, 1, 1]])
    assert len(world.cull()[0]) == 3 and other in world


@pytest.mark.parametrize(
    ("ask", "error", "text"),
    [
        (lambda: sdop.PeriodicBoxes([1.0, 2.0]), sdop.SdopError, "periods has 2 entries\nhelp: pass three"),
        (lambda: sdop.PeriodicBoxes([0.0, 1, 1]), sdop.SdopError, "the period along x is 0\nhelp: give a length"),
        (lambda: sdop.PeriodicBoxes([np.nan, 1, 1]), sdop.SdopError, "the period along x is NaN"),
        (lambda: sdop.PeriodicBoxes(3.0), TypeError, "periods is 3.0 of type float"),
        (lambda: sdop.PeriodicBoxes(["a", 1, 1]), TypeError, r"periods is \['a', 1, 1\] of type list\nhelp: pass three"),
        (lambda: boxes().insert([0, 0, 0, 1, 2, 1]), sdop.SdopError, "body 0 measures 2 along y, but less than 2"),
        (lambda: boxes().insert([0, 0, 0, 1, 1]), sdop.SdopError, "bounds has shape"),
        (lambda: boxes().insert([0, 0, 0, 1, np.nan, 1]), sdop.SdopError, "body 0: box"),
        (lambda: boxes().insert([0, 1e12, 0, 1, 1e12, 1]), sdop.SdopError, "farther away than"),
        (lambda: boxes().set_many([7], [[0, 0, 0, 1, 1, 1]]), sdop.SdopError, "no longer in this world"),
        (lambda: boxes().set_many([7], []), sdop.SdopError, "boxes has 0 rows for 1"),
        (lambda: sdop.PeriodicWorld([tetrahedron()], [1.5] * 3).insert(0, UNTURNED, [0, 0, 0]), sdop.SdopError, "body 0 measures 1.6"),
        (lambda: sdop.PeriodicWorld([], [None] * 3, strategy="s"), sdop.SdopError, "s-dop-sequential"),
    ],
)
def test_what_is_wrong_is_said(ask, error, text):
    with pytest.raises(error, match=text):
        ask()


def boxes():
    return sdop.PeriodicBoxes([None, 4.0, None])
