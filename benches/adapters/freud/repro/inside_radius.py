"""Two points at r_max, or nearer: do freud's LinkCell and AABBQuery report them?

    pip install freud-analysis numpy && python inside_radius.py

The points differ along one axis alone. Their coordinates and their distance are exact in float32,
and r_max is 1. Both searches compute in float32; LinkCell also takes each difference as a fraction
of the box's side and back, so that what it misses is a share of the side.
"""

import freud
import numpy as np

SIDES = (8.0, 32.0, 64.0)
PLACES = np.arange(-12, 12) / 8
FINDERS = {"AABBQuery": freud.AABBQuery, "LinkCell": lambda box, points: freud.LinkCell(box, points, 1.0)}


def is_found(make, side, place, distance):
    points = np.array([[place, 0, 0], [place + distance, 0, 0]], dtype=np.float32)
    assert float(points[1, 0]) - float(points[0, 0]) == distance
    query = make(freud.box.Box.cube(side), points).query(points, {"mode": "ball", "r_max": 1.0, "exclude_ii": True})
    return len(query.toNeighborList()) > 0


print("freud", freud.__version__)
for power in (None, 22, 20, 18, 16):
    distance = 1.0 if power is None else 1.0 - 2.0**-power
    said = "1" if power is None else f"1 - 2^-{power}"
    for side in SIDES:
        counts = {name: sum(is_found(make, side, place, distance) for place in PLACES) for name, make in FINDERS.items()}
        print(f"{said} apart in a box of side {side:g}: reported in {counts} of {len(PLACES)} places")
