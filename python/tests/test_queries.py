"""Queries and bodies of several shapes: nothing missed, and errors that say where."""

import numpy as np
import pytest
import sdop

UNTURNED = np.float32([0, 0, 0, 1])
QUARTER = np.float32([0, 0, 1, 1])  # about z, of the norm √2


def tetrahedron():
    return sdop.Shape([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def quarters(seed, n, extent):
    """Boxes on a grid of quarters, so that differences are exact."""
    draws = np.random.default_rng(seed)
    lower = draws.integers(0, 4 * extent, (n, 3)) / 4
    return np.hstack([lower, lower + draws.integers(0, 9, (n, 3)) / 4])


def world_of_boxes(n=300):
    boxes = quarters(1, n, 12)
    world = sdop.BoxWorld()
    ids = np.array([world.insert(box) for box in boxes.astype(np.float32)], dtype=np.uint64)
    index = sdop.QueryIndex(threads=2)
    index.update(world)
    assert len(index) == n
    return world, boxes, ids, index


def rows(found, ids):
    """Queries' numbers and places in the list of ids."""
    order = np.argsort(ids)
    return np.column_stack([found[:, 0].astype(int), order[np.searchsorted(ids[order], found[:, 1])]]).tolist()


def test_boxes_and_balls_find_exactly_what_they_touch():
    _, boxes, ids, index = world_of_boxes()
    asked = quarters(2, 100, 12)
    meet = (asked[:, None, :3] <= boxes[None, :, 3:]) & (boxes[None, :, :3] <= asked[:, None, 3:])
    wanted = np.argwhere(meet.all(axis=2)).tolist()
    found = index.touching_boxes(asked)
    assert found.dtype == np.uint64 and len(wanted) > 100 and rows(found, ids) == wanted
    assert rows(index.touching_boxes(asked.reshape(-1, 2, 3)), ids) == wanted
    centres, radii = asked[:, :3], np.arange(100) % 7 / 2
    gap = np.maximum(np.maximum(boxes[None, :, :3] - centres[:, None], centres[:, None] - boxes[None, :, 3:]), 0)
    wanted = np.argwhere((gap**2).sum(axis=2) <= radii[:, None] ** 2).tolist()
    assert len(wanted) > 100 and rows(index.touching_balls(centres, radii), ids) == wanted


def test_segments_meet_boxes_in_their_order():
    _, boxes, ids, index = world_of_boxes()
    starts = quarters(3, 60, 12)[:, :3]
    starts[:, 0], ends = -4, starts + [0, 0, 0]
    ends[:, 0] = 28  # along x: where it enters is exact, 32 being a power of two
    through = (boxes[None, :, 1:3] <= starts[:, None, 1:]) & (starts[:, None, 1:] <= boxes[None, :, 4:])
    wanted = [(i, (boxes[j, 0] + 4) / 32, j) for i, j in np.argwhere(through.all(axis=2))]
    wanted = sorted((i, s, ids[j]) for i, s, j in wanted)
    found, at = index.along(starts, ends)
    assert len(found) == len(at) == len(wanted) > 50
    np.testing.assert_array_equal(found[:, 0], [i for i, _, _ in wanted])
    np.testing.assert_allclose(at, [s for _, s, _ in wanted], rtol=1e-12)
    assert (at <= [s for _, s, _ in wanted]).all()
    begins = np.flatnonzero(np.diff(found[:, 0].astype(int), prepend=-1))
    first, where = index.first(starts, ends)
    np.testing.assert_array_equal(first, found[begins])
    np.testing.assert_array_equal(where, at[begins])
    assert 10 < len(first) < 60  # some meet nothing


def test_rays_meet_what_long_segments_meet():
    _, _, _, index = world_of_boxes()
    starts, directions = quarters(7, 60, 12)[:, :3], np.random.default_rng(8).normal(size=(60, 3))
    for ask in (index.along, index.first):
        by_segment, at_segment = ask(starts, starts + 64 * directions)
        by_ray, at_ray = ask(starts, directions=directions)
        np.testing.assert_array_equal(by_ray, by_segment)
        np.testing.assert_allclose(at_ray, 64 * at_segment, atol=1e-9)
    assert len(by_ray) > 30 and at_ray.max() > 1  # beyond the directions' ends


def test_two_sets_are_compared_in_either_order():
    _, boxes, ids, index = world_of_boxes()
    others, world = quarters(9, 200, 12), sdop.BoxWorld()
    theirs, other = [world.insert(box) for box in others], sdop.QueryIndex()
    other.update(world)
    meet = (boxes[:, None, :3] <= others[None, :, 3:]) & (others[None, :, :3] <= boxes[:, None, 3:])
    wanted = [[ids[i], theirs[j]] for i, j in np.argwhere(meet.all(axis=2))]
    assert len(wanted) > 100 and index.pairs_with(other).tolist() == wanted
    assert sorted(other.pairs_with(index)[:, ::-1].tolist()) == sorted(wanted)
    assert {(id, id) for id in ids} < {tuple(pair) for pair in index.pairs_with(index).tolist()}


def test_an_index_is_of_its_last_update():
    world, _, ids, index = world_of_boxes()
    far = [[100, 100, 100, 101, 101, 101]]
    world.set_bounds(int(ids[7]), np.float32(far))
    assert len(index.touching_boxes(far)) == 0
    index.update(world)
    assert index.touching_boxes(far).tolist() == [[0, ids[7]]]
    bodies = sdop.World([tetrahedron()])
    body = bodies.insert(0, UNTURNED, [0, 0, 0])
    index.update(bodies)
    assert len(index) == 1 and index.touching_boxes([[0, 0, 0, 1, 1, 1]]).tolist() == [[0, body]]


def test_shapes_at_poses_miss_no_body():
    draws = np.random.default_rng(4)
    shape, n = tetrahedron(), 80
    rotations = draws.normal(size=(n, 4)).astype(np.float32)
    places = draws.uniform(0, 4, (n, 3)) + 1e9  # of float64
    world = sdop.World([shape])
    ids = [world.insert(0, q, t) for q, t in zip(rotations[40:], places[40:])]
    index = sdop.QueryIndex()
    index.update(world)
    found = {tuple(row) for row in index.touching_shapes(shape, rotations[:40], places[:40]).tolist()}
    poses = list(zip(rotations, places))
    meet = {(i, ids[j]) for i in range(40) for j in range(40) if sdop.exact_meet(shape, poses[i], shape, poses[40 + j])}
    assert len(meet) > 20 and meet <= found and len(found) < 1600
    wider = index.touching_shapes(shape, rotations[:40], places[:40], margin=0.5)
    assert found < {tuple(row) for row in wider.tolist()}


@pytest.mark.parametrize(
    ("ask", "error", "text"),
    [
        (lambda i: i.touching_boxes([[0, 0, 0, 1, 1, 1], [1, 0, 0, 0, 1, 1]]), sdop.SdopError, "query 1: box .*\nhelp: `min`"),
        (lambda i: i.touching_boxes([[0, 0, 0, 1, 1]]), sdop.SdopError, r"\(n, 6\)"),
        (lambda i: i.touching_balls([[0, 0, 0]], [-1]), sdop.SdopError, "query 0: radius -1"),
        (lambda i: i.touching_balls([[0, 0, 0]], [1, 2]), sdop.SdopError, "radii has 2 rows for 1"),
        (lambda i: i.touching_balls([[0, 0, 0]], 1), sdop.SdopError, r"\(n,\)"),
        (lambda i: i.first([[0, 0, np.nan]], [[0, 0, 1]]), sdop.SdopError, "query 0: from .*NaN"),
        (lambda i: i.along([[0, 0, 0]], [[0, 0, 1]] * 2), sdop.SdopError, "ends has 2 rows"),
        (lambda i: i.along("here", "there"), TypeError, "starts"),
        (lambda i: i.along([[0, 0, 0]]), sdop.SdopError, "either an end or a direction\nhelp: pass `ends`"),
        (lambda i: i.first([[0, 0, 0]], directions=[[0, 0, 0]]), sdop.SdopError, "query 0: direction"),
        (lambda i: i.touching_shapes(tetrahedron(), [[0, 0, 0, 0]], [[0, 0, 0]]), sdop.SdopError, "query 0: rotation"),
        (lambda i: i.update(3), TypeError, "World"),
    ],
)
def test_what_is_wrong_with_a_query_is_said(ask, error, text):
    index = sdop.QueryIndex()
    with pytest.raises(sdop.SdopError, match="never been updated\nhelp: call `update`"):
        index.touching_balls([[0, 0, 0]], [1])
    index.update(sdop.BoxWorld())
    with pytest.raises(error, match=text):
        ask(index)


def test_no_queries_have_no_answers():
    _, _, _, index = world_of_boxes()
    assert index.touching_boxes(np.zeros((0, 6))).shape == (0, 2)
    found, at = index.first(np.zeros((0, 3)), np.zeros((0, 3)))
    assert found.shape == (0, 2) and at.shape == (0,)


def arm(name="arm"):
    places = np.array([[0.0, 0, 0], [2, 0, 0], [4, 0, 0]])
    return sdop.Compound([tetrahedron()], [0, 0, 0], [UNTURNED, QUARTER, UNTURNED], places, name=name)


def test_parts_that_meet_are_found_and_nothing_else_far():
    compound, shape = arm(), tetrahedron()
    draws = np.random.default_rng(5)
    places = draws.integers(0, 24, (30, 3)) / 4 + 1e9
    places[:, 2] = 1e9
    world = sdop.World([compound.shape, shape])
    ids = [world.insert(i % 2, UNTURNED, place) for i, place in enumerate(places)]
    culler = sdop.PartCuller()
    culler.set_parts(0, compound)
    pairs_of_bodies = world.cull()
    bodies, parts = culler.cull(world)
    assert bodies.dtype == np.uint64 and parts.dtype == np.uint32 and bodies.shape == parts.shape
    found = set(zip(*bodies.T.tolist(), *parts.T.tolist()))

    def posed(body, part):
        """A part's pose in the world, exactly: bodies are not rotated."""
        turn = QUARTER if body % 2 == 0 and part == 1 else UNTURNED
        return turn, places[body] + [2.0 * part, 0, 0]

    meet, tested = set(), 0
    for i in range(30):
        for j in range(i + 1, 30):
            for a in range(3 if i % 2 == 0 else 1):
                for b in range(3 if j % 2 == 0 else 1):
                    tested += 1
                    if sdop.exact_meet(shape, posed(i, a), shape, posed(j, b)):
                        meet.add((ids[i], ids[j], a, b))
    assert len(meet) > 30 and meet <= found and len(found) < tested / 4
    with_parts = culler.body_pairs().tolist()
    assert with_parts == [list(pair) for pair in sorted({pair[:2] for pair in found})]
    assert len(with_parts) < len(pairs_of_bodies)


def test_what_is_wrong_with_a_compound_is_said():
    assert len(arm()) == 3 and len(arm().shape.vertices) == 12
    shape = tetrahedron()
    for part_shapes, rotations, text in [
        ([], np.zeros((0, 4)), "no parts"),
        ([1], [UNTURNED], "part 0 of compound `arm`: shape 1 of 1"),
        ([0], [[0, 0, 0, 0]], "part 0 of compound `arm`"),
        ([0, 0], [UNTURNED], "rotations has 1 rows for 2"),
    ]:
        with pytest.raises(sdop.SdopError, match=text):
            sdop.Compound([shape], part_shapes, rotations, np.zeros((len(part_shapes), 3)), name="arm")
    world = sdop.World([shape])
    culler = sdop.PartCuller()
    culler.set_parts(2**32 - 1, arm())  # takes no memory
    with pytest.raises(sdop.SdopError, match="changed since its last cull.*\nhelp: call `World::cull`"):
        culler.cull(world)
    world.cull()
    with pytest.raises(sdop.SdopError, match="shape 4294967295 of the world"):
        culler.cull(world)
    culler.remove_parts(2**32 - 1)
    culler.set_parts(0, arm())
    with pytest.raises(sdop.SdopError, match="shape 0 of the world is not the shape of compound `arm`\nhelp: "):
        culler.cull(world)
    culler.remove_parts(0)
    assert all(len(column) == 0 for column in culler.cull(world))
