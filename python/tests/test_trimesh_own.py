"""trimesh's own collision tests, asked of our manager.

``TRIMESH_TESTS`` names the folder of trimesh's tests, from its source distribution (``.ci/python``
fetches it); without it these tests are skipped. The file runs as it is. It imports a module
``generic``, which the distribution lacks: the few names that it takes from there are given here.
"""

import importlib.util
import logging
import os
import sys
import types
import unittest
from pathlib import Path

import numpy as np
import pytest
import sdop
import trimesh

NOT_OURS = {
    "test_distance": "distances and penetration depths are not computed",
    "test_scene": "its model cycloidal.3DXML is not in the source distribution",
}
"""Questions that our manager does not answer, with the reason. In those that it does, contact
points (``return_data``) are not computed either: it returns none, and their checks, which are made
for each contact, do not run."""

QUESTIONS = ["test_collision", "test_collision_batch", "test_random_spheres"]
TESTS = os.environ.get("TRIMESH_TESTS")


class Manager(sdop.CollisionManager):
    """Ours, which returns no contacts when it is asked for them."""

    def in_collision_single(self, *arguments, return_data=False, **options):
        answer = super().in_collision_single(*arguments, **options)
        return (*answer, []) if return_data else answer


def unit_cube(name):
    assert name == "unit_cube.STL"
    return trimesh.creation.box()


@pytest.fixture
def theirs(monkeypatch):
    if TESTS is None:
        pytest.skip("TRIMESH_TESTS does not name the folder of trimesh's tests")
    random = np.random.default_rng(1).random
    generic = types.SimpleNamespace(
        unittest=unittest, trimesh=trimesh, np=np, log=logging.getLogger("trimesh"), get_mesh=unit_cube, random=random
    )
    monkeypatch.setitem(sys.modules, "generic", generic)
    monkeypatch.setitem(sys.modules, "fcl", types.ModuleType("fcl"))  # without it their tests ask nothing
    monkeypatch.setattr(trimesh.collision, "CollisionManager", Manager)
    spec = importlib.util.spec_from_file_location("trimesh_test_collision", Path(TESTS, "test_collision.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.CollisionTest


@pytest.mark.parametrize("question", QUESTIONS)
def test_trimesh_question(theirs, question):
    getattr(theirs(question), question)()


def test_every_question_is_listed(theirs):
    found = {name for name in dir(theirs) if name.startswith("test_")}
    assert found == set(QUESTIONS) | set(NOT_OURS)
