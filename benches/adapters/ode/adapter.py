"""ODE as Debian has it (libode8), called by ctypes: dSpaceCollide, with a box geom per body in one
space for all frames."""

import subprocess
import sys
from ctypes import CDLL, CFUNCTYPE, c_char_p, c_double, c_float, c_int, c_uint, c_void_p

import numpy as np
from wire import ObjectCuller, centres_and_halves, serve

NEAR = CFUNCTYPE(None, c_void_p, c_void_p, c_void_p)
SPACES = {"hash": "dHashSpaceCreate", "simple": "dSimpleSpaceCreate", "sweep": "dSweepAndPruneSpaceCreate"}
XYZ = 0x024  # dSAP_AXES_XYZ


def library():
    calls = CDLL("libode.so.8")
    calls.dCheckConfiguration.argtypes = [c_char_p]
    real = c_double if calls.dCheckConfiguration(b"ODE_double_precision") else c_float
    for name, result, arguments in [
        ("dInitODE2", c_int, [c_uint]), ("dHashSpaceCreate", c_void_p, [c_void_p]), ("dSimpleSpaceCreate", c_void_p, [c_void_p]),
        ("dSweepAndPruneSpaceCreate", c_void_p, [c_void_p, c_int]), ("dSpaceDestroy", None, [c_void_p]),
        ("dCreateBox", c_void_p, [c_void_p, real, real, real]), ("dGeomBoxSetLengths", None, [c_void_p, real, real, real]),
        ("dGeomSetPosition", None, [c_void_p, real, real, real]), ("dGeomDestroy", None, [c_void_p]),
        ("dSpaceCollide", None, [c_void_p, c_void_p, NEAR]),
    ]:
        call = getattr(calls, name)
        call.restype, call.argtypes = result, arguments
    calls.dInitODE2(0)
    return calls, np.float64 if real is c_double else np.float32


class Adapter(ObjectCuller):
    """An object is a geom."""

    def __init__(self, scene):
        super().__init__(scene)
        make = getattr(ODE, SPACES[sys.argv[1]])
        self.space = make(None, XYZ) if sys.argv[1] == "sweep" else make(None)

    def placed(self, it, box):
        (centre,), (half,) = centres_and_halves(box[None], REAL)
        if it is None:
            it = ODE.dCreateBox(self.space, 1.0, 1.0, 1.0)
        ODE.dGeomBoxSetLengths(it, *(2.0 * half).tolist())
        ODE.dGeomSetPosition(it, *centre.tolist())
        return it

    def remove(self, it):
        ODE.dGeomDestroy(it)

    def found(self, boxes):
        numbers, found = {it: number for number, it in enumerate(self.objects)}, []
        ODE.dSpaceCollide(self.space, None, NEAR(lambda _, a, b: found.append((numbers[a], numbers[b]))))
        return found

    def __del__(self):
        ODE.dSpaceDestroy(self.space)


if __name__ == "__main__":
    if "--version" in sys.argv:
        print(subprocess.check_output(["dpkg-query", "--show", "--showformat", "${Version}", "libode8"], text=True))
    else:
        ODE, REAL = library()
        serve(Adapter, "libode8")
