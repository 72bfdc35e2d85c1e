"""trimesh: one CollisionManager for all frames, which asks python-fcl."""

from fractions import Fraction

import numpy as np
import trimesh
from wire import CaseSkipped, ObjectCuller, serve


class Adapter(ObjectCuller):
    """An object is a name in the manager, and the number of its shape."""

    def __init__(self, scene):
        super().__init__(scene)
        self.manager, self.named = trimesh.collision.CollisionManager(), 0
        self.meshes = [trimesh.Trimesh(it["vertices"], it["triangles"], process=False) for it in self.shapes]

    def frame(self, rotations, translations):
        bounds = []
        for number, (turn, place) in enumerate(zip(rotations, translations, strict=True)):
            shape, at = self.body_shapes[number], transform(turn, place)
            self.objects[number] = self.posed(self.objects[number], shape, at)
            bounds.append(trimesh.bounds.corners(self.meshes[shape].bounds) @ at[:3, :3].T + at[:3, 3])
        check_nesting(bounds)
        numbers = {name: number for number, (name, _) in enumerate(self.objects)}
        _, names = self.manager.in_collision_internal(return_names=True)
        return self.pairs([(numbers[a], numbers[b]) for a, b in names])

    def posed(self, it, shape, at):
        if it is not None and it[1] == shape:
            self.manager.set_transform(it[0], at)
            return it
        if it is not None:
            self.remove(it)
        self.named += 1
        self.manager.add_object(str(self.named), self.meshes[shape], at)
        return str(self.named), shape

    def remove(self, it):
        self.manager.remove_object(it[0])


def check_nesting(corners):
    """trimesh tests surfaces and makes no claim about a mesh inside another. No mesh is inside
    another if no box is."""
    if not corners:
        return
    lower, upper = np.min(corners, axis=1), np.max(corners, axis=1)
    nested = ((lower[:, None] <= lower) & (upper[:, None] >= upper)).all(axis=2)
    if (nested & ~np.eye(len(corners), dtype=bool)).any():
        raise CaseSkipped("one mesh may lie inside of another, and it tests surfaces")


def transform(turn, place):
    """The matrix of a quaternion, if float64 can represent it; other cases are skipped."""
    x, y, z, w = (Fraction(float(c)) for c in turn)
    norm = x * x + y * y + z * z + w * w
    exact = [
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]
    matrix = np.eye(4)
    matrix[:3, :3] = [[float(entry / norm) for entry in row] for row in exact]
    if any(Fraction(matrix[i, j]) != exact[i][j] / norm for i in range(3) for j in range(3)):
        raise CaseSkipped("float64 can't hold the matrix of a rotation")
    matrix[:3, 3] = place
    return matrix


if __name__ == "__main__":
    serve(Adapter, "trimesh")
