"""What objects are to Python: iteration, copies and pickles, `repr`, and names of choices."""

import ast
import copy
import pickle
from pathlib import Path

import numpy as np
import pytest
import sdop

UNTURNED, TURNED = [0, 0, 0, 1], [0, 0, 0.6, 0.8]
SPOT = Path(__file__).resolve().parents[2] / "data/meshes/spot.tri"


def tetrahedron(size=1, **options):
    corners = [[0, 0, 0], [size, 0, 0], [0, size, 0], [0, 0, size]]
    return sdop.Shape(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], **options)


def arm():
    return sdop.Compound([tetrahedron()], [0, 0], [UNTURNED, TURNED], [[0, 0, 0], [2.1, 0, 0]], name="arm")


def insert(world, x, **options):
    if hasattr(world, "set_pose"):
        return world.insert(0, TURNED, [x, 0, 0], margin=0.1, **options)
    return world.insert([x, 0, 0, x + 1, 1, 1], **options)


def move(world, id, x):
    if hasattr(world, "set_pose"):
        return world.set_pose(id, UNTURNED, [x, 0, 0])
    world.set_bounds(id, [x, 0, 0, x + 1, 1, 1])


def lists(found):
    return [column.tolist() for column in found] if isinstance(found, tuple) else [found.tolist()]


def of_pickle(it):
    return pickle.loads(pickle.dumps(it))


@pytest.fixture(params=["World", "BoxWorld", "PeriodicWorld", "PeriodicBoxes"])
def world(request):
    """Twelve bodies in a row, each of which touches the next; a world has a free shape number."""
    shapes = [[tetrahedron(), tetrahedron(2), tetrahedron(3)]] if "x" not in request.param else []
    periods = [(30.0, None, None)] if "Periodic" in request.param else []
    world = getattr(sdop, request.param)(*shapes, *periods, finder="sweep")
    for x in range(12):
        insert(world, x / 2, motion=["fixed", "dynamic"][x % 3 > 0], groups=(3 if x % 4 else 1, 1))
    if request.param == "World":
        world.remove_shape(1)
    return world


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, of_pickle])
def test_a_copy_continues_as_its_world(world, copied):
    ids = list(world)
    world.cull(), world.events()
    world.exclude(ids[4], ids[5])
    world.cull()
    world.remove(ids[0])  # a slot to reuse, and pairs whose end was not read yet
    if copied is of_pickle and "Periodic" in repr(world):
        with pytest.raises(TypeError, match="cannot pickle '(sdop.)?Periodic"):
            copied(world)
        return
    other, third = copied(world), copied(world)
    move(third, ids[1], 15)
    for it in (world, other):
        move(it, ids[3], 4)
    assert lists(other.cull()) == lists(world.cull()) != lists(third.cull())
    kinds = ("begun", "persisting", "ended")
    events = [[lists(getattr(it, kind))[0] for kind in kinds] for it in (world.events(), other.events())]
    assert events[0] == events[1] and all(events[0]) and insert(world, 0) == insert(other, 0)
    if hasattr(world, "body"):
        assert [world.body(id) for id in world] == [other.body(id) for id in other]
    if hasattr(world, "add_shape"):
        assert world.add_shape(tetrahedron()) == other.add_shape(tetrahedron()) == 1


def test_ids_ascend_and_are_iterated_over(world):
    first = world.ids()
    world.remove(int(first[0])), world.cull()
    new = insert(world, 0)
    ids = world.ids()  # the new one has the first slot, and a greater number than all others
    assert ids.dtype == np.uint64 and ids.tolist() == list(world) == [*first.tolist()[1:], new]
    assert len(world) == len(ids) and ids[3] in world and first[0] not in world
    assert not any(other in world for other in (-1, 2**64, 0.5, "0", None))


def test_bodies_change_in_place(world):
    a, b = (int(id) for id in world.ids()[[1, 2]])
    changes = [lambda: world.set_groups(a, [0, 0]), lambda: world.set_groups(a, (1, 1)), lambda: move(world, a, -2.5)]
    if hasattr(world, "set_shape"):
        changes += [lambda: world.set_margin(a, 2), lambda: world.set_margin(a, 0), lambda: world.set_shape(a, 2)]
    if hasattr(world, "replace_shape"):
        changes += [lambda: world.replace_shape(2, tetrahedron()), lambda: world.replace_shape(0, tetrahedron(4))]
    for number, change in enumerate(changes):
        change()
        assert ([a, b] in lists(world.cull())[0]) == (number in (1, 3, 5, 7)), number
    if hasattr(world, "replace_shape"):
        assert lists(of_pickle(world).cull()) == lists(world.cull())


SHAPES = [
    sdop.Shape.load(SPOT, radius=0.3, origin="ball", k=26),
    sdop.Shape(np.random.default_rng(3).normal(size=(30, 3)) + 1e7, np.arange(30).reshape(10, 3), name="far"),
    arm().shape,
]


@pytest.mark.parametrize("shape", SHAPES)
def test_a_pickled_shape_has_the_same_bits(shape):
    other = of_pickle(shape)
    for name in ("name", "ball", "k", "offset", "pose_offset", "rounding", "scale"):
        assert getattr(other, name) == getattr(shape, name), name
    assert sdop.World([other]).snapshot() == sdop.World([shape]).snapshot()  # with a digest of all else


def test_a_pickled_compound_has_the_same_parts():
    world, found = sdop.World([arm().shape]), []
    ids = [world.insert(0, UNTURNED, [x, 0, 0]) for x in (0, 1.5, 2.5)]
    world.cull()
    for compound in (arm(), of_pickle(arm()), copy.deepcopy(arm())):
        culler = sdop.PartCuller()
        culler.set_parts(0, compound)
        found.append((repr(compound), lists(culler.cull(world))))
    assert found[0] == found[1] == found[2] and len(found[0][1][1]) > len(ids)


@pytest.mark.parametrize("it", [tetrahedron(), sdop.World([tetrahedron()]), sdop.BoxWorld()])
def test_pickles_of_other_versions_are_refused(it):
    make, (version, state) = it.__reduce__()
    assert repr(make(version, state)) == repr(it)
    with pytest.raises(sdop.SdopError, match=f"pickle of version {version + 1}, and .* {version}\nhelp: load it"):
        make(version + 1, None)
    for damaged in ((), None, state[:-1], (*state[:-1], b"{}")):
        with pytest.raises((TypeError, ValueError)):
            make(version, damaged)


def test_repr_says_what_is_inside(world):
    spot, manager = sdop.Shape.load(SPOT), sdop.CollisionManager()
    manager.add_object("one", spot), world.cull()
    of = {"World": " of 2 shapes", "PeriodicWorld": " of 3 shapes"}.get(type(world).__name__)
    for it, text in [
        (world, f"{type(world).__name__}: 12 {'bodies' + of if of else 'boxes'}"),
        (spot, f"Shape spot: {len(spot.triangles):,} triangles, radius {spot.ball[1]:.3f}"),
        (arm(), f"Compound arm: 2 parts, radius {arm().shape.ball[1]:.3f}"),
        (sdop.Culler([spot], [0]), "Culler: 1 body of 1 shape"),
        (sdop.QueryIndex(), "QueryIndex: 0 bodies"),
        (manager, "CollisionManager: 1 object"),
    ]:
        assert repr(it) == f"<sdop.{text}>"
    assert f"Events: {len(lists(world.pairs())[0])} pairs begun, 0 pairs ended>" in repr(world.events())


@pytest.mark.parametrize(
    ("kind", "call"),
    [
        ("_Finder", lambda name: sdop.BoxCuller(finder=name)),
        ("_Strategy", lambda name: sdop.World([], strategy=name)),
        ("_Claim", lambda name: sdop.judge(None, claims=name)),
        ("_Faces", lambda _: tetrahedron(k=7777777)),
    ],
)
def test_choices_of_the_stub_are_those_of_the_library(kind, call):
    stub = Path(sdop.__file__).with_name("_sdop.pyi").read_text(encoding="utf-8")
    names = next(it.value.slice for it in ast.parse(stub).body if isinstance(it, ast.Assign) and it.targets[0].id == kind)
    with pytest.raises(sdop.SdopError, match="one of: ") as raised:
        call("xxxxxxxxxxxxxxxx")
    known = set(str(raised.value).split("one of: ")[1].split(", ")) - {"s-dop-time-critical"}  # which has no budget here
    assert {str(name) for name in ast.literal_eval(names)} == known
