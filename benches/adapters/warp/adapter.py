"""warp on the CPU: a Bvh of given boxes, refitted while their number stays, and one query for each
of them."""

import sys

import numpy as np
import warp
from wire import Culler, serve

warp.config.quiet = True


@warp.kernel
def find(
    tree: warp.uint64,
    lower: warp.array(dtype=warp.vec3),
    upper: warp.array(dtype=warp.vec3),
    pairs: warp.array(dtype=warp.vec2i),
    count: warp.array(dtype=int),
):
    body = warp.tid()
    query = warp.bvh_query_aabb(tree, lower[body], upper[body])
    other = int(0)
    while warp.bvh_query_next(query, other):
        if body < other:
            pairs[warp.atomic_add(count, 0, 1)] = warp.vec2i(body, other)


class Adapter(Culler):
    tree = None

    def frame(self, boxes):
        n = len(boxes)
        if n == 0:
            return self.pairs([])
        with warp.ScopedDevice("cpu"):
            lower, upper = (warp.array(corner.copy(), dtype=warp.vec3) for corner in (boxes[:, :3], boxes[:, 3:]))
            if self.tree is not None and len(self.tree.lowers) == n:
                warp.copy(self.tree.lowers, lower)
                warp.copy(self.tree.uppers, upper)
                self.tree.refit()
            else:
                self.tree = warp.Bvh(lower, upper, constructor=sys.argv[1])
            pairs, count = warp.zeros(n * n, dtype=warp.vec2i), warp.zeros(1, dtype=int)
            warp.launch(find, dim=n, inputs=[self.tree.id, lower, upper, pairs, count])
            return self.pairs(pairs.numpy()[: count.numpy()[0]])


if __name__ == "__main__":
    serve(Adapter, "warp-lang")
