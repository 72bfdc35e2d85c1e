"""The same bodies as in Rust's ``tests/languages.rs``, and the same hashes: an answer doesn't
depend on the language that asks."""

import hashlib

import numpy as np
import pytest
import sdop

BODIES = 1600
PAIRS = "dd975ffe385c67426ced847af96edb364ab60e6bc5da94ab79f2bc33dbce7a22"
TOUCHING = "11e4060fa18adb68bc45bf942c8b3549ee37c7d734098993f9b60d578626d9d6"
PARTS = "955ba31aadad357eae3d7054477333fbe62551f35855c8eee73c8962aafeb42e"


def bracket():
    """A mesh in the form of an L, from two boxes."""
    cube = np.array([[i >> axis & 1 for axis in range(3)] for i in range(8)], dtype=np.float64)
    faces = np.array(
        [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4]]
        + [[2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]
    )
    vertices = np.concatenate([cube * [4, 1, 1], cube * [1, 3, 1]])
    return sdop.Shape(vertices, np.concatenate([faces, faces + 8]))


def poses(first, count):
    """Small whole numbers as quaternions, and eighths as translations: exact in every language."""
    i = np.arange(first, first + count)
    rotations = np.stack([7 * i % 13 - 6, 5 * i % 11 - 5, 3 * i % 7 - 3, i % 4 + 1], axis=1)
    translations = np.stack([131 * i % 509, 577 * i % 521, 29 * i % 503], axis=1) / 8
    return rotations.astype(np.float32), translations.astype(np.float32)


def hash_of(numbers):
    return hashlib.sha256(np.asarray(numbers).astype("<u4").tobytes()).hexdigest()


def world_of(shape):
    """A world of all bodies, each fifth fixed, and the number of each id."""
    world = sdop.World([shape])
    ids = [world.insert(0, q, t, motion="dynamic" if i % 5 else "fixed") for i, (q, t) in enumerate(zip(*poses(0, BODIES)))]
    return world, np.vectorize({id: i for i, id in enumerate(ids)}.get)


@pytest.mark.parametrize("threads", [1, 2])
def test_pairs_have_the_hash_of_rust(threads):
    culler = sdop.Culler([bracket()], np.zeros(BODIES, int), dynamic=np.arange(BODIES) % 5 != 0, threads=threads)
    assert hash_of(culler.cull(*poses(0, BODIES), sort=True)) == PAIRS


def test_queries_have_the_hash_of_rust():
    world, number = world_of(bracket())
    index = sdop.QueryIndex()
    index.update(world)
    found = index.touching_balls(poses(BODIES, 50)[1], np.arange(50) % 9)
    assert hash_of(np.column_stack([found[:, 0], number(found[:, 1])])) == TOUCHING


def test_parts_have_the_hash_of_rust():
    unturned = np.tile(np.float32([0, 0, 0, 1]), (3, 1))
    compound = sdop.Compound([bracket()], [0, 0, 0], unturned, np.outer([0, 1.5, 3], [0, 1, 1]), name="three")
    world, number = world_of(compound.shape)
    culler = sdop.PartCuller()
    culler.set_parts(0, compound)
    world.cull()
    bodies, parts = culler.cull(world)
    assert hash_of(np.hstack([number(bodies), parts])) == PARTS
