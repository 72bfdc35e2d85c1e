"""vesin: NeighborList without periodic directions, of the bodies' origins, by the distance within
which balls may meet."""

import numpy as np
import vesin
from wire import CaseSkipped, Culler, serve


class Adapter(Culler):
    def frame(self, rotations, translations):
        if len(translations) == 0:
            return self.pairs([])
        reach = self.reach()
        near = vesin.NeighborList(cutoff=reach, full_list=False)
        try:
            i, j = near.compute(np.asarray(translations, np.float64), box=np.zeros((3, 3)), periodic=False, quantities="ij")
        except RuntimeError as refusal:
            raise CaseSkipped(f"it says: {refusal}") from refusal
        return self.pairs(np.stack([i, j], axis=1).astype(np.int64))


if __name__ == "__main__":
    serve(Adapter, "vesin")
