"""scipy: cKDTree.query_pairs, of the bodies' origins, by the distance within which balls may meet;
of boxes' centres in a periodic cell for the claim periodic."""

import numpy as np
from scipy.spatial import cKDTree
from wire import Culler, in_cell, serve


class Adapter(Culler):
    def frame(self, *given):
        if len(given[0]) == 0:
            return self.pairs([])
        periods = self.given.get("periods")
        if periods:
            points, _, reach = in_cell(given[0], periods)
            tree = cKDTree(points, boxsize=[period or 0.0 for period in periods])
        else:
            tree, reach = cKDTree(np.asarray(given[1], dtype=np.float64)), self.reach()
        return self.pairs(tree.query_pairs(reach, output_type="ndarray"))


if __name__ == "__main__":
    serve(Adapter, "scipy")
