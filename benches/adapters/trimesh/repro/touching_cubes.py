"""Two cubes of side 1 that touch: does trimesh's CollisionManager say that they collide?

    pip install trimesh python-fcl && python touching_cubes.py

All numbers are exact in floating point: the cubes share a face, an edge or a corner, at several
places. The documentation does not say whether touching is colliding; this prints what 5.2.0
answers.
"""

import itertools

import numpy as np
import trimesh

cube = trimesh.creation.box(extents=[1, 1, 1])


def at(place):
    return trimesh.transformations.translation_matrix(place)


answers = {}
for step in itertools.product([-1, 0, 1], repeat=3):
    kind = ["", "face", "edge", "corner"][np.count_nonzero(step)]
    for place in itertools.product([0.0, 0.25, 10.5], repeat=3):
        manager = trimesh.collision.CollisionManager()
        manager.add_object("first", cube, at(place))
        manager.add_object("second", cube, at(np.add(place, step)))
        answers.setdefault(kind, []).append(manager.in_collision_internal())

print("trimesh", trimesh.__version__)
for kind in ("face", "edge", "corner"):
    print(f"{kind}: collides in {sum(answers[kind])} of {len(answers[kind])} places")
