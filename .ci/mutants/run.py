#!/usr/bin/env python3
"""Wakes every mutant that `cargo mutants` lists, one at a time, and asks the tests whether they notice.

A build a mutant would take a day. So all that can are compiled together, asleep (plant.py), in a copy of the tree, and a
process wakes one by its number. What can't sleep is built by itself, `--alone` of them. A mutant is caught when a test fails, or
takes three times its time and ten seconds more. Two tiers run in the copy, scalar and AVX-512: a lane of every other tier is tested
by itself, as a crate of the room `simd`.

    .ci/mutants/run.py [--only REGEX] [--alone N] [--slowest SECONDS] [--tests REGEX] [--again] [--as-built] [--threads N]
                       [--outcomes FILE] [--print TABLE]

Each test runs once with all asleep, which tells what it takes and which mutants' places it comes by: others can't notice.

Goes on where FILE (target/mutants/outcomes.jsonl) ends: what survived there is asked by tests that it was not asked by yet, up to
`--slowest`, so that quick tests may go first. A line an outcome: number, name, digest of its file, how (`caught`, `endless`,
`survived`, `doesn't compile`), by which test, or which tests asked. The mutants of a file whose code has changed are tried anew.
"""

import argparse
import collections
import concurrent.futures
import csv
import functools
import hashlib
import json
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys
import threading

import plant

TOP = pathlib.Path(__file__).resolve().parents[2]
WORK = TOP / "target/mutants"
FEATURES = ["-p", "sdop", "--no-default-features", "--features", "proptest"]
SUITES = ["golden_pairs", "finders", "near_misses", "against_reference", "worst_case", "world", "naive_margins", "finder_costs",
          "volume", "misuse", "crowds", "cost", "accounts", "settings", "domain"]
ENVIRONMENT = os.environ | {
    "CARGO_PROFILE_TEST_OPT_LEVEL": "1",
    "CARGO_PROFILE_TEST_DEBUG": "none",
    "CARGO_PROFILE_DEV_DEBUG": "none",
    "RUST_BACKTRACE": "0",
    "RUST_TEST_THREADS": "1",
}
# The room of the lanes as a crate, so that each of its functions may ask who is awake and still compile in seconds.
LANES_ALONE = """[workspace]
[package]
name = "sdop"
version = "0.1.0"
edition = "2024"
build = false
[dependencies]
thiserror = "2"
[profile.test]
opt-level = 1
"""
# Seconds: tests below go together.
QUICK = 0.1
ALLOWED = "#![allow(warnings, unsafe_code, arithmetic_overflow, unconditional_panic, clippy::all)]\n"


def say(text):
    print(text, file=sys.stderr, flush=True)


def cargo(tree, *arguments):
    """The messages of a cargo command, and its exit code."""
    command = ["cargo", *arguments, "--message-format=json", "--quiet"]
    # Not shared: cargo names what it builds by paths within a tree, and one tree's binaries would replace another's.
    environment = ENVIRONMENT | {"CARGO_TARGET_DIR": str(WORK / "target" / tree.name)}
    done = subprocess.run(command, cwd=tree, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")], done


def tracked():
    """The files of the tree, by name."""
    names = subprocess.run(["git", "ls-files", "-z"], cwd=TOP, stdout=subprocess.PIPE, check=True).stdout.decode()
    return {name: (TOP / name).read_bytes() for name in names.split("\0") if name and (TOP / name).is_file()}


def write_tree(tree, files):
    """Makes `tree` have these files. Those that are as they were keep their times, and cargo what it built of them."""
    for path in [path for path in tree.rglob("*") if path.is_file() and str(path.relative_to(tree)) not in files]:
        path.unlink()
    for name, text in files.items():
        path = tree / name
        if not path.is_file() or path.read_bytes() != text:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(text)


def plant_all(files, mutants, bad):
    """The files with all these mutants but `bad` asleep in them, and the numbers that sleep."""
    own = collections.defaultdict(list)
    for mutant in mutants:
        own[mutant["file"]].append(mutant)
    planted, asleep = dict(files), {}
    for name, those in own.items():
        file = plant.File(files[name], [mutant for mutant in those if mutant["name"] not in bad])
        planted[name] = file.text.encode()
        assert plant.numbers(file.text) >= set(file.asleep), f"{name}: mutants that are not in the text"
        asleep |= file.asleep
    return planted, asleep


def two_tiers(files):
    """Kernels full of sleepers compile slowly: the middle tiers of x86 become the scalar one, and nothing must be inlined."""
    module = "src/simd/mod.rs"
    text, times = re.subn(rb"(sse2|avx2)::run\(token, kernel\)", b"kernel.run(scalar::Scalar::<false>::new())", files[module])
    assert times == 2, "the dispatch of tiers has moved"
    files[module] = text
    for name in files:
        if re.match(r"src/(overlap|broad_phase|strategy|update|rounding)/.*\.rs$", name):
            files[name] = files[name].replace(b"#[inline(always)]", b"#[inline(never)]")


class Built:
    """A tree in which mutants sleep, and what is known of it, which stays in a file for a run that goes on."""

    def __init__(self, name, mutants):
        self.tree, self.file = WORK / name, WORK / f"{name}.json"
        self.mutants = [mutant["name"] for mutant in mutants]
        known = json.loads(self.file.read_text()) if self.file.exists() else {}
        self.is_current = known.get("mutants") == self.mutants
        # What doesn't compile beside the original; the place of each mutant that sleeps; test binaries; cost and places of tests.
        self.refused = set(known.get("refused", []))
        self.asleep = {int(n): place for n, place in known.get("asleep", {}).items()}
        self.binaries, self.tests = known.get("binaries", {}), known.get("tests", {})

    def keep(self):
        self.file.write_text(json.dumps({"mutants": self.mutants, "refused": sorted(self.refused), "asleep": self.asleep,
                                         "binaries": self.binaries, "tests": self.tests}))


def settle(built, mutants, change, check):
    """Plants until the tree compiles, leaving out what an error points at."""
    tree, bad, files = built.tree, built.refused, tracked()
    tree.mkdir(exist_ok=True)
    names = {mutant["n"]: mutant["name"] for mutant in mutants}
    while True:
        planted, asleep = plant_all(files, mutants, bad)
        change(planted)
        write_tree(tree, planted)
        messages, done = cargo(tree, "check", *check)
        errors = [m["message"] for m in messages if m.get("reason") == "compiler-message" and m["message"]["level"] == "error"]
        if not errors and done.returncode == 0:
            built.asleep = asleep
            return
        found = set()
        for span in (span for error in errors for span in error["spans"] if span["is_primary"]):
            text = (tree / span["file_name"]).read_bytes()
            found |= {names[n] for n in plant.culprits(text, span["byte_start"], span["byte_end"])}
        if found <= bad:
            sys.exit(f"these errors point at no mutant:\n{''.join(e['rendered'] for e in errors)}{done.stderr}")
        bad |= found
        say(f"{len(bad)} don't compile asleep")


def with_waker(files, lib):
    files["src/lib.rs"] = f"{lib}\n#[doc(hidden)]\npub mod mutant;\n".encode()
    files["src/mutant.rs"] = plant.WAKER.encode()


def main_tree(files):
    head, rest = re.match(r"((?://!.*\n|\n)*)((?s:.*))", files["src/lib.rs"].decode()).groups()
    with_waker(files, f"{head}{ALLOWED}{rest}")
    two_tiers(files)


def lanes_tree(files):
    files["Cargo.toml"] = LANES_ALONE.encode()
    with_waker(files, f"{ALLOWED}pub mod simd;")


def build(tree, *arguments):
    """Test binaries by suite; none when the tree doesn't compile."""
    messages, done = cargo(tree, "test", "--no-run", *arguments)
    if done.returncode:
        errors = [m["message"]["rendered"] for m in messages if m.get("reason") == "compiler-message"]
        say("".join(errors)[-3000:] + done.stderr[-1000:])
        return {}
    built = [m for m in messages if m.get("reason") == "compiler-artifact" and m["profile"]["test"] and m["executable"]]
    return {"lib" if "lib" in m["target"]["kind"] else m["target"]["name"]: m["executable"] for m in built}


def limited(seconds):
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def ask(tree, name, command, seconds, **environment):
    """Runs tests: how it ended, and by which test or signal; and what they wrote to stderr."""
    environment = ENVIRONMENT | {"CARGO_MANIFEST_DIR": str(tree)} | environment
    try:
        done = subprocess.run([*command, "-q"], cwd=tree, env=environment, stdin=subprocess.DEVNULL, timeout=120,
                              capture_output=True, text=True, errors="replace",
                              preexec_fn=functools.partial(limited, seconds))
    except subprocess.TimeoutExpired:
        return "endless", name, ""
    if done.returncode == 0:
        return "survived", None, done.stderr
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return "endless", name, ""
    failed = sorted(set(re.findall(r"^    (\S+)$", done.stdout.split("\nfailures:")[-1], re.M)))
    return "caught", ", ".join(failed[:3]) or f"{name}, by signal {-done.returncode}", ""


class Test:
    """A test, or the library's own tests together, but for those of sweeps; `cost` is its CPU time in seconds when nothing is awake,
    `places` are those that it comes by."""

    def __init__(self, built, suite, test=None):
        self.name = f"{suite}::{test}" if test else suite
        self.built, self.suite = built, suite
        self.arguments = ["--exact", test] if test else ["--skip", "lab::sweep"]
        self.cost, self.places = built.tests.get(self.name, (0, None))

    def measure(self, slowest):
        """Runs it with all asleep, unless it is known to be slower than that."""
        if self.places or self.cost > slowest:
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
            names = re.findall(r"^(\S+): test$", listed, re.M)
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
        return ask(self.tree, self.name, self.command, int(3 * self.cost) + 10, MUTANT=str(number))[:2]


def together(tests):
    """These tests by process, quick ones of a suite in one."""
    quick = collections.defaultdict(list)
    for test in tests:
        quick[test.suite if test.cost < QUICK else test.name].append(test)
    return [Together(own) for own in quick.values()]


class Outcomes:
    """What is known of each mutant, as long as its file is as it was then."""

    def __init__(self, path):
        self.path, self.lock, self.digests = path, threading.Lock(), {}
        lines = path.read_text().splitlines() if path.exists() else []
        self.known = {outcome["name"]: outcome for outcome in map(json.loads, lines)}

    def digest(self, mutant):
        file = mutant["file"]
        if file not in self.digests:
            code = (TOP / file).read_bytes().split(b"\n#[cfg(test)]\nmod tests")[0]  # a test more takes nothing back
            self.digests[file] = hashlib.sha256(code).hexdigest()[:12]
        return self.digests[file]

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


def wake(mutants, asleep, tests, outcomes, options):
    """Asks the tests that come by each, those first that caught the most in its file."""
    caught = collections.defaultdict(collections.Counter)

    def one(mutant):
        seen, known = caught[mutant["file"]], outcomes.of(mutant) or {}
        asked = [] if options.again else list(known.get("asked", []))
        able = [test for test in tests if asleep[mutant["n"]] in test.places and test.name not in asked]
        for some in sorted(together(able), key=lambda some: (-seen[some.name], some.cost)):
            how, by = some.ask(mutant["n"])
            if how != "survived":
                seen[some.name] += 1
                return outcomes.add(mutant, how, by)
            asked += [test.name for test in some.tests]
        return outcomes.add(mutant, "survived", asked=asked, slowest=options.slowest)

    with concurrent.futures.ThreadPoolExecutor(options.threads) as pool:
        for _ in pool.map(one, mutants):
            pass


def one_by_one(mutants, outcomes):
    """Builds each of these mutants by itself, and asks the suites that catch most."""
    tree, files = WORK / "alone", tracked()
    for mutant in mutants:
        name = mutant["file"]
        write_tree(tree, files | {name: plant.applied(files[name], mutant)})
        if cargo(tree, "check", "--lib", *FEATURES)[1].returncode:
            outcomes.add(mutant, "doesn't compile", "alone")
        else:
            ask_alone(tree, mutant, outcomes)


def ask_alone(tree, mutant, outcomes):
    asked = []
    for suites in (["--lib"], ["--test", "golden_pairs"], [part for suite in SUITES[1:] for part in ("--test", suite)]):
        binaries = build(tree, *FEATURES, *suites)
        if not binaries:
            return outcomes.add(mutant, "doesn't compile", "alone")
        for suite, executable in binaries.items():
            how, by, _ = ask(tree, suite, [executable], 120)
            if how != "survived":
                return outcomes.add(mutant, how, by)
            asked.append(suite)
    return outcomes.add(mutant, "survived", asked=asked)


def place(name):
    """A mutant's name without line and column, which move with every change."""
    return re.sub(r":\d+:\d+:", ":", name, count=1)


def by_room(mutants, outcomes, slowest):
    """A row a room: its mutants, and how they ended."""
    rooms = collections.defaultdict(collections.Counter)
    for mutant in mutants:
        rooms[mutant["file"].split("/")[1]][outcomes.how(mutant, slowest)] += 1
    yield "room", "mutants", "dont_compile", "not_tried", "tried", "caught", "by_a_loop_without_end", "survive", "asked_in_part"
    for room, of in sorted(rooms.items()):
        caught, left = of["caught"] + of["endless"], (of["survived"], of["asked in part"])
        yield room, of.total(), of["doesn't compile"], of["not tried"], caught + sum(left), caught, of["endless"], *left


def by_reason(survivors, reasons):
    """A row a reason, of survivors that have one."""
    yield "why", "survivors"
    yield from collections.Counter(reasons[place(name)] for name in survivors if place(name) in reasons).most_common()


def judge(mutants, outcomes, reasons, slowest):
    """Says what has no reason to survive, and of which reasons nothing survives; how many have none."""
    survivors = [mutant["name"] for mutant in mutants if outcomes.how(mutant, slowest) == "survived"]
    unexplained = [name for name in survivors if place(name) not in reasons]
    for name in unexplained:
        say(f"unexplained{'' if outcomes.known[name]['asked'] else ', run by no test'}: {name}")
    for name in sorted(set(reasons) - set(map(place, survivors))):
        say(f"explained, but no survivor: {name}")
    return survivors, len(unexplained)


def listed():
    """What `cargo mutants` lists, numbered."""
    found = subprocess.run(["cargo", "mutants", "--list", "--json"], cwd=TOP, stdout=subprocess.PIPE, check=True).stdout
    # A module that is public behind a feature alone has two declarations, and its mutants are listed twice.
    unlike = {mutant["name"]: mutant for mutant in json.loads(found)}.values()
    return [mutant | {"n": n} for n, mutant in enumerate(unlike, 1)]


def run_all(mutants, outcomes, options):
    """Tries those of these mutants that still have to be."""
    chosen = [mutant for mutant in mutants if re.search(options.only, mutant["name"])]

    def is_wanted(mutant):
        known = outcomes.of(mutant)
        return not known or (known["how"] == "survived" and (options.again or known.get("slowest", 1e9) < options.slowest))

    tests = ["--lib", *(part for suite in SUITES for part in ("--test", suite))]
    sleeping = set()
    for name, own, change, check, test in (
        ("lanes", lambda mutant: mutant["file"].startswith("src/simd/"), lanes_tree, ["--lib"], ["--lib"]),
        ("asleep", lambda mutant: not mutant["file"].startswith("src/simd/"), main_tree, ["--lib", *FEATURES], [*FEATURES, *tests]),
    ):
        # All are planted, whatever is wanted, so that a run that goes on finds what is built.
        own = [mutant for mutant in mutants if own(mutant)]
        if not any(is_wanted(mutant) and re.search(options.only, mutant["name"]) for mutant in own):
            continue
        built = Built(name, own)
        if not (options.as_built and built.is_current):
            settle(built, own, change, check)
            built.binaries, built.tests = build(built.tree, *test) or sys.exit(f"the tree {name} doesn't build"), {}
            built.keep()
        say(f"{name}: {len(built.asleep)} of {len(own)} sleep")
        for mutant in own:
            if mutant["name"] in built.refused and not outcomes.of(mutant):
                outcomes.add(mutant, "doesn't compile", "beside the original")
        sleeping |= set(built.asleep)
        wanted = [mutant for mutant in chosen if mutant["n"] in built.asleep and is_wanted(mutant)]
        random.Random(1).shuffle(wanted)  # whenever it is stopped, what was tried is a sample
        say(f"{name}: {len(wanted)} to try")
        wake(wanted, built.asleep, measured(built, options), outcomes, options)
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
    if options.print == "rooms":
        run_all(mutants, outcomes, options)
    with (TOP / "tests/survivors.csv").open() as file:
        reasons = {row["mutant"]: row["reason"] for row in csv.DictReader(file)}
    survivors, unexplained = judge(mutants, outcomes, reasons, options.slowest)
    csv.writer(sys.stdout, lineterminator="\n").writerows(
        by_room(mutants, outcomes, options.slowest) if options.print == "rooms" else by_reason(survivors, reasons))
    sys.exit(f"{unexplained} survivors have no reason" if unexplained else 0)


if __name__ == "__main__":
    main()
