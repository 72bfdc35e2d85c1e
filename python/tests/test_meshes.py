"""Meshes: nothing missed against the exact answer, in the mesh's own coordinates."""

import threading
from pathlib import Path

import numpy as np
import pytest
import sdop
import trimesh
from scipy.spatial.transform import Rotation

BRACKET = (
    np.array([[0, 0, 0], [4, 0, 0], [4, 1, 0], [1, 1, 0], [1, 3, 0], [0, 3, 0]] * 2, dtype=np.float32)
    + np.repeat([[0, 0, 0], [0, 0, 1]], 6, axis=0)
).astype(np.float32)


def bracket():
    """An L whose ball is centred far from its origin."""
    sides = [[i, (i + 1) % 6, (i + 1) % 6 + 6] for i in range(6)] + [[i, (i + 1) % 6 + 6, i + 6] for i in range(6)]
    bottom = [[0, 2, 1], [0, 3, 2], [0, 4, 3], [0, 5, 4]]
    top = [[a + 6, c + 6, b + 6] for a, b, c in bottom]
    return BRACKET, np.array(sides + bottom + top)


def poses(n, seed=0, extent=6.0):
    rotations = Rotation.random(n, random_state=seed).as_quat().astype(np.float32)
    translations = np.random.default_rng(seed).uniform(-extent, extent, (n, 3)).astype(np.float32)
    return rotations, translations


def meeting(shape, rotations, translations):
    n = len(rotations)
    pose = [(rotations[i], translations[i]) for i in range(n)]
    return [[i, j] for i in range(n) for j in range(i + 1, n) if sdop.exact_meet(shape, pose[i], shape, pose[j])]


@pytest.mark.parametrize("strategy", ["s-dop-sequential", "sphere", "k-dop", "obb"])
def test_nothing_that_meets_is_missed(strategy):
    shape = sdop.Shape(*bracket())
    rotations, translations = poses(60)
    truth = meeting(shape, rotations, translations)
    culler = sdop.Culler([shape], [0] * 60, strategy=strategy)
    found = culler.cull(rotations, translations, sort=True).tolist()
    assert len(truth) > 50 and all(pair in found for pair in truth)
    world = sdop.World([shape], strategy=strategy)
    ids = [world.insert(0, q, t.astype(np.float64)) for q, t in zip(rotations, translations)]
    found = world.cull().tolist()
    assert all([ids[i], ids[j]] in found for i, j in truth)


def test_static_bodies_are_placed_by_the_first_frame_and_moved_by_others():
    shape = sdop.Shape(*bracket())
    culler = sdop.Culler([shape], [0, 0], dynamic=[True, False])
    unturned = np.tile(np.float32([0, 0, 0, 1]), (2, 1))
    for x, meets in [(9, 0), (2, 1), (9, 0)]:
        assert len(culler.cull(unturned, np.float32([[0, 0, 0], [x, 0, 0]]))) == meets


def tetrahedron():
    return sdop.Shape([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def test_exact_answers_about_float64():
    shape = tetrahedron()

    def meet(x_a, x_b):
        a, b = [([0, 0, 0, 1], np.array([x, 0.0, 0.0])) for x in (x_a, x_b)]
        assert sdop.exact_meet(shape, a, shape, b) == sdop.exact_meet(shape, b, shape, a)
        return sdop.exact_meet(shape, a, shape, b)

    assert meet(1000000031.5, 1000000032.2)
    place = 1000000031.7
    assert meet(place, place + 1) and not meet(place, np.nextafter(place + 1, np.inf))
    # As given, 1.1 is more than 1 above 0.1, though the difference rounds to 1.
    assert 1.1 - 0.1 == 1.0 and not meet(0.1, 1.1) and meet(0.1, np.nextafter(1.1, 0))
    # Turned by a half about z it ends at x = 0, and at a turn of 2**-59 more at x = 2**-59.
    for more, x, meets in [(0.0, 0.0, True), (0.0, 2.0**-70, False), (2.0**-60, 2.0**-70, True), (2.0**-60, 2.0**-50, False)]:
        a = (np.array([0, 0, 1, -more]), np.zeros(3))
        b = (np.array([0, 0, 0, 1]), np.array([x, -1.0, 0.0]))
        assert sdop.exact_meet(shape, a, shape, b) is meets, (more, x)
    for rotation in [(0, 0, 0, 0), (0, 0, np.nan, 1), (1e200, 0, 0, 1e-200)]:
        with pytest.raises(sdop.SdopError, match="pose_a"):
            sdop.exact_meet(shape, (rotation, [0.0] * 3), shape, ([0, 0, 0, 1], [0.0] * 3))


def test_translations_are_float64_in_a_world():
    shape = tetrahedron()
    world = sdop.World([shape])
    for x in (1000000031.5, 1000000032.2):
        world.insert(0, [0, 0, 0, 1], [x, 0, 0])
    assert len(world.cull()) == 1
    culler = sdop.Culler([shape], [0, 0], dynamic=[True, False])
    frame = [[0, 0, 0, 1]] * 2, [[1000000031.5, 0, 0], [1000000032.2, 0, 0]]
    assert culler.cull(*frame).tolist() == [[0, 1]]
    with pytest.raises(sdop.SdopError, match=r"translations\[0, 0\] is 1000000031.5.*\n.*leave `exact` out"):
        culler.cull(*frame, exact=True)


@pytest.mark.parametrize("strategy", ["s-dop-sequential", "aabb", "s-dop-object-of-interest"])
def test_poses_of_float64_lose_no_pair(strategy):
    shape, draws = sdop.Shape(*bracket()), np.random.default_rng(5)
    interest = [0, 1, 2] if strategy == "s-dop-object-of-interest" else None
    groups = np.where(np.arange(60) % 5, 1, 3)[:, None].repeat(2, axis=1)
    options = dict(strategy=strategy, dynamic=np.arange(60) % 3 > 0, groups=groups, interest=interest)
    culler = sdop.Culler([shape], [0] * 60, **options)
    for _ in range(2):
        rotations, translations = Rotation.random(60, random_state=draws.integers(99)).as_quat(), draws.uniform(-6, 6, (60, 3))
        found = culler.cull(rotations, translations).tolist()
        truth = meeting(shape, rotations, translations)
        truth = [[i, j] for i, j in truth if (i % 3 or j % 3) and (not interest or i in interest or j in interest)]
        assert len(truth) > 2 and all(pair in found for pair in truth) and culler.seconds > 0
        narrow = culler.cull(np.float32(rotations), np.float32(translations))
        assert sdop.Culler([shape], [0] * 60, **options).cull(np.float32(rotations), np.float32(translations)).tolist() == narrow.tolist()
    world = sdop.World([shape])
    ids = [world.insert(0, q, t, motion=["fixed", "dynamic"][i % 3 > 0]) for i, (q, t) in enumerate(zip(rotations, translations))]
    assert all([ids[i], ids[j]] in world.cull().tolist() for i, j in truth)
    world.set_poses(ids, rotations[::-1], translations)
    assert world.body(ids[0])["rounded"] and world.body(ids[0])["rotation"] == np.float32(rotations[-1]).tolist()
    world.set_pose(ids[0], [0, 0, 0, 1], [0, 0, 0])
    assert not world.body(ids[0])["rounded"]


def test_vertices_of_float64_grow_the_volumes():
    rounded, given = sdop.Shape(*bracket()), sdop.Shape(np.float64(BRACKET) * (1 + 2.0**-30), bracket()[1])
    assert rounded.rounding == 0 and given.rounding >= 4 * 2.0**-30
    np.testing.assert_array_equal(rounded.vertices, given.vertices)
    assert given.ball[1] > rounded.ball[1] and (given.slabs[1] > rounded.slabs[1]).all()


@pytest.mark.parametrize(
    "call",
    [
        lambda s, q: sdop.Culler([s], [0]).cull([q], [[0, 0, 0]], exact=True),
        lambda s, q: sdop.World([s]).insert(0, q, [0, 0, 0], exact=True),
        lambda s, q: sdop.World([s]).set_pose(1, q, [0, 0, 0], exact=True),
        lambda s, q: sdop.World([s]).set_poses([1], [q], [[0, 0, 0]], exact=True),
        lambda s, q: sdop.PeriodicWorld([s], [99, None, None]).insert(0, q, [0, 0, 0], exact=True),
        lambda s, q: sdop.PeriodicWorld([s], [99, None, None]).set_pose(1, q, [0, 0, 0], exact=True),
        lambda s, q: sdop.PeriodicWorld([s], [99, None, None]).set_poses([1], [q], [[0, 0, 0]], exact=True),
        lambda s, q: sdop.QueryIndex().touching_shapes(s, [q], [[0, 0, 0]], exact=True),
        lambda s, q: sdop.Compound([s], [0], [q], [[0, 0, 0]], exact=True),
    ],
)
def test_exact_poses_are_float32(call):
    shape = sdop.Shape(*bracket())
    with pytest.raises(sdop.SdopError, match=r"rotations?\[0, 2\] is 0.6.*\n.*leave `exact` out"):
        call(shape, [0, 0, 0.6, 0.8])


def test_periodic_worlds_take_float64():
    world = sdop.PeriodicWorld([tetrahedron()], [99, None, None])
    a, b = world.insert(0, [0, 0, 0.6, 0.8], [0.1, 0, 0]), world.insert(0, [0, 0, 0, 1], [99.2, 0, 0])
    assert world.cull()[0].tolist() == [[a, b]] and world.body(a)["rounded"]
    world.set_poses([a, b], [[0, 0, 0, 1], [0, 0, 0.6, 0.8]], [[0, 0, 0], [50, 0, 0]])
    world.set_pose(b, [0, 0, 0.6, 0.8], [50, 0, 0])
    assert not world.body(a)["rounded"] and world.body(b)["rounded"] and len(world.cull()[0]) == 0


def two_that_touch():
    world = sdop.World([tetrahedron()])
    ids = [world.insert(0, [0, 0, 0, 1], [x, 0, 0]) for x in (0, 0.5)]
    assert world.cull().tolist() == [ids]
    world.events()
    return world, ids


def two_boxes_that_touch():
    world = sdop.BoxWorld()
    ids = [world.insert([x, 0, 0, x + 1, 1, 1]) for x in (0, 0.5)]
    assert world.cull().tolist() == [ids]
    world.events()
    return world, ids


@pytest.mark.parametrize("made", [two_that_touch, two_boxes_that_touch])
def test_excluded_pairs_end_and_begin_again(made):
    world, (a, b) = made()
    assert world.exclude(b, a) and not world.exclude(a, b) and not world.exclude(a, a)
    assert len(world.cull()) == 0 and world.events().ended.tolist() == [[a, b]]
    assert world.include(a, b) and not world.include(a, b)
    assert world.cull().tolist() == [[a, b]] and world.events().begun.tolist() == [[a, b]]
    with pytest.raises(sdop.SdopError, match="no longer"):
        world.exclude(a, 12345678901)


@pytest.mark.parametrize("made", [two_that_touch, two_boxes_that_touch])
def test_resting_bodies_keep_their_pairs_and_fixed_ones_lose_them(made):
    world, ids = made()
    for motion, remain in [("resting", 1), ("dynamic", 1), ("fixed", 0)]:
        [world.set_motion(id, motion) for id in ids]
        assert len(world.cull()) == remain, motion
    assert world.events().ended.tolist() == [ids]
    with pytest.raises(sdop.SdopError, match="unknown motion `asleep`"):
        world.set_motion(ids[0], "asleep")


def test_a_body_is_inserted_again_as_it_is():
    world, (a, b) = two_that_touch()
    world.set_motion(a, "resting")
    assert [world.body(id)["motion"] for id in (a, b)] == ["resting", "dynamic"]
    body = world.body(a)
    assert not body.pop("rounded") and world.body(world.insert(**body)) == world.body(a)


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda s: sdop.Culler([s], [1]), "shape"),
        (lambda s: sdop.Culler([s], [-1]), "-1"),
        (lambda s: sdop.Culler([s], [0], dynamic=[True, False]), "dynamic has 2 rows for 1 bodies"),
        (lambda s: sdop.Culler([s], [0], strategy="s-dop-sequentail"), "did you mean `s-dop-sequential`"),
        (lambda s: sdop.Culler([s], [0]).cull([[0, 0, 0, 1]] * 2, [[0, 0, 0]] * 2), "2 rows for 1 bodies"),
        (lambda s: sdop.Culler([s], [0]).cull([[0, 0, 0, 0]], [[0, 0, 0]]), "quaternion"),
        (lambda s: sdop.Culler([s], [0]).cull([[0, 0, 0, 1]], [[np.inf, 0, 0]]), "inf"),
        (lambda s: sdop.Shape([[0, 0, 0]], [[0, 0, 1]]), "0"),
        (lambda s: sdop.Shape(np.zeros((0, 3)), np.zeros((0, 3), int)), "no vert"),
        (lambda s: sdop.World([s]).insert(3, [0, 0, 0, 1], [0, 0, 0]), "3"),
        (lambda s: sdop.World([s]).remove(12345678901), "no longer"),
        (lambda s: sdop.World([s]).insert(0, [0, 0, 1], [0, 0, 0]), r"rotation has shape \[3\]\nhelp: .*four"),
        (lambda s: sdop.World([s]).insert(0, [0, 0, 0, 1], 0), r"translation has shape \[\]\nhelp: .*three"),
        (lambda s: sdop.World([s]).insert(0, [0, 0, 0, 1], [0, np.nan, 0]), "NaN"),
        (lambda s: sdop.World([s]).set_poses([], [[0, 0, 0, 1]], []), "rotations has 1 rows for 0"),
        (lambda s: sdop.BoxWorld().insert([0, 0, 0, 1, 1]), r"bounds has shape \[5\]\nhelp: .*six"),
        (lambda s: sdop.exact_meet(s, ([0, 0, 1], [0] * 3), s, ([0, 0, 0, 1], [0] * 3)), "pose_a's rotation has shape"),
        (lambda s: sdop.Culler([s], [0]).cull([[0, 0, np.nan, 1]], [[0, 0, 0]]), "rotation.*NaN"),
        (lambda s: sdop.Culler([s], [[0]]), r"body_shapes has shape \[1, 1\]"),
        (lambda s: sdop.Shape(BRACKET, [[0, 1, 99]]), "99"),
        (lambda s: sdop.Shape(BRACKET * np.nan, [[0, 1, 2]]), "NaN"),
        (lambda s: sdop.Shape(np.ma.masked_equal(BRACKET, 4), [[0, 1, 2]]), "vertices is a masked array"),
        (lambda s: sdop.Culler([s], np.ma.masked_equal([0], 0)), "body_shapes is a masked array"),
        (lambda s: sdop.World([s]).insert(0, [0, 0, 0, 1], [2**60 + 1, 0, 0]), r"translation has whole numbers above 2\*\*53"),
        (lambda s: sdop.World([s]).remove(-1), "the id is -1\nhelp: .*`insert`"),
        (lambda s: sdop.World([s]).set_poses([-1], [[0, 0, 0, 1]], [[0, 0, 0]]), "ids has the number -1"),
        (lambda s: sdop.World([s]).insert(-1, [0, 0, 0, 1], [0, 0, 0]), "number of the shape is -1"),
        (lambda s: sdop.BoxWorld().insert([0] * 6, groups=(1, 2**32)), r"one of groups is 4294967296\nhelp: .*2\*\*32"),
        (lambda s: sdop.Shape(BRACKET, [[0, 1, 2], [3]]), "triangles has rows of unequal lengths"),
        (lambda s: sdop.World([s]).insert(0, np.ma.masked_equal([0, 0, 0, 1], 1), [0, 0, 0]), "rotation is a masked array"),
    ],
)
def test_what_is_wrong_is_said_with_a_remedy(call, text):
    with pytest.raises(sdop.SdopError, match=text):
        call(sdop.Shape(*bracket()))


@pytest.mark.parametrize("read", [sdop.Shape.load, sdop.cost, sdop.tradeoff])
def test_missing_file_is_not_found(read):
    with pytest.raises(FileNotFoundError, match="No such file.*nowhere.obj") as raised:
        read("nowhere.obj")
    assert raised.value.filename == "nowhere.obj"


def test_meshes_come_in_several_forms():
    vertices, triangles = bracket()
    mesh = trimesh.Trimesh(vertices, triangles, process=False)
    moved = trimesh.Scene({"first": mesh})
    moved.add_geometry(mesh, transform=trimesh.transformations.translation_matrix([9, 0, 0]))
    for given, copies in [((vertices, triangles), 1), (mesh, 1), (trimesh.Scene(mesh), 1), (moved, 2)]:
        shape = sdop.Shape(given)
        assert shape.vertices[:, 0].max() == 4 + 9 * (copies - 1) and len(shape.triangles) == 20 * copies
    with pytest.raises(TypeError, match=r"the mesh is 3 of type int\nhelp: .*Trimesh"):
        sdop.Shape(3)


def test_a_mesh_is_scaled_when_it_is_loaded():
    path = Path(__file__).resolve().parents[2] / "data/meshes/spot.tri"
    spot = sdop.Shape.load(path)
    np.testing.assert_array_equal(sdop.Shape.load(path, scale=0.5).vertices, spot.vertices / 2)
    mirrored = sdop.Shape.load(path, scale=(-1, 1, 2))
    np.testing.assert_array_equal(mirrored.vertices, spot.vertices * np.float32([-1, 1, 2]))
    np.testing.assert_array_equal(mirrored.triangles, spot.triangles[:, [0, 2, 1]])
    with pytest.raises(TypeError, match="scale is '2' of type str"):
        sdop.Shape.load(path, scale="2")


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda s: sdop.Culler([s], [0.5]), "body_shapes has dtype float64"),
        (lambda s: sdop.Culler([s], [0], dynamic=[1]), "dynamic has dtype int64, and must be of bool"),
        (lambda s: sdop.Culler([s], [0]).cull([[0, 0, 0, 1j]], [[0, 0, 0]]), "rotations has dtype complex128"),
        (lambda s: sdop.Culler([s], [0]).cull([[0, 0, 0, 1]], [["x", "y", "z"]]), "translations has dtype <U1"),
        (lambda s: sdop.Shape(BRACKET, np.zeros((1, 3))), "triangles has dtype float64"),
        (lambda s: sdop.World([s]).insert(0, [True] * 4, [0, 0, 0]), "rotation has dtype bool"),
        (lambda s: sdop.Culler("s", [0]), r"shapes\[0\] is 's' of type str\nhelp: .*list of `sdop.Shape`"),
        (lambda s: sdop.World(s), "shapes is <sdop.Shape .*> of type Shape"),
        (lambda s: sdop.World([s]).remove(1.0), "the id is 1.0 of type float"),
        (lambda s: sdop.BoxWorld().insert([0] * 6, groups=3), "groups is 3 of type int"),
        (lambda s: sdop.exact_meet(s, 3, s, 3), "pose_a is 3 of type int\nhelp: .*rotation, translation"),
        (lambda s: sdop.World([s]).set_poses(np.array([np.uint64(1), -1]), [], []), "ids has dtype float64; .*np.uint64"),
        (lambda s: sdop.World([s]).set_poses(["1"], [], []), "ids has dtype <U1; accepted are integers"),
    ],
)
def test_what_has_another_dtype_is_refused(call, text):
    with pytest.raises(TypeError, match=text):
        call(sdop.Shape(*bracket()))


def test_columns_of_any_layout_are_read_alike():
    shape = sdop.Shape(*bracket())
    culler = sdop.Culler([shape], [0] * 100)
    rotations, translations = poses(100)
    wanted = culler.cull(rotations, translations, sort=True)
    assert len(wanted) > 50
    wide = np.zeros((200, 14), np.float32)
    wide[::2, 1:9:2], wide[::2, 9:12] = rotations, translations
    layouts = [
        (wide[::2, 1:9:2], wide[::2, 9:12]),
        (np.asfortranarray(rotations), np.asfortranarray(translations)),
        (rotations[::-1].copy()[::-1], translations[::-1].copy()[::-1]),
        (rotations.astype(np.float64), translations.tolist()),
        (rotations.astype(">f4"), translations.astype(">f8")),
    ]
    for other in layouts:
        np.testing.assert_array_equal(culler.cull(*other, sort=True), wanted)


def test_one_culler_serves_many_threads():
    shape = sdop.Shape(*bracket())
    culler = sdop.Culler([shape], [0] * 100)
    frames = [poses(100, seed) for seed in range(8)]
    wanted = [sdop.Culler([shape], [0] * 100).cull(*frame, sort=True).tolist() for frame in frames]
    wrong = []

    def cull(which):
        for _ in range(50):
            if culler.cull(*frames[which], sort=True).tolist() != wanted[which]:
                wrong.append(which)

    threads = [threading.Thread(target=cull, args=(which,)) for which in range(8)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert not wrong
