"""newton: its broad phases of given boxes on the CPU, all pairs and sweep and prune."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))

import newton
import numpy as np
import warp
from wire import Culler, serve

warp.config.quiet = True
PHASES = {"all-pairs": newton.geometry.BroadPhaseAllPairs, "sweep": newton.geometry.BroadPhaseSAP}


class Adapter(Culler):
    def frame(self, boxes):
        n = len(boxes)
        if n < 2:
            return self.pairs([])
        world = np.zeros(n, dtype=np.int32)
        phase = PHASES[sys.argv[1]](world, device="cpu")
        array = lambda numbers, dtype: warp.array(numbers, dtype=dtype, device="cpu")
        pairs = warp.zeros(n * (n - 1) // 2, dtype=warp.vec2i, device="cpu")
        count = warp.zeros(1, dtype=warp.int32, device="cpu")
        phase.launch(
            array(boxes[:, :3].copy(), warp.vec3), array(boxes[:, 3:].copy(), warp.vec3), None,
            array(np.ones(n, dtype=np.int32), warp.int32), array(world, warp.int32), n, pairs, count, device="cpu",
        )
        return self.pairs(pairs.numpy()[: count.numpy()[0]])


if __name__ == "__main__":
    serve(Adapter, "newton")
