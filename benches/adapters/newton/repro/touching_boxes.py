"""Two boxes that share a face: do newton's broad phases agree on them?

    pip install newton && python touching_boxes.py

Both are documented to find pairs "whose AABBs overlap". All numbers are exact in float32. A box of
side 1 is moved by 1 along each axis in turn, and by 1 along all of them.
"""

import itertools

import newton
import numpy as np
import warp

warp.config.quiet = True


def pairs(phase, boxes):
    n = len(boxes)
    world = np.zeros(n, dtype=np.int32)
    lower, upper = (warp.array(np.array(corner, np.float32), dtype=warp.vec3, device="cpu") for corner in zip(*boxes))
    found, count = warp.zeros(n * n, dtype=warp.vec2i, device="cpu"), warp.zeros(1, dtype=warp.int32, device="cpu")
    groups, worlds = (warp.array(numbers, dtype=warp.int32, device="cpu") for numbers in (world + 1, world))
    phase(world, device="cpu").launch(lower, upper, None, groups, worlds, n, found, count, device="cpu")
    return int(count.numpy()[0])


print("newton", newton.__version__)
for step in itertools.product([0, 1], repeat=3):
    boxes = [([0, 0, 0], [1, 1, 1]), (list(step), [side + 1 for side in step])]
    answers = {it.__name__: pairs(it, boxes) for it in (newton.geometry.BroadPhaseAllPairs, newton.geometry.BroadPhaseSAP)}
    print(f"moved by {step}: {answers}")
