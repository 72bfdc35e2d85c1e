"""Two boxes of side 1 that touch: does MuJoCo make a contact of them?

    pip install mujoco && python touching_boxes.py

All numbers are exact in floating point: the boxes share a face, an edge or a corner, at several
places. The margin is 0. By the documentation a contact is active when the distance is below the
margin, so a distance of exactly 0 need not be one.
"""

import itertools

import mujoco
import numpy as np

SPEC = """
<mujoco><worldbody>
  <body><freejoint/><geom type="box" size=".5 .5 .5"/></body>
  <body><freejoint/><geom type="box" size=".5 .5 .5"/></body>
</worldbody></mujoco>
"""

model = mujoco.MjModel.from_xml_string(SPEC)
data = mujoco.MjData(model)
answers = {}
for step in itertools.product([-1, 0, 1], repeat=3):
    kind = ["", "face", "edge", "corner"][np.count_nonzero(step)]
    for place in itertools.product([0.0, 0.25, 10.5], repeat=3):
        data.qpos[:3], data.qpos[7:10] = place, np.add(place, step)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        answers.setdefault(kind, []).append(data.ncon > 0)

print("mujoco", mujoco.__version__)
for kind in ("face", "edge", "corner"):
    print(f"{kind}: in contact in {sum(answers[kind])} of {len(answers[kind])} places")
