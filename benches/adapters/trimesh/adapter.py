"""trimesh: its CollisionManager, which asks python-fcl."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))

from fractions import Fraction

import numpy as np
import trimesh
from wire import CaseSkipped, Culler, serve


class Adapter(Culler):
    def frame(self, rotations, translations):
        manager = trimesh.collision.CollisionManager()
        meshes = [trimesh.Trimesh(it["vertices"], it["triangles"], process=False) for it in self.shapes]
        bounds = []
        for number, (turn, place) in enumerate(zip(rotations, translations, strict=True)):
            mesh, at = meshes[self.body_shapes[number]], transform(turn, place)
            manager.add_object(str(number), mesh, at)
            bounds.append(trimesh.bounds.corners(mesh.bounds) @ at[:3, :3].T + at[:3, 3])
        check_nesting(bounds)
        _, names = manager.in_collision_internal(return_names=True)
        return self.pairs([(int(a), int(b)) for a, b in names])


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
