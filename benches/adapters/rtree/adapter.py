"""Rtree: one index for each frame, loaded in bulk, and one query for each box."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))

from rtree import index
from wire import Culler, serve


class Adapter(Culler):
    def frame(self, boxes):
        if len(boxes) == 0:
            return self.pairs([])
        wide = boxes.astype(float).tolist()
        properties = index.Property(dimension=3)
        tree = index.Index(((number, box, None) for number, box in enumerate(wide)), interleaved=True, properties=properties)
        return self.pairs([(i, j) for i, box in enumerate(wide) for j in tree.intersection(box)])


if __name__ == "__main__":
    serve(Adapter, "Rtree")
