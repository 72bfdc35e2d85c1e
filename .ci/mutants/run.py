#!/usr/bin/env python3
"""Wakes every mutant that `cargo mutants` lists, one at a time, and asks the tests whether they
notice.

One build per mutant would take a day. Therefore all mutants that can sleep are compiled together
(plant.py), in a copy of the tree, and a process wakes one by its number. Of the others, `--alone`
are built one by one. A mutant is caught when a test fails, or takes more than four seconds longer
than five times its usual time. Two tiers run in the copy, scalar and AVX-512: a lane of every other
tier is tested by itself, as a crate of the room `simd`. Constants (constants.py) sleep in a third
copy, with all tiers.

    .ci/mutants/run.py [--only REGEX] [--alone N] [--slowest SECONDS] [--tests REGEX] [--again]
                       [--as-built] [--threads N]
                       [--outcomes FILE] [--print TABLE]

Each test runs once with all asleep. This measures its time and lists the mutants whose places it
reaches; it can't notice others.

Continues where FILE (target/mutants/outcomes.jsonl) ends: survivors are tried with further tests,
up to `--slowest`, so that quick tests can run first. Each line is an outcome: number, name, digest
of its file, result (`caught`, `endless`, `survived`, `doesn't compile`), and the test that caught
it, or the tests that were tried. If a file's code changes, its mutants are tried again.
"""

import argparse
import collections
import concurrent.futures
import contextlib
import csv
import functools
import json
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys

import plant
from outcomes import TOP, Outcomes, by_reason, by_room, judge, place, say
from trees import ENVIRONMENT, WORK, Built, build, cargo, lanes_tree, main_tree, plant_all, settle, tracked, whole_tree, write_tree

PACKAGES = ["-p", "sdop", "-p", "sdop-judge", "-p", "sdop-bench"]
SUITES = ["golden_pairs", "never_misses", "worlds", "bounds", "shapes", "studies", "scenes", "finder_costs"]
# Seconds: tests below go together.
QUICK = 0.1


def limited(seconds):
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def threads(process):
    """The state and CPU time of each thread of a process."""
    found = []
    for file in pathlib.Path(f"/proc/{process.pid}/task").glob("*/stat"):
        with contextlib.suppress(FileNotFoundError):  # it has just ended
            state, *fields = file.read_text().rsplit(")", 1)[1].split()
            found.append((state, int(fields[10]) + int(fields[11])))
    return found


def heard(process, patience=60):
    """What a process wrote. If all of its threads sleep between two checks, it is ended and nothing
    is returned. A thread that waits for a processor does not sleep."""
    before = None
    while True:
        try:
            return process.communicate(timeout=patience)
        except subprocess.TimeoutExpired:
            now = threads(process)
            if now == before and all(state == "S" for state, _ in now):
                process.kill()
                process.communicate()
                return None
            before = now


def ask(tree, name, command, seconds, **environment):
    """Runs tests. Returns how they ended, by which test or signal, and their stderr."""
    environment = ENVIRONMENT | {"CARGO_MANIFEST_DIR": str(tree)} | environment
    done = subprocess.Popen([*command, "-q"], cwd=tree, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, errors="replace", preexec_fn=functools.partial(limited, seconds))
    told = heard(done)
    if told is None:
        return "endless", name, ""
    stdout, stderr = told
    if done.returncode == 0:
        return "survived", None, stderr
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return "endless", name, ""
    failed = sorted(set(re.findall(r"^    (\S+)$", stdout.split("\nfailures:")[-1], re.M)))
    return "caught", ", ".join(failed[:3]) or f"{name}, by signal {-done.returncode}", ""


class Test:
    """A test, or the library's own tests together. `cost` is its CPU time in seconds with all
    mutants asleep, `places` are those that it reaches."""

    def __init__(self, built, suite, test=None):
        self.name = f"{suite}::{test}" if test else suite
        self.built, self.suite = built, suite
        self.arguments = ["--exact", test] if test else []
        self.cost, places = built.tests.get(self.name, (0, None))
        self.places = set(places or ())

    def measure(self, slowest):
        """Runs it with all asleep, unless it is known to be slower than that."""
        if self.places or self.cost > 1.2 * slowest:
            return
        before = os.times()
        command = [self.built.binaries[self.suite], *self.arguments]
        how, by, told = ask(self.built.tree, self.name, command, int(slowest) + 2, TRACED="1")
        after = os.times()
        assert how != "caught", f"{self.name} fails when nothing is awake: {by}"
        self.cost = after.children_user + after.children_system - before.children_user - before.children_system
        self.places = {int(n) for line in told.splitlines() if line.startswith(plant.SIGN) for n in line[len(plant.SIGN) :].split()}
        self.built.tests[self.name] = self.cost, sorted(self.places)


def measured(built, options):
    """The tests that take up to `--slowest` seconds of CPU."""
    found = []
    for suite, executable in built.binaries.items():
        names = [None]
        if suite != "lib":
            listed = subprocess.run([executable, "--list"], cwd=built.tree, stdout=subprocess.PIPE, text=True, check=True).stdout
            names = [name for name in re.findall(r"^(\S+): test$", listed, re.M) if not name.startswith("sweep::")]
        found += [Test(built, suite, name) for name in names]
    found = [test for test in found if re.search(options.tests, test.name)]
    for test in found:
        test.measure(options.slowest)
    for test in sorted(found, key=lambda test: test.cost):
        say(f"{test.cost:7.2f} s, {len(test.places)} places{'' if test.cost <= options.slowest else ', left out'}: {test.name}")
    built.keep()
    return [test for test in found if test.cost <= options.slowest]


class Together:
    """Tests of a suite that one process runs: those that are over sooner than it has started."""

    def __init__(self, tests):
        self.tests, self.cost, self.tree = tests, sum(test.cost for test in tests), tests[0].built.tree
        self.name = tests[0].name if len(tests) == 1 else f"{tests[0].suite}, quick ones"
        names = [name for test in tests for name in test.arguments[1:]]
        self.command = [tests[0].built.binaries[tests[0].suite], tests[0].arguments[0], *names]

    def ask(self, number):
        return ask(self.tree, self.name, self.command, int(5 * self.cost) + 4, MUTANT=str(number))[:2]


def together(tests, seen):
    """These tests by process, with the quick ones of a suite in one process. Tests that caught the
    most mutants per second come first."""
    quick = collections.defaultdict(list)
    for test in tests:
        quick[test.suite if test.cost < QUICK else test.name].append(test)
    start = 0.05  # of a process, in seconds
    return sorted(map(Together, quick.values()),
                  key=lambda some: (some.cost + start) / (0.2 + seen[some.name] + sum(seen[test.name] for test in some.tests)))


def catches(mutants, outcomes, tests):
    """How often each of these tests has caught a mutant of each file."""
    names = collections.defaultdict(list)
    for test in tests:
        names[test.name.split("::", 1)[-1]].append(test.name)
        names[test.name].append(test.name)
    caught = collections.defaultdict(collections.Counter)
    for mutant in mutants:
        by = (outcomes.of(mutant) or {}).get("by") or ""
        # A failure among the library's own tests has no other name.
        caught[mutant["file"]].update(name for part in by.split(", ") for name in names.get(part, ["lib"]))
    return caught


def wake(mutants, built, tests, outcomes, options):
    """Tries each mutant with the tests that reach it and have not been tried."""
    caught = catches(mutants, outcomes, tests)

    def one(mutant):
        known = outcomes.of(mutant) or {}
        asked = known.get("asked", [])
        able = [test for test in tests if built.asleep[mutant["n"]] in test.places and (options.again or test.name not in asked)]
        if not able and known.get("slowest", -1) >= options.slowest:
            return None
        for some in together(able, caught[mutant["file"]]):
            how, by = some.ask(mutant["n"])
            if how != "survived":
                caught[mutant["file"]][some.name] += 1
                return outcomes.add(mutant, how, by)
            asked = sorted({*asked, *(test.name for test in some.tests)})
        slowest = known.get("slowest", 0) if options.tests else max(options.slowest, known.get("slowest", 0))
        return outcomes.add(mutant, "survived", asked=asked, slowest=slowest)

    with concurrent.futures.ThreadPoolExecutor(options.threads) as pool:
        for _ in pool.map(one, mutants):
            pass


def one_by_one(mutants, outcomes):
    """Builds each of these mutants by itself, and asks the suites that catch most."""
    tree, files = WORK / "alone", tracked()
    for mutant in mutants:
        name = mutant["file"]
        write_tree(tree, files | {name: plant.applied(files[name], mutant)})
        if cargo(tree, "check", "--lib", *PACKAGES)[1].returncode:
            outcomes.add(mutant, "doesn't compile", "alone")
        else:
            ask_alone(tree, mutant, outcomes)


def ask_alone(tree, mutant, outcomes):
    asked = []
    for suites in (["--lib"], ["--test", "golden_pairs"], [part for suite in SUITES[1:] for part in ("--test", suite)]):
        binaries = build(tree, *PACKAGES, *suites)
        if not binaries:
            return outcomes.add(mutant, "doesn't compile", "alone")
        for suite, executable in binaries.items():
            how, by, _ = ask(tree, suite, [executable], 120)
            if how != "survived":
                return outcomes.add(mutant, how, by)
            asked.append(suite)
    return outcomes.add(mutant, "survived", asked=asked)


def listed():
    """What `cargo mutants` lists, numbered."""
    found = subprocess.run(["cargo", "mutants", "--list", "--json"], cwd=TOP, stdout=subprocess.PIPE, check=True).stdout
    return [mutant | {"n": n} for n, mutant in enumerate(json.loads(found), 1)]


def run_all(mutants, outcomes, options, reasons):
    """Tries those of these mutants that still have to be."""
    chosen = [mutant for mutant in mutants if re.search(options.only, mutant["name"])]

    def is_wanted(mutant):
        return outcomes.how(mutant) in ("not tried", "survived")

    def order(mutant):
        return outcomes.how(mutant) == "survived", place(mutant["name"]) in reasons

    tests = ["--lib", *(part for suite in SUITES for part in ("--test", suite))]
    sleeping, running = set(), plant_all(tracked(), mutants, ())[1]

    def tree(mutant):
        is_lane = mutant["file"].startswith("src/simd/")
        return "constants" if mutant["n"] not in running else "lanes" if is_lane else "asleep"

    # All are planted, whatever is wanted, so that a run that goes on finds what is built.
    for name, change, check, test in (
        ("lanes", lanes_tree, ["--lib"], ["--lib"]),
        ("asleep", main_tree, ["--lib", *PACKAGES], [*PACKAGES, *tests]),
        ("constants", whole_tree, ["--lib", *PACKAGES], [*PACKAGES, *tests]),
    ):
        own = [mutant for mutant in mutants if tree(mutant) == name]
        if not any(is_wanted(mutant) and re.search(options.only, mutant["name"]) for mutant in own):
            continue
        built = Built(name, own)
        if not (options.as_built and built.is_current):
            settle(built, own, change, check, name == "constants")
            built.replace(build(built.tree, *test) or sys.exit(f"the tree {name} doesn't build"))
        say(f"{name}: {len(built.asleep)} of {len(own)} sleep")
        for mutant in own:
            if mutant["name"] in built.refused and not outcomes.of(mutant):
                outcomes.add(mutant, "doesn't compile", "beside the original")
        sleeping |= set(built.asleep)
        wanted = [mutant for mutant in chosen if mutant["n"] in built.asleep and is_wanted(mutant)]
        random.Random(1).shuffle(wanted)  # whenever it is stopped, what was tried is a sample
        wanted.sort(key=order)
        say(f"{name}: {len(wanted)} to try")
        wake(wanted, built, measured(built, options), outcomes, options)
    alone = [mutant for mutant in chosen if mutant["n"] not in sleeping and not outcomes.of(mutant)]
    one_by_one(alone if options.alone is None else random.Random(1).sample(alone, min(options.alone, len(alone))), outcomes)


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("--only", default="", help="mutants whose name has this regular expression")
    options.add_argument("--alone", type=int, metavar="N", help="so many of those that need a build each, drawn by a fixed seed")
    options.add_argument("--slowest", type=float, default=15, help="seconds of CPU: a survivor is asked by every faster test")
    options.add_argument("--tests", default="", metavar="REGEX", help="tests whose name has this regular expression")
    options.add_argument("--as-built", action="store_true", help="with what was built last, whatever tests have changed since")
    options.add_argument("--again", action="store_true", help="survivors are asked by all tests anew: after a change of tests")
    options.add_argument("--threads", type=int, default=os.cpu_count(), help="so many tests at a time")
    options.add_argument("--outcomes", type=pathlib.Path, default=WORK / "outcomes.jsonl")
    options.add_argument("--print", choices=["rooms", "reasons"], default="rooms",
                         help="a table, as CSV: rooms, or, trying nothing more, why survivors survive")
    options = options.parse_args()
    os.nice(max(0, 10 - os.nice(0)))  # others' work goes first
    WORK.mkdir(parents=True, exist_ok=True)
    mutants, outcomes = listed(), Outcomes(options.outcomes)
    with (TOP / "tests/survivors.csv").open() as file:
        reasons = {row["mutant"]: row["reason"] for row in csv.DictReader(file)}
    if options.print == "rooms":
        run_all(mutants, outcomes, options, reasons)
    survivors, unexplained = judge(mutants, outcomes, reasons, options.slowest)
    csv.writer(sys.stdout, lineterminator="\n").writerows(
        by_room(mutants, outcomes, options.slowest) if options.print == "rooms" else by_reason(survivors, reasons))
    sys.exit(f"{unexplained} survivors have no reason" if unexplained else 0)


if __name__ == "__main__":
    main()
