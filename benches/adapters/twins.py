"""Twins of reported bugs: cullers of boxes, right but for the one thing that a report is about.

    sdop judge 'python3 benches/adapters/twins.py full-buffer' --claims aabb --keep --no-fresh --case 'buffer/growth/*'

Without a name, all are listed with the case that has to catch each. `right` is the same culler without a bug.
"""

import json
import sys

TWINS = {
    "right": (None, "the same culler without a bug"),
    "full-buffer": ("buffer/growth", "pairs beyond twice those of the first frame are dropped"),
    "fixed-room": ("random/sizes", "pairs beyond sixteen for each body are dropped"),
    "wasted-slots": ("buffer/hub", "a body has sixteen slots, and pairs that are only near take some of them"),
    "few-nodes": ("buffer/growth", "bodies beyond the number of nodes are in no tree"),
    "dropped-early": ("random/moving", "a pair found by enlarged bounds is dropped where tight ones are apart, and looked for no more"),
    "stale-frame": ("churn/teleport", "a body that jumps far keeps the bounds that it had"),
    "stale-bounds": ("churn/swap", "bounds are updated where a body's number is even"),
    "late-body": ("churn/insert-remove", "bodies that come after the first frame are not asked"),
    "old-list": ("churn/move", "candidates are those of the first frame"),
    "strict": ("box/grid", "< in place of <="),
}
SLOTS = 16
NODES = 32


def meet(a, b):
    return all(a[k] <= b[k + 3] and b[k] <= a[k + 3] for k in range(3))


def grown(box):
    by = 0.25 * max(box[k + 3] - box[k] for k in range(3))
    return [x - by for x in box[:3]] + [x + by for x in box[3:]]


def inside(box, outer):
    return outer is not None and meet(box, outer) and all(outer[k] <= box[k] and box[k + 3] <= outer[k + 3] for k in range(3))


class Twin:
    def __init__(self, bug):
        self.bug, self.bounds, self.fat, self.pairs, self.first, self.room = bug, [], [], set(), None, 0

    def frame(self, boxes, was):
        """The pairs of a frame; `was` has each body's former number, or none."""
        former = [self.bounds[it] if it is not None and it < len(self.bounds) else None for it in was]
        self.bounds = [self.kept(number, *it) for number, it in enumerate(zip(boxes, former))]
        found = [(i, j) for j in range(len(boxes)) for i in range(j) if self.finds(i, j, was)]
        if self.bug == "dropped-early":
            found = self.by_enlarged_bounds(was)
        if self.first is None:
            self.first, self.room = set(found), 2 * len(found)
        return self.held(found)

    def kept(self, number, box, former):
        jumps = former is not None and max(abs(a - b) for a, b in zip(box, former)) > 1e3
        if self.bug == "stale-frame" and jumps or self.bug == "stale-bounds" and former is not None and number % 2:
            return former
        return box

    def finds(self, i, j, was):
        a, b = self.bounds[i], self.bounds[j]
        if self.bug == "late-body" and None in (was[i], was[j]) and self.first is not None:
            return False
        if self.bug == "old-list" and self.first is not None and (i, j) not in self.first:
            return False
        if self.bug == "few-nodes" and max(i, j) >= NODES:
            return False
        if self.bug == "strict":
            return all(a[k] < b[k + 3] and b[k] < a[k + 3] for k in range(3))
        return meet(grown(a), grown(b)) if self.bug == "wasted-slots" else meet(a, b)

    def by_enlarged_bounds(self, was):
        fat = [self.fat[it] if it is not None and it < len(self.fat) else None for it in was]
        now = {it: number for number, it in enumerate(was) if it is not None}
        moved = [number for number, box in enumerate(self.bounds) if not inside(box, fat[number])]
        self.fat = [grown(box) if number in moved else fat[number] for number, box in enumerate(self.bounds)]
        pairs = {tuple(sorted((now[i], now[j]))) for i, j in self.pairs if i in now and j in now}
        for i in moved:
            pairs |= {tuple(sorted((i, j))) for j in range(len(self.fat)) if i != j and meet(self.fat[i], self.fat[j])}
        self.pairs = {(i, j) for i, j in pairs if meet(self.bounds[i], self.bounds[j])}
        return sorted(self.pairs)

    def held(self, found):
        if self.bug == "full-buffer":
            return found[: self.room]
        if self.bug == "fixed-room":
            return found[: SLOTS * len(self.bounds)]
        if self.bug != "wasted-slots":
            return found
        kept, taken = [], [0] * len(self.bounds)
        for i, j in found:
            if max(taken[i], taken[j]) < SLOTS:
                taken[i], taken[j] = taken[i] + 1, taken[j] + 1
                kept.append((i, j))
        return [(i, j) for i, j in kept if meet(self.bounds[i], self.bounds[j])]


if len(sys.argv) < 2:
    print(*(f"{name}\t{case}\t{bug}" for name, (case, bug) in TWINS.items() if case), sep="\n")
    sys.exit()
for text in sys.stdin:
    line = json.loads(text)
    if "format" in line:
        twin, bodies, was = Twin(sys.argv[1]), line["bodies"], [None] * len(line["bodies"])
        continue
    if "bodies" in line:
        bodies = line["bodies"]
        was = [body.get("was") for body in bodies]
    fixed = [body["static"] for body in bodies]
    pairs = [[i, j] for i, j in twin.frame(line["boxes"], was) if not (fixed[i] and fixed[j])]
    was = list(range(len(bodies)))
    print(json.dumps({"frame": line["frame"], "pairs": pairs}), flush=True)
