"""vesin: NeighborList without periodic directions, of the bodies' origins, by the distance within
which balls may meet; for the claim periodic with the periods, of boxes' centres in the cell."""

import numpy as np
import vesin
from wire import CaseSkipped, Culler, in_cell, serve


class Adapter(Culler):
    def frame(self, *given):
        if len(given[0]) == 0:
            return self.pairs([])
        periods = self.given.get("periods")
        if periods:
            points, sides, reach = in_cell(given[0], periods)
            cell = {"box": np.diag(sides), "periodic": [period is not None for period in periods]}
        else:
            points, reach = np.asarray(given[1], np.float64), self.reach()
            cell = {"box": np.zeros((3, 3)), "periodic": False}
        near = vesin.NeighborList(cutoff=reach, full_list=False)
        try:
            i, j = near.compute(points, **cell, quantities="ij")
        except RuntimeError as refusal:
            raise CaseSkipped(f"it says: {refusal}") from refusal
        return self.pairs(np.stack([i, j], axis=1).astype(np.int64))


if __name__ == "__main__":
    serve(Adapter, "vesin")
