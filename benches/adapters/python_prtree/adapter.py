"""python-prtree: one tree for each frame, and one query for all boxes."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))

import numpy as np
from python_prtree import PRTree3D
from wire import Culler, serve


class Adapter(Culler):
    def frame(self, boxes):
        if len(boxes) == 0:
            return self.pairs([])
        near = PRTree3D(np.arange(len(boxes)), boxes).batch_query(boxes)
        return self.pairs([(i, j) for i, found in enumerate(near) for j in found])


if __name__ == "__main__":
    serve(Adapter, "python-prtree")
