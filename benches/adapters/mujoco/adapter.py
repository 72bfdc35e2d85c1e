"""MuJoCo: contacts of box geoms on the world's axes, a free body each, with the default margin of
zero."""

import mujoco
import numpy as np
from wire import CaseSkipped, Culler, centres_and_halves, serve


class Adapter(Culler):
    def frame(self, boxes):
        centres, halves = centres_and_halves(boxes)
        if len(boxes) == 0:
            return self.pairs([])
        if (halves < mujoco.mjMINVAL).any() or np.abs(boxes).max() > mujoco.mjMAXVAL:
            raise CaseSkipped("it refuses sizes below mjMINVAL and coordinates above mjMAXVAL")
        spec = mujoco.MjSpec()
        for centre, half in zip(centres, halves, strict=True):
            body = spec.worldbody.add_body(pos=centre, mass=1.0, inertia=np.ones(3), explicitinertial=True)
            body.add_freejoint()
            body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=half)
        spec.memory = 1 << 30
        model = spec.compile()
        data = mujoco.MjData(model)
        data.qpos.reshape(-1, 7)[:, :3] = centres
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        if data.warning[mujoco.mjtWarning.mjWARN_CONTACTFULL].number:
            raise CaseSkipped("it warns that a gibibyte has no room for all contacts")
        return self.pairs(data.contact.geom.copy())


if __name__ == "__main__":
    serve(Adapter, "mujoco")
