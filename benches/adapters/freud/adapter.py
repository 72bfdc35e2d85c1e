"""freud: AABBQuery and LinkCell by a radius, in a box large enough that nothing wraps around; in
the cell of the periods for the claim periodic."""

import sys

import freud
import numpy as np
from wire import CaseSkipped, Culler, in_cell, serve

FINDERS = {"aabb": lambda box, points, _: freud.AABBQuery(box, points), "cells": freud.LinkCell}
MOST_CELLS = 200


class Adapter(Culler):
    def frame(self, *given):
        if len(given[0]) == 0:
            return self.pairs([])
        periods = self.given.get("periods")
        if periods:
            points, sides, reach = in_cell(given[0], periods)
        else:
            points, reach = given[1], self.reach()
            sides = np.full(3, 2.0 * float(np.abs(points).max()) + 3.0 * reach)
        if np.float32(reach) * np.float32(reach) == 0.0:
            raise CaseSkipped("the square of its r_max is zero in float32, in which it computes")
        points = np.asarray(points, dtype=np.float32)
        if sys.argv[1] == "cells" and sides.max() > MOST_CELLS * reach:
            raise CaseSkipped(f"the box that keeps points from wrapping around has more than {MOST_CELLS} cells along a side")
        # It refuses pairs in a box that is not periodic.
        query = FINDERS[sys.argv[1]](freud.box.Box(*sides), points, reach)
        near = query.query(points, {"mode": "ball", "r_max": reach, "exclude_ii": True}).toNeighborList()
        return self.pairs(near[:].astype(np.int64))


if __name__ == "__main__":
    serve(Adapter, "freud-analysis")
