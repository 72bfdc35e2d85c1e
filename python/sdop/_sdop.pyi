import os
from collections.abc import Callable, Sequence
from typing import Any, Literal, TypedDict, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "BoxCuller",
    "BoxWorld",
    "Culler",
    "Events",
    "Scene",
    "SdopError",
    "Shape",
    "World",
    "box_pairs",
    "exact_meet",
    "judge",
    "main",
]

_Axes = Literal["principal", "model"]
_Faces = Literal[6, 14, 18, 26]
_Motion = Literal["dynamic", "resting", "fixed"]
_Origin = Literal["file", "ball"]
_Pose = tuple[ArrayLike, ArrayLike]

class SdopError(ValueError): ...

def box_pairs(
    boxes: ArrayLike, *, groups: ArrayLike | None = None, sort: bool = False, threads: int = 1
) -> NDArray[np.uint32]: ...

@final
class BoxCuller:
    def __new__(cls, *, finder: str = "auto", threads: int = 1) -> BoxCuller: ...
    def cull(self, boxes: ArrayLike, *, groups: ArrayLike | None = None, sort: bool = False) -> NDArray[np.uint32]: ...

@final
class BoxWorld:
    def __new__(cls, *, finder: str = "auto", threads: int = 1) -> BoxWorld: ...
    def insert(self, bounds: ArrayLike, *, motion: _Motion = "dynamic", groups: tuple[int, int] = ...) -> int: ...
    def remove(self, id: int) -> None: ...
    def set_bounds(self, id: int, bounds: ArrayLike) -> None: ...
    def set_motion(self, id: int, motion: _Motion) -> None: ...
    def set_many(self, ids: ArrayLike, boxes: ArrayLike) -> None: ...
    def cull(self) -> NDArray[np.uint64]: ...
    def pairs(self) -> NDArray[np.uint64]: ...
    def events(self) -> Events: ...
    def snapshot(self) -> bytes: ...
    def restore(self, snapshot: bytes) -> None: ...
    def __len__(self) -> int: ...
    def __contains__(self, key: int, /) -> bool: ...

@final
class Shape:
    def __new__(
        cls,
        vertices: Any,
        triangles: ArrayLike | None = None,
        *,
        radius: float | None = None,
        origin: _Origin = "file",
        k: _Faces = 18,
        axes: _Axes = "principal",
        name: str = "mesh",
    ) -> Shape: ...
    @staticmethod
    def load(
        path: str | os.PathLike[str],
        *,
        radius: float | None = None,
        origin: _Origin = "file",
        k: _Faces = 18,
        axes: _Axes = "principal",
    ) -> Shape: ...
    @property
    def name(self) -> str: ...
    @property
    def vertices(self) -> NDArray[np.float32]: ...
    @property
    def triangles(self) -> NDArray[np.uint32]: ...
    @property
    def ball(self) -> tuple[list[float], float]: ...
    @property
    def k(self) -> int: ...
    @property
    def slabs(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]: ...
    @property
    def offset(self) -> list[float]: ...
    @property
    def pose_offset(self) -> list[float]: ...
    @property
    def scale(self) -> float: ...

@final
class Culler:
    def __new__(
        cls,
        shapes: Sequence[Shape],
        body_shapes: ArrayLike,
        *,
        dynamic: ArrayLike | None = None,
        strategy: str = "s-dop-sequential",
        finder: str = "auto",
        interest: Sequence[int] | None = None,
        groups: ArrayLike | None = None,
        threads: int = 1,
    ) -> Culler: ...
    def cull(self, rotations: ArrayLike, translations: ArrayLike, *, sort: bool = False) -> NDArray[np.uint32]: ...
    @property
    def finder(self) -> str: ...
    def __len__(self) -> int: ...

class _Body(TypedDict):
    shape: int
    rotation: list[float]
    translation: list[float]
    margin: float
    dynamic: bool
    groups: tuple[int, int]

@final
class World:
    def __new__(
        cls, shapes: Sequence[Shape], *, strategy: str = "s-dop-sequential", finder: str = "auto", threads: int = 1
    ) -> World: ...
    def add_shape(self, shape: Shape) -> int: ...
    def remove_shape(self, shape: int) -> None: ...
    def insert(
        self,
        shape: int,
        rotation: ArrayLike,
        translation: ArrayLike,
        *,
        margin: float = 0.0,
        dynamic: bool = True,
        groups: tuple[int, int] = ...,
    ) -> int: ...
    def remove(self, id: int) -> None: ...
    def set_pose(self, id: int, rotation: ArrayLike, translation: ArrayLike) -> None: ...
    def set_poses(self, ids: ArrayLike, rotations: ArrayLike, translations: ArrayLike) -> None: ...
    def body(self, id: int) -> _Body: ...
    def cull(self) -> NDArray[np.uint64]: ...
    def pairs(self) -> NDArray[np.uint64]: ...
    def events(self) -> Events: ...
    def snapshot(self) -> bytes: ...
    def restore(self, snapshot: bytes) -> None: ...
    def __len__(self) -> int: ...
    def __contains__(self, key: int, /) -> bool: ...

@final
class Events:
    @property
    def begun(self) -> NDArray[np.uint64]: ...
    @property
    def persisting(self) -> NDArray[np.uint64]: ...
    @property
    def ended(self) -> NDArray[np.uint64]: ...

class _CaseShape(TypedDict):
    name: str
    vertices: NDArray[np.float32]
    triangles: NDArray[np.uint32]
    ball: tuple[list[float], float]
    basis: NDArray[np.float32]
    lo: NDArray[np.float32]
    hi: NDArray[np.float32]

@final
class Scene:
    @property
    def claim(self) -> str: ...
    @property
    def shapes(self) -> list[_CaseShape]: ...
    @property
    def body_shapes(self) -> NDArray[np.uint32]: ...
    @property
    def dynamic(self) -> NDArray[np.bool_]: ...

def exact_meet(shape_a: Shape, pose_a: _Pose, shape_b: Shape, pose_b: _Pose) -> bool: ...
def judge(
    make: Callable[[Scene], Any],
    claims: str,
    cases: str,
    seed: int | None,
    extra_limit: float | None,
    fail_fast: bool,
) -> tuple[bool, str, str, tuple[str, NDArray[np.float32], list[tuple[str, bytes]]] | None]: ...
def main(arguments: list[str]) -> int: ...
