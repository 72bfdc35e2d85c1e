"""The judge, from Python: right cullers pass, wrong ones don't."""

import numpy as np
import sdop


class Boxes:
    """All boxes against all."""

    def __init__(self, scene):
        self.dynamic = scene.dynamic

    def change(self, body_shapes, dynamic, was):
        self.dynamic = dynamic

    def meet(self, lower, upper):
        return (lower <= upper).all(axis=2)

    def frame(self, boxes):
        meet = self.meet(boxes[:, None, :3], boxes[None, :, 3:])
        moves = self.dynamic[:, None] | self.dynamic[None, :]
        return np.argwhere(np.triu(meet & meet.T & moves, k=1))


class Strict(Boxes):
    """Touching is no meeting to it."""

    def meet(self, lower, upper):
        return (lower < upper).all(axis=2)


class Ours:
    def __init__(self, scene):
        self.shapes = [sdop.Shape(shape["vertices"], shape["triangles"]) for shape in scene.shapes]
        self.change(scene.body_shapes, scene.dynamic, None)

    def change(self, body_shapes, dynamic, was):
        self.culler = sdop.Culler(self.shapes, body_shapes, dynamic=dynamic)

    def frame(self, rotations, translations):
        return self.culler.cull(rotations, translations)


class Broken:
    def __init__(self, scene):
        pass

    def frame(self, *columns):
        return [[0, 0]][1:] + {}


def test_right_boxes_pass_and_strict_ones_fail(tmp_path):
    verdict = sdop.judge(Boxes, claims="aabb")
    assert verdict and verdict.passed and "PASS" in str(verdict), verdict.text
    verdict = sdop.judge(Strict, claims="aabb")
    failed = [case for case in verdict.cases if case["outcome"] == "fail"]
    assert not verdict and failed, verdict.text
    i, j = verdict.missed.pair
    a, b = verdict.missed.boxes[[i, j]]
    assert (a[:3] <= b[3:]).all() and (b[:3] <= a[3:]).all() and verdict.missed.point is not None
    assert verdict.missed.depth_ulps == 1  # they only touch
    verdict.missed.save(tmp_path)
    assert (tmp_path / "missed-pair.ndjson").stat().st_size > 0


def test_our_culler_passes():
    verdict = sdop.judge(Ours, claims="mesh", cases="exact/*")
    assert verdict, verdict.text


def test_a_case_may_be_skipped():
    class FewBoxes(Boxes):
        def frame(self, boxes):
            if len(boxes) > 2:
                raise sdop.CaseSkipped("more than two")
            return super().frame(boxes)

    verdict = sdop.judge(FewBoxes, claims="aabb", cases="hard/counts/*")
    outcomes = {case["outcome"] for case in verdict.cases}
    assert outcomes == {"pass", "skipped"} and not verdict and "more than two" in verdict.text


def test_an_exception_is_an_error_of_the_case():
    verdict = sdop.judge(Broken, cases="exact/*", fail_fast=True)
    assert not verdict and "TypeError" in verdict.text and "test_judge.py" in verdict.text
