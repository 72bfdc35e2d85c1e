"""scipy: cKDTree.query_pairs, for balls of one radius about the bodies' origins."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))

import numpy as np
from scipy.spatial import cKDTree
from wire import CaseSkipped, Culler, serve


class Adapter(Culler):
    def frame(self, rotations, translations):
        balls = [self.shapes[number]["ball"] for number in self.body_shapes]
        if any(np.any(centre) for centre, _ in balls):
            raise CaseSkipped("it takes points, and a ball's centre is not where its body is")
        if len({radius for _, radius in balls}) > 1:
            raise CaseSkipped("it takes one distance for all pairs, and the balls have several radii")
        if not balls:
            return self.pairs([])
        tree = cKDTree(np.asarray(translations, dtype=np.float64))
        return self.pairs(tree.query_pairs(2.0 * float(np.float32(balls[0][1])), output_type="ndarray"))


if __name__ == "__main__":
    serve(Adapter)
