#!/usr/bin/env python3
"""A culler of given boxes, judged with

    sdop judge 'python3 examples/judge/boxes.py' --claims aabb

With --full-buffer it keeps at most 16 pairs for each body, and drops the rest.
"""
import json
import sys

FULL_BUFFER = "--full-buffer" in sys.argv


def meet(a, b):
    return all(a[k] <= b[k + 3] and b[k] <= a[k + 3] for k in range(3))


def cull(boxes, bodies):
    pairs = []
    for j, b in enumerate(boxes):
        for i, a in enumerate(boxes[:j]):
            if meet(a, b) and not (bodies[i]["static"] and bodies[j]["static"]):
                pairs.append([i, j])
    return pairs[: 16 * len(boxes)] if FULL_BUFFER else pairs


bodies = json.loads(sys.stdin.readline())["bodies"]
for line in sys.stdin:
    frame = json.loads(line)
    bodies = frame.get("bodies", bodies)  # the set may change
    print(json.dumps({"frame": frame["frame"], "pairs": cull(frame["boxes"], bodies)}))
