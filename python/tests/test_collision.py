"""The manager under trimesh's names."""

import numpy as np
import pytest
import sdop
import trimesh


def at(x, y=0.0, z=0.0):
    return trimesh.transformations.translation_matrix([x, y, z])


def test_trimesh_tests_of_its_own_manager():
    """The questions of trimesh's tests that are ours: internal, single, other, names, removal."""
    cube = trimesh.creation.box(extents=[1, 1, 1])
    manager = sdop.CollisionManager()
    manager.add_object("cube0", cube)
    manager.add_object("cube1", cube, at(2))
    assert manager.in_collision_internal() is False
    assert manager.in_collision_internal(return_names=True) == (False, set())
    manager.set_transform("cube1", at(0.5))
    assert manager.in_collision_internal(return_names=True) == (True, {("cube0", "cube1")})
    assert manager.in_collision_single(cube, at(-0.6), return_names=True) == (True, {"cube0"})
    assert manager.in_collision_single(cube, at(-3)) is False
    manager.remove_object("cube0")
    assert manager.in_collision_internal() is False
    with pytest.raises(ValueError, match="cube0"):
        manager.set_transform("cube0", at(0))
    other = sdop.CollisionManager()
    other.add_object("other", cube, at(1.2))
    assert manager.in_collision_other(other, return_names=True) == (True, {("cube1", "other")})
    assert other.in_collision_other(manager, return_names=True) == (True, {("other", "cube1")})


def test_a_mesh_inside_of_another_collides():
    manager = sdop.CollisionManager()
    manager.add_object("outer", trimesh.creation.icosphere(radius=2))
    manager.add_object("inner", trimesh.creation.box(extents=[0.1, 0.1, 0.1]))
    assert manager.in_collision_internal()


def test_rotations_are_those_of_the_matrix():
    bar = trimesh.creation.box(extents=[10, 0.5, 0.5])
    cube = trimesh.creation.box(extents=[1, 1, 1])
    for axis, place in [([0, 0, 1], (0, 4, 0)), ([0, 1, 0], (0, 0, 4)), ([1, 0, 0], (4, 0, 0))]:
        for angle, meets in [(0, place[0] > 0), (np.pi / 2, True), (np.pi, place[0] > 0), (-np.pi / 2, True)]:
            manager = sdop.CollisionManager()
            manager.add_object("bar", bar, trimesh.transformations.rotation_matrix(angle, axis))
            assert manager.in_collision_single(cube, at(*place)) is meets, (axis, angle)


def test_scaling_transforms_are_refused():
    with pytest.raises(ValueError, match="scales or mirrors"):
        sdop.CollisionManager().add_object("cube", trimesh.creation.box(), np.diag([2, 2, 2, 1]))


def test_translations_are_float64():
    cube = trimesh.creation.box(extents=[1, 1, 1])
    for step, meets in [(0.7, True), (1.0, True), (1.0000002, False)]:
        manager = sdop.CollisionManager()
        manager.add_object("near", cube, at(1e9))
        manager.add_object("far", cube, at(1e9 + step))
        assert manager.in_collision_internal() is meets, step


def test_a_mesh_far_from_its_origin():
    cube = trimesh.creation.box(extents=[1, 1, 1])
    away = cube.copy().apply_translation([1e7, 0, 0])
    turned = trimesh.transformations.rotation_matrix(np.pi / 2, [0, 0, 1])
    manager = sdop.CollisionManager()
    manager.add_object("away", away)
    assert manager.in_collision_single(cube, at(1e7 + 0.9))
    assert not manager.in_collision_single(cube, at(1e7 + 1.1))
    manager.set_transform("away", turned)
    assert manager.in_collision_single(cube, at(0, 1e7 + 0.9))
    assert not manager.in_collision_single(cube, at(0, 1e7 + 1.1))
    assert not manager.in_collision_single(cube, at(1e7))
