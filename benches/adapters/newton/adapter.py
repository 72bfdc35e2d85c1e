"""newton: its broad phases of given boxes on the CPU, all pairs and sweep and prune."""

import sys

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
        gaps, excluded = self.given.get("margins"), self.excluded()
        pairs = warp.zeros(n * (n - 1) // 2, dtype=warp.vec2i, device="cpu")
        count = warp.zeros(1, dtype=warp.int32, device="cpu")
        phase.launch(
            array(boxes[:, :3].copy(), warp.vec3), array(boxes[:, 3:].copy(), warp.vec3), gaps and array(gaps, warp.float32),
            array(np.ones(n, dtype=np.int32), warp.int32), array(world, warp.int32), n, pairs, count, device="cpu",
            filter_pairs=array(excluded, warp.vec2i) if excluded else None,
        )
        return self.pairs(pairs.numpy()[: count.numpy()[0]])

    def excluded(self):
        """Pairs that must not be reported, sorted. Its groups are numbers, not masks: what masks
        part is given as pairs too."""
        groups, pairs = self.given.get("groups", []), {tuple(pair) for pair in self.given.get("excluded", [])}
        for j, (in_b, meets_b) in enumerate(groups):
            pairs.update((i, j) for i, (in_a, meets_a) in enumerate(groups[:j]) if not (in_a & meets_b and in_b & meets_a))
        return sorted(pairs)


if __name__ == "__main__":
    serve(Adapter, "newton")
