"""ipctk: its broad phases. A box is an edge between two corners: the box about that edge is the one
given."""

import sys

import ipctk
import numpy as np
from wire import CaseSkipped, Culler, serve

PHASES = {"lbvh": ipctk.LBVH, "grid": ipctk.HashGrid, "sweep": ipctk.SweepAndPrune}
MOST_CELLS = 1_000_000


class Adapter(Culler):
    def frame(self, boxes):
        n = len(boxes)
        if n == 0:
            return self.pairs([])
        if sys.argv[1] == "grid":
            check_cells(boxes.astype(np.float64))
        vertices = np.asfortranarray(boxes.astype(np.float64).reshape(-1, 3))
        edges = np.asfortranarray(np.arange(2 * n, dtype=np.int32).reshape(-1, 2))
        phase = PHASES[sys.argv[1]]()
        if "groups" in self.given:
            ipctk.set_num_threads(1)  # others would wait for this one, which has Python's lock
            phase.can_vertices_collide = ipctk.CollisionFilter(self.filter())
        phase.build(vertices, edges, np.asfortranarray(np.empty((0, 3), np.int32)), self.inflation())
        return self.pairs([(it.edge0_id, it.edge1_id) for it in phase.detect_edge_edge_candidates()])

    def filter(self):
        """Whether two vertices may collide; those of body i are 2 i and 2 i + 1."""
        groups, excluded = self.given["groups"], {tuple(pair) for pair in self.given["excluded"]}

        def may_collide(one, other):
            i, j = sorted((one // 2, other // 2))
            (in_a, meets_a), (in_b, meets_b) = groups[i], groups[j]
            return (i, j) not in excluded and bool(in_a & meets_b and in_b & meets_a)

        return may_collide

    def inflation(self):
        margins = set(self.given.get("margins", [0.0]))
        if len(margins) > 1:
            raise CaseSkipped("its inflation is one number for all boxes")
        return margins.pop()


def check_cells(boxes):
    """HashGrid's cells suit the median edge, and an edge is listed in every cell of its box."""
    sides = boxes[:, 3:] - boxes[:, :3]
    usual = float(np.median(np.linalg.norm(sides, axis=1)))
    cells = np.prod(sides / usual + 2.0, axis=1).sum() if usual > 0.0 else np.inf
    if cells > MOST_CELLS:
        raise CaseSkipped(f"the boxes are in more than {MOST_CELLS:,} cells of its grid, which suit the median edge")


if __name__ == "__main__":
    serve(Adapter, "ipctk")
