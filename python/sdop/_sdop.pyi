import os
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Literal, TypedDict, final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Self

__all__ = [
    "BoxCuller",
    "BoxWorld",
    "CaseSkipped",
    "Compound",
    "Culler",
    "Events",
    "PartCuller",
    "PeriodicBoxes",
    "PeriodicEvents",
    "PeriodicWorld",
    "QueryIndex",
    "Scene",
    "SdopError",
    "Shape",
    "World",
    "__version__",
    "box_pairs",
    "exact_meet",
    "judge",
    "main",
    "rounded_outward",
]

_Axes = Literal["principal", "model"]
_Claim = Literal[
    "sphere", "aabb", "or-dop", "hull", "mesh", "filter", "order", "restore", "margin", "parts", "periodic"
]
_Faces = Literal[6, 14, 18, 26]
_Finder = Literal["all-pairs", "grid", "sweep", "neighbours", "auto"]
_Motion = Literal["dynamic", "resting", "fixed"]
_Origin = Literal["file", "ball"]
_Periods = Sequence[float | None] | NDArray[np.float64]
_PeriodicPairs = tuple[NDArray[np.uint64], NDArray[np.int32]]
_Pose = Sequence[ArrayLike]
_Scale = float | Sequence[float] | NDArray[np.float64]
_Strategy = Literal[
    "none", "sphere", "or-dop", "s-dop-sequential", "s-dop-batch", "s-dop-object-of-interest", "aabb", "k-dop", "obb"
]

__version__: str

class SdopError(ValueError): ...
class CaseSkipped(Exception): ...

def box_pairs(
    boxes: ArrayLike,
    *,
    groups: ArrayLike | None = None,
    sort: bool = False,
    threads: int = 1,
    exact: bool = False,
    limit: int | None = None,
) -> NDArray[np.uint32]: ...
def rounded_outward(boxes: ArrayLike) -> NDArray[np.float32]: ...

@final
class BoxCuller:
    def __new__(cls, *, finder: _Finder = "auto", threads: int = 1) -> BoxCuller: ...
    def cull(
        self,
        boxes: ArrayLike,
        *,
        groups: ArrayLike | None = None,
        sort: bool = False,
        limit: int | None = None,
        exact: bool = False,
    ) -> NDArray[np.uint32]: ...
    @property
    def seconds(self) -> float: ...

class _AnyWorld:
    def remove(self, id: int) -> None: ...
    def set_motion(self, id: int, motion: _Motion) -> None: ...
    def set_groups(self, id: int, groups: Sequence[int]) -> None: ...
    def exclude(self, a: int, b: int) -> bool: ...
    def include(self, a: int, b: int) -> bool: ...
    def ids(self) -> NDArray[np.uint64]: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[int]: ...
    def __contains__(self, id: object, /) -> bool: ...
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, _memo: Any, /) -> Self: ...

class _LivingWorld(_AnyWorld):
    def cull(self, *, limit: int | None = None) -> NDArray[np.uint64]: ...
    def pairs(self) -> NDArray[np.uint64]: ...
    def events(self) -> Events: ...
    def snapshot(self) -> bytes: ...
    def restore(self, snapshot: bytes) -> None: ...

class _PeriodicWorld(_AnyWorld):
    @property
    def periods(self) -> list[float | None]: ...
    def set_periods(self, periods: _Periods) -> None: ...
    def cull(self, *, limit: int | None = None) -> _PeriodicPairs: ...
    def pairs(self) -> _PeriodicPairs: ...
    def events(self) -> PeriodicEvents: ...

class _MeshWorld(_AnyWorld):
    def insert(
        self,
        shape: int,
        rotation: ArrayLike,
        translation: ArrayLike,
        *,
        margin: float = 0.0,
        motion: _Motion = "dynamic",
        groups: Sequence[int] = ...,
        exact: bool = False,
    ) -> int: ...
    def set_pose(self, id: int, rotation: ArrayLike, translation: ArrayLike, *, exact: bool = False) -> None: ...
    def set_poses(
        self, ids: ArrayLike, rotations: ArrayLike, translations: ArrayLike, *, exact: bool = False
    ) -> None: ...
    def set_shape(self, id: int, shape: int) -> None: ...
    def set_margin(self, id: int, margin: float) -> None: ...
    def body(self, id: int) -> _Body: ...

@final
class BoxWorld(_LivingWorld):
    def __new__(cls, *, finder: _Finder = "auto", threads: int = 1) -> BoxWorld: ...
    def insert(
        self, bounds: ArrayLike, *, motion: _Motion = "dynamic", groups: Sequence[int] = ..., exact: bool = False
    ) -> int: ...
    def set_bounds(self, id: int, bounds: ArrayLike, *, exact: bool = False) -> None: ...
    def set_many(self, ids: ArrayLike, boxes: ArrayLike, *, exact: bool = False) -> None: ...

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
        scale: _Scale | None = None,
        radius: float | None = None,
        origin: _Origin = "file",
        k: _Faces = 18,
        axes: _Axes = "principal",
    ) -> Shape: ...
    def _prepare(self) -> None: ...
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
    def rounding(self) -> float: ...
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
        strategy: _Strategy = "s-dop-sequential",
        finder: _Finder = "auto",
        interest: Sequence[int] | None = None,
        groups: ArrayLike | None = None,
        threads: int = 1,
    ) -> Culler: ...
    def cull(
        self,
        rotations: ArrayLike,
        translations: ArrayLike,
        *,
        sort: bool = False,
        limit: int | None = None,
        exact: bool = False,
    ) -> NDArray[np.uint32]: ...
    @property
    def finder(self) -> _Finder: ...
    @property
    def seconds(self) -> float: ...
    def __len__(self) -> int: ...

class _Body(TypedDict):
    shape: int
    rotation: list[float]
    rounded: bool
    translation: list[float]
    margin: float
    motion: _Motion
    groups: tuple[int, int]

@final
class World(_MeshWorld, _LivingWorld):
    def __new__(
        cls,
        shapes: Sequence[Shape],
        *,
        strategy: _Strategy = "s-dop-sequential",
        finder: _Finder = "auto",
        threads: int = 1,
    ) -> World: ...
    def add_shape(self, shape: Shape) -> int: ...
    def remove_shape(self, shape: int) -> None: ...
    def replace_shape(self, number: int, shape: Shape) -> None: ...

@final
class Events:
    @property
    def begun(self) -> NDArray[np.uint64]: ...
    @property
    def persisting(self) -> NDArray[np.uint64]: ...
    @property
    def ended(self) -> NDArray[np.uint64]: ...

@final
class Compound:
    def __new__(
        cls,
        shapes: Sequence[Shape],
        part_shapes: ArrayLike,
        rotations: ArrayLike,
        translations: ArrayLike,
        *,
        name: str = "compound",
        exact: bool = False,
    ) -> Compound: ...
    @property
    def shape(self) -> Shape: ...
    def __len__(self) -> int: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, str]]: ...

@final
class PartCuller:
    def __new__(cls) -> PartCuller: ...
    def set_parts(self, shape: int, compound: Compound) -> None: ...
    def remove_parts(self, shape: int) -> None: ...
    def cull(self, world: World) -> tuple[NDArray[np.uint64], NDArray[np.uint32]]: ...
    def body_pairs(self) -> NDArray[np.uint64]: ...

@final
class PeriodicEvents:
    @property
    def begun(self) -> _PeriodicPairs: ...
    @property
    def persisting(self) -> _PeriodicPairs: ...
    @property
    def ended(self) -> _PeriodicPairs: ...

@final
class PeriodicBoxes(_PeriodicWorld):
    def __new__(cls, periods: _Periods, *, finder: _Finder = "auto", threads: int = 1) -> PeriodicBoxes: ...
    def insert(self, bounds: ArrayLike, *, motion: _Motion = "dynamic", groups: Sequence[int] = ...) -> int: ...
    def set_bounds(self, id: int, bounds: ArrayLike) -> None: ...
    def set_many(self, ids: ArrayLike, boxes: ArrayLike) -> None: ...

@final
class PeriodicWorld(_MeshWorld, _PeriodicWorld):
    def __new__(
        cls,
        shapes: Sequence[Shape],
        periods: _Periods,
        *,
        strategy: _Strategy = "s-dop-sequential",
        finder: _Finder = "auto",
        threads: int = 1,
    ) -> PeriodicWorld: ...

@final
class QueryIndex:
    def __new__(cls, *, threads: int = 1, limit: int | None = None) -> QueryIndex: ...
    def update(self, world: World | BoxWorld) -> None: ...
    def touching_boxes(self, boxes: ArrayLike) -> NDArray[np.uint64]: ...
    def touching_balls(self, centres: ArrayLike, radii: ArrayLike) -> NDArray[np.uint64]: ...
    def touching_shapes(
        self,
        shape: Shape,
        rotations: ArrayLike,
        translations: ArrayLike,
        *,
        margin: float = 0.0,
        exact: bool = False,
    ) -> NDArray[np.uint64]: ...
    def along(
        self, starts: ArrayLike, ends: ArrayLike | None = None, *, directions: ArrayLike | None = None
    ) -> tuple[NDArray[np.uint64], NDArray[np.float64]]: ...
    def first(
        self, starts: ArrayLike, ends: ArrayLike | None = None, *, directions: ArrayLike | None = None
    ) -> tuple[NDArray[np.uint64], NDArray[np.float64]]: ...
    def pairs_with(self, other: QueryIndex) -> NDArray[np.uint64]: ...
    def __len__(self) -> int: ...

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
    def claim(self) -> _Claim: ...
    @property
    def shapes(self) -> list[_CaseShape]: ...
    @property
    def body_shapes(self) -> NDArray[np.uint32]: ...
    @property
    def dynamic(self) -> NDArray[np.bool_]: ...

def exact_meet(shape_a: Shape, pose_a: _Pose, shape_b: Shape, pose_b: _Pose) -> bool: ...
def judge(
    make: Callable[[Scene], Any],
    claims: _Claim,
    cases: str,
    seed: int | None,
    extra_limit: float | None,
    fail_fast: bool,
) -> tuple[bool, str, str, tuple[str, NDArray[np.float32], list[tuple[str, bytes]]] | None]: ...
def main(arguments: list[str]) -> int: ...
