"""What is known of each mutant, and tables of it."""

import collections
import hashlib
import json
import pathlib
import re
import sys
import threading

TOP = pathlib.Path(__file__).resolve().parents[2]


def say(text):
    print(text, file=sys.stderr, flush=True)


def digest(content):
    return hashlib.sha256(content).hexdigest()[:12]


def digests():
    """The digest of the code of each file of the library, as it is now."""
    found = {}
    for path in TOP.glob("src/**/*.rs"):
        # Additional tests and comments leave outcomes valid, so they are not part of the digest.
        code = path.read_bytes().split(b"\n#[cfg(test)]\nmod tests")[0]
        found[str(path.relative_to(TOP))] = digest(re.sub(rb"(?m)^\s*//.*$", b"", code))
    return found


class Outcomes:
    """The recorded outcome of each mutant whose file has not changed since."""

    def __init__(self, path):
        # Read once: if the tree is edited during a run, the digests are of the code that was tried.
        self.path, self.lock, self.digests = path, threading.Lock(), digests()
        lines = path.read_text().splitlines() if path.exists() else []
        self.known = {outcome["name"]: outcome for outcome in map(json.loads, lines)}

    def digest(self, mutant):
        return self.digests[mutant["file"]]

    def of(self, mutant):
        known = self.known.get(mutant["name"])
        return known if known and known["file"] == self.digest(mutant) else None

    def how(self, mutant, slowest=0):
        """How it ended; `asked in part`, if tests of up to `slowest` seconds may still catch it."""
        known = self.of(mutant)
        if known and known["how"] == "survived" and known.get("slowest", slowest) < slowest:
            return "asked in part"
        return known["how"] if known else "not tried"

    def add(self, mutant, how, by=None, **more):
        outcome = {"n": mutant["n"], "name": mutant["name"], "file": self.digest(mutant), "how": how, "by": by} | more
        with self.lock, self.path.open("a") as file:
            self.known[mutant["name"]] = outcome
            file.write(json.dumps(outcome) + "\n")


def place(name):
    """A mutant's name without line and column, which move with every change."""
    return re.sub(r":\d+:\d+:", ":", name, count=1)


def by_room(mutants, outcomes, slowest):
    """One row per room: its mutants, and how they ended."""
    rooms = collections.defaultdict(collections.Counter)
    for mutant in mutants:
        rooms[mutant["file"].split("/")[1]][outcomes.how(mutant, slowest)] += 1
    yield "room", "mutants", "dont_compile", "not_tried", "tried", "caught", "by_a_loop_without_end", "survive", "asked_in_part"
    for room, of in sorted(rooms.items()):
        caught, left = of["caught"] + of["endless"], (of["survived"], of["asked in part"])
        yield room, of.total(), of["doesn't compile"], of["not tried"], caught + sum(left), caught, of["endless"], *left


def by_reason(survivors, reasons):
    """One row per reason, for survivors that have one."""
    yield "why", "survivors"
    yield from collections.Counter(reasons[place(name)] for name in survivors if place(name) in reasons).most_common()


def judge(mutants, outcomes, reasons, slowest):
    """Prints survivors without a reason, and reasons without survivors. Returns the number of
    survivors without a reason."""
    survivors = [mutant["name"] for mutant in mutants if outcomes.how(mutant, slowest) == "survived"]
    unexplained = [name for name in survivors if place(name) not in reasons]
    for name in unexplained:
        say(f"unexplained{'' if outcomes.known[name]['asked'] else ', run by no test'}: {name}")
    for name in sorted(set(reasons) - set(map(place, survivors))):
        say(f"explained, but no survivor: {name}")
    return survivors, len(unexplained)
