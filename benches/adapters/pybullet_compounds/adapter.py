"""Bullet by pybullet, with a compound of convex hulls per body in one world for all frames:
getContactPoints."""

import sys
import tempfile
from pathlib import Path

import numpy as np
import pybullet
from wire import ObjectCuller, serve

if "--version" not in sys.argv:
    pybullet.connect(pybullet.DIRECT)
    FOLDER = tempfile.TemporaryDirectory()  # removed at the end


class Adapter(ObjectCuller):
    """An object is a body's id, and the parts and the motion that it was made with."""

    takes_parts = True

    def __init__(self, scene):
        super().__init__(scene)
        pybullet.resetSimulation()
        self.files = [mesh_file(shape) for shape in self.shapes]

    def frame(self, rotations, translations):
        for number, (turn, place) in enumerate(zip(rotations, translations, strict=True)):
            alone = {"shape": int(self.body_shapes[number]), "pose": [0, 0, 0, 1, 0, 0, 0]}
            made = (self.given["parts"][number] or [alone], bool(self.dynamic[number]))
            self.objects[number] = self.posed(self.objects[number], made, (place.tolist(), unit(turn)))
        numbers = {body: number for number, (body, _) in enumerate(self.objects)}
        pybullet.performCollisionDetection()
        return self.pairs([(numbers[it[1]], numbers[it[2]]) for it in pybullet.getContactPoints() or []])

    def posed(self, it, made, pose):
        if it is not None and it[1] == made:
            pybullet.resetBasePositionAndOrientation(it[0], *pose)
            return it
        if it is not None:
            self.remove(it)
        parts, dynamic = made
        shape = pybullet.createCollisionShapeArray(
            shapeTypes=[pybullet.GEOM_MESH] * len(parts),
            fileNames=[self.files[part["shape"]] for part in parts],
            collisionFramePositions=[part["pose"][4:] for part in parts],
            collisionFrameOrientations=[unit(part["pose"][:4]) for part in parts],
        )
        return pybullet.createMultiBody(int(dynamic), shape, -1, *pose), made

    def remove(self, it):
        pybullet.removeBody(it[0])


def mesh_file(shape):
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in shape["vertices"])
    text += "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in shape["triangles"])
    path = Path(FOLDER.name) / f"{abs(hash(text))}.obj"
    path.write_text(text)
    return str(path)


def unit(turn):
    turn = np.asarray(turn, np.float64)
    return (turn / np.linalg.norm(turn)).tolist()


if __name__ == "__main__":
    serve(Adapter, "pybullet")
