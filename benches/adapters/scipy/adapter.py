"""scipy: cKDTree.query_pairs, of the bodies' origins, by the distance within which balls may
meet."""

import numpy as np
from scipy.spatial import cKDTree
from wire import Culler, serve


class Adapter(Culler):
    def frame(self, rotations, translations):
        if len(translations) == 0:
            return self.pairs([])
        reach = self.reach()
        tree = cKDTree(np.asarray(translations, dtype=np.float64))
        return self.pairs(tree.query_pairs(reach, output_type="ndarray"))


if __name__ == "__main__":
    serve(Adapter, "scipy")
