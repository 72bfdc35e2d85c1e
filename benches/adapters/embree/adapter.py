"""Embree, as embreex bundles it: rtcCollide of a scene of user geometry with itself, called by
ctypes."""

from ctypes import CDLL, CFUNCTYPE, POINTER, Structure, c_char_p, c_float, c_size_t, c_uint, c_void_p
from pathlib import Path

import embreex
import numpy as np
from wire import CaseSkipped, Culler, serve

USER_GEOMETRY = 120  # RTC_GEOMETRY_TYPE_USER
LARGEST = 1.844e18


class Bounds(Structure):
    _fields_ = [("lower", c_float * 4), ("upper", c_float * 4)]


class BoundsArguments(Structure):
    _fields_ = [("user", c_void_p), ("primitive", c_uint), ("time_step", c_uint), ("bounds", POINTER(Bounds))]


class Collision(Structure):
    _fields_ = [("geometry0", c_uint), ("primitive0", c_uint), ("geometry1", c_uint), ("primitive1", c_uint)]


BOUNDS = CFUNCTYPE(None, POINTER(BoundsArguments))
COLLIDE = CFUNCTYPE(None, c_void_p, POINTER(Collision), c_uint)


def library():
    (path,) = Path(embreex.__file__).parents[1].glob("embreex.libs/libembree4*")
    calls = CDLL(str(path))
    pointer, nothing = c_void_p, None
    for name, result, arguments in [
        ("rtcNewDevice", pointer, [c_char_p]), ("rtcNewScene", pointer, [pointer]), ("rtcNewGeometry", pointer, [pointer, c_uint]),
        ("rtcSetGeometryUserPrimitiveCount", nothing, [pointer, c_uint]), ("rtcSetGeometryBoundsFunction", nothing, [pointer, BOUNDS, pointer]),
        ("rtcCommitGeometry", nothing, [pointer]), ("rtcAttachGeometry", c_uint, [pointer, pointer]), ("rtcCommitScene", nothing, [pointer]),
        ("rtcCollide", nothing, [pointer, pointer, COLLIDE, pointer]), ("rtcReleaseGeometry", nothing, [pointer]),
        ("rtcReleaseScene", nothing, [pointer]), ("rtcGetDeviceError", c_uint, [pointer]),
    ]:
        call = getattr(calls, name)
        call.restype, call.argtypes = result, arguments
    return calls


EMBREE = library()
DEVICE = EMBREE.rtcNewDevice(b"threads=1")


class Adapter(Culler):
    """A scene for all frames, with one geometry, whose primitives are the bodies."""

    scene = None

    def frame(self, boxes):
        if len(boxes) == 0:
            return self.pairs([])  # it refuses to collide an empty scene
        if np.abs(boxes).max(initial=0.0) > LARGEST:
            raise CaseSkipped("it leaves out primitives beyond 1.844e18")
        if self.scene is None:
            self.begin()
        self.boxes = boxes
        EMBREE.rtcSetGeometryUserPrimitiveCount(self.geometry, len(boxes))
        EMBREE.rtcCommitGeometry(self.geometry)
        EMBREE.rtcCommitScene(self.scene)
        found = []

        def take(_, collisions, count):
            found.extend((collisions[n].primitive0, collisions[n].primitive1) for n in range(count))

        EMBREE.rtcCollide(self.scene, self.scene, COLLIDE(take), None)
        if error := EMBREE.rtcGetDeviceError(DEVICE):
            raise RuntimeError(f"Embree's error {error}")
        return self.pairs(found)

    def begin(self):
        self.scene = EMBREE.rtcNewScene(DEVICE)
        self.geometry = EMBREE.rtcNewGeometry(DEVICE, USER_GEOMETRY)
        self.bounds = BOUNDS(self.box)
        EMBREE.rtcSetGeometryBoundsFunction(self.geometry, self.bounds, None)
        EMBREE.rtcAttachGeometry(self.scene, self.geometry)

    def box(self, arguments):
        box, bounds = self.boxes[arguments[0].primitive].tolist(), arguments[0].bounds[0]
        bounds.lower[:3], bounds.upper[:3] = box[:3], box[3:]

    def __del__(self):
        if self.scene is not None:
            EMBREE.rtcReleaseGeometry(self.geometry)
            EMBREE.rtcReleaseScene(self.scene)


if __name__ == "__main__":
    serve(Adapter, "embreex")
