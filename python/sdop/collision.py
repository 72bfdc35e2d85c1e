"""Exact mesh collisions by the method names of ``trimesh.collision.CollisionManager``."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._sdop import Shape, World, exact_meet

_Names = set[tuple[str, str]]
_Vector = NDArray[np.float64]


class CollisionManager:
    """A set of named meshes that finds which of them collide.

    Method names and meanings are those of ``trimesh.collision.CollisionManager``; a pair collides
    when its posed meshes share a point, or one lies inside of a closed part of the other, in exact
    arithmetic. python-fcl, which trimesh asks, doesn't report a mesh that is inside of another, so
    this manager may report more pairs. Distances and contact points are not computed.

    Transforms are rigid: 4 × 4, a rotation and a translation. The rotation is rounded to a
    quaternion of float32, the translation stays in float64. A mesh far from its origin is placed by
    a point near it, whose position is computed in float64.
    """

    def __init__(self) -> None:
        self._world = World([])
        self._objects: dict[str, _Object] = {}
        self._names: dict[int, str] = {}

    def add_object(self, name: str, mesh: Any, transform: ArrayLike | None = None) -> None:
        """Adds a mesh as `Shape` takes it, or a `Shape`, and prepares it for questions. An object
        of the same name is replaced."""
        self._add(name, mesh, transform).shape._prepare()

    def _add(self, name: str, mesh: Any, transform: ArrayLike | None) -> _Object:
        shape = mesh if isinstance(mesh, Shape) else Shape(mesh, name=name)
        offset = np.array(shape.pose_offset)
        if offset.any():
            shape = Shape(shape.vertices, shape.triangles, name=name)
        rotation, translation = _pose(transform, offset)
        if name in self._objects:
            self.remove_object(name)
        number = self._world.add_shape(shape)
        id = self._world.insert(number, rotation, translation)
        added = self._objects[name] = _Object(id, number, shape, offset, rotation, translation)
        self._names[id] = name
        return added

    def remove_object(self, name: str) -> None:
        """Removes an object."""
        gone = self._find(name)
        self._world.remove(gone.id)
        self._world.remove_shape(gone.number)
        del self._objects[name], self._names[gone.id]

    def set_transform(self, name: str, transform: ArrayLike) -> None:
        """Moves an object."""
        moved = self._find(name)
        moved.rotation, moved.translation = _pose(transform, moved.offset)
        self._world.set_pose(moved.id, moved.rotation, moved.translation)

    def in_collision_internal(self, return_names: bool = False) -> bool | tuple[bool, _Names]:
        """Whether any two objects collide; on request with the names of all pairs that do, each
        sorted."""
        names: _Names = set()
        for pair in self._world.cull().tolist():
            a, b = sorted(self._names[id] for id in pair)
            if self._objects[a].meets(self._objects[b]):
                if not return_names:
                    return True
                names.add((a, b))
        return (bool(names), names) if return_names else False

    def in_collision_single(
        self, mesh: Any, transform: ArrayLike | None = None, return_names: bool = False
    ) -> bool | tuple[bool, set[str]]:
        """Whether a mesh that is not in the manager collides with any object; on request with their
        names."""
        one = CollisionManager()
        one._add("", mesh, transform)
        found = self._colliding(one)
        names = {mine for mine, _ in found}
        return (bool(names), names) if return_names else bool(names)

    def in_collision_other(
        self, other_manager: CollisionManager, return_names: bool = False
    ) -> bool | tuple[bool, _Names]:
        """Whether any object collides with one of another manager; on request with the names of the
        pairs, ours first."""
        names = self._colliding(other_manager)
        return (bool(names), names) if return_names else bool(names)

    def _colliding(self, other: CollisionManager) -> _Names:
        # A world of both: theirs and ours collide, but neither collides with its own.
        world = World([])
        sides: dict[int, tuple[bool, str]] = {}
        for is_ours, manager, groups in ((True, self, (1, 2)), (False, other, (2, 1))):
            for name, it in manager._objects.items():
                number = world.add_shape(it.shape)
                sides[world.insert(number, it.rotation, it.translation, groups=groups)] = (is_ours, name)
        names: _Names = set()
        for pair in world.cull().tolist():
            (_, theirs), (_, mine) = sorted(sides[id] for id in pair)
            if self._objects[mine].meets(other._objects[theirs]):
                names.add((mine, theirs))
        return names

    def __repr__(self) -> str:
        return f"<sdop.CollisionManager: {len(self._objects):,} object{'s' * (len(self._objects) != 1)}>"

    def _find(self, name: str) -> _Object:
        if name not in self._objects:
            raise ValueError(f"{name} not in collision manager!")
        return self._objects[name]


class _Object:
    def __init__(
        self, id: int, number: int, shape: Shape, offset: _Vector, rotation: NDArray[np.float32], translation: _Vector
    ) -> None:
        self.id, self.number, self.shape, self.offset = id, number, shape, offset
        self.rotation, self.translation = rotation, translation

    def meets(self, other: _Object) -> bool:
        mine, theirs = (self.rotation, self.translation), (other.rotation, other.translation)
        return exact_meet(self.shape, mine, other.shape, theirs)


def _pose(transform: ArrayLike | None, offset: _Vector) -> tuple[NDArray[np.float32], _Vector]:
    """A rigid transform as a quaternion x, y, z, w, rounded to float32, and the place of a point of
    the mesh."""
    matrix = np.eye(4) if transform is None else np.asarray(transform, dtype=np.float64)
    if matrix.shape != (4, 4) or not np.array_equal(matrix[3], [0, 0, 0, 1]):
        raise ValueError(f"a transform has shape (4, 4) and the last row 0, 0, 0, 1; this one is\n{matrix}")
    turn = matrix[:3, :3]
    if not np.allclose(turn @ turn.T, np.eye(3), atol=1e-6) or np.linalg.det(turn) < 0:
        raise ValueError(
            "a transform turns and moves, and this one also scales or mirrors\n"
            "help: apply the scale to the mesh: mesh.apply_transform(…)"
        )
    return _quaternion(turn).astype(np.float32), matrix[:3, 3] + turn @ offset


def _quaternion(turn: NDArray[np.float64]) -> NDArray[np.float64]:
    """The unit quaternion x, y, z, w of a rotation matrix: the eigenvector of Bar-Itzhack's
    matrix."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = turn
    symmetric = np.array(
        [
            [xx - yy - zz, yx + xy, zx + xz, zy - yz],
            [yx + xy, yy - xx - zz, zy + yz, xz - zx],
            [zx + xz, zy + yz, zz - xx - yy, yx - xy],
            [zy - yz, xz - zx, yx - xy, xx + yy + zz],
        ]
    )
    return np.linalg.eigh(symmetric)[1][:, -1]
