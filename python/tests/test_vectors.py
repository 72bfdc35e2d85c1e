"""The test vectors of ``data/vectors``: cases of two bodies with exact answers."""

import json
from pathlib import Path

import numpy as np
import pytest
import sdop

FILES = sorted(Path(__file__).resolve().parents[2].joinpath("data/vectors").glob("[!s]*.json"))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_answers_are_those_of_the_vectors(file):
    cases = json.loads(file.read_text(encoding="utf-8"))["cases"]
    assert cases
    for case in cases:
        name, meet = case["name"], case["meet"]
        boxes = np.float32([body["box"] for body in case["bodies"]])
        assert len(sdop.box_pairs(boxes)) == meet.get("aabb", len(sdop.box_pairs(boxes))), name
        if "mesh" not in meet:
            continue
        shapes = [sdop.Shape(shape["vertices"], shape["triangles"]) for shape in case["shapes"]]
        numbers = [body["shape"] for body in case["bodies"]]
        poses = np.float32([body["pose"] for body in case["bodies"]])
        rotations, translations = poses[:, :4], poses[:, 4:]
        (a, b), (first, second) = numbers, zip(rotations, translations)
        assert sdop.exact_meet(shapes[a], first, shapes[b], second) == meet["mesh"], name
        found = sdop.Culler(shapes, numbers).cull(rotations, translations)
        world = sdop.World(shapes)
        [world.insert(*body) for body in zip(numbers, rotations, translations)]
        assert len(found) >= meet["mesh"] and len(world.cull()) >= meet["mesh"], name


def test_there_are_vectors():
    assert len(FILES) > 10
