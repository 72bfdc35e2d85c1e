#!/usr/bin/env python3
"""Wakes every mutant that `cargo mutants` lists, one at a time, and asks the tests whether they notice.

A build a mutant would take a day. So all that can are compiled together, asleep (plant.py), in a copy of the tree, and a
process wakes one by its number. What can't sleep is built by itself. A mutant is caught when a test fails, or takes three
times its time and ten seconds more. Two tiers run in the copy, scalar and AVX-512: a lane of every other tier is tested by
itself, as a crate of the room `simd`.

    .ci/mutants/run.py [--only REGEX] [--sample N] [--slowest SECONDS] [--threads N] [--outcomes FILE]

Goes on where FILE (target/mutants/outcomes.jsonl) ends; a line an outcome: number, name, how (`caught`, `endless`,
`survived`, `doesn't compile`), by which test.
"""

import argparse
import collections
import concurrent.futures
import csv
import functools
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import threading

import plant

TOP = pathlib.Path(__file__).resolve().parents[2]
WORK = TOP / "target/mutants"
FEATURES = ["-p", "sdop", "--no-default-features", "--features", "proptest"]
SUITES = ["golden_pairs", "finders", "near_misses", "against_reference", "worst_case", "world", "naive_margins", "finder_costs",
          "volume", "misuse", "crowds", "cost", "accounts", "settings"]
ENVIRONMENT = os.environ | {
    "CARGO_PROFILE_TEST_OPT_LEVEL": "1",
    "CARGO_PROFILE_TEST_DEBUG": "none",
    "CARGO_PROFILE_DEV_DEBUG": "none",
    "RUST_BACKTRACE": "0",
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
ALLOWED = "#![allow(warnings, unsafe_code, arithmetic_overflow, unconditional_panic, clippy::all)]\n"


def cargo(tree, *arguments):
    """The messages of a cargo command, and its exit code."""
    command = ["nice", "cargo", *arguments, "--message-format=json", "--quiet"]
    # Not shared: cargo names what it builds by paths within a tree, and one tree's binaries would replace another's.
    environment = ENVIRONMENT | {"CARGO_TARGET_DIR": str(WORK / "target" / tree.name)}
    done = subprocess.run(command, cwd=tree, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")], done


def copy_tree(name):
    tree = WORK / name
    shutil.rmtree(tree, ignore_errors=True)
    tree.mkdir(parents=True)
    files = subprocess.run(["git", "ls-files", "-z"], cwd=TOP, stdout=subprocess.PIPE, check=True).stdout
    pack = subprocess.Popen(["tar", "--null", "-T", "-", "-c"], cwd=TOP, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    threading.Thread(target=lambda: (pack.stdin.write(files), pack.stdin.close())).start()
    subprocess.run(["tar", "-x"], cwd=tree, stdin=pack.stdout, check=True)
    return tree


def plant_all(tree, mutants, bad):
    """Writes the mutants' files anew with all but `bad` asleep; the numbers that sleep."""
    files = collections.defaultdict(list)
    for mutant in mutants:
        files[mutant["file"]].append(mutant)
    asleep = set()
    for name, own in files.items():
        file = plant.File((TOP / name).read_bytes(), [mutant for mutant in own if mutant["n"] not in bad])
        (tree / name).write_text(file.text)
        asleep |= file.asleep
    return asleep


def two_tiers(tree):
    """Kernels full of sleepers compile slowly: the middle tiers of x86 become the scalar one, and nothing must be inlined."""
    module = "src/simd/mod.rs"
    text = (TOP / module).read_text()
    text, times = re.subn(r"(sse2|avx2)::run\(token, kernel\)", "kernel.run(scalar::Scalar::<false>::new())", text)
    assert times == 2, "the dispatch of tiers has moved"
    (tree / module).write_text(text)
    for room in ("overlap", "broad_phase", "strategy", "update", "rounding"):
        for file in (tree / "src" / room).rglob("*.rs"):
            file.write_text(file.read_text().replace("#[inline(always)]", "#[inline(never)]"))


def settle(tree, mutants, prepare, check):
    """Plants until the tree compiles, leaving out what an error points at; the numbers that sleep."""
    bad = set()
    while True:
        asleep = plant_all(tree, mutants, bad)
        prepare(tree)
        messages, done = cargo(tree, "check", *check)
        errors = [m["message"] for m in messages if m.get("reason") == "compiler-message" and m["message"]["level"] == "error"]
        if not errors and done.returncode == 0:
            return asleep
        found = set()
        for span in (span for error in errors for span in error["spans"] if span["is_primary"]):
            text = (tree / span["file_name"]).read_bytes()
            found |= plant.culprits(text, span["byte_start"], span["byte_end"])
        if found <= bad:
            sys.exit(f"these errors point at no mutant:\n{''.join(e['rendered'] for e in errors)}{done.stderr}")
        bad |= found
        print(f"{len(bad)} don't compile asleep", flush=True)


def with_waker(tree, lib):
    (tree / "src/lib.rs").write_text(f"{lib}\n#[doc(hidden)]\npub mod mutant;\n")
    (tree / "src/mutant.rs").write_text(plant.WAKER)


def main_tree(tree):
    head, rest = re.match(r"((?://!.*\n|\n)*)((?s:.*))", (TOP / "src/lib.rs").read_text()).groups()
    with_waker(tree, f"{head}{ALLOWED}{rest}")
    two_tiers(tree)


def lanes_tree(tree):
    (tree / "Cargo.toml").write_text(LANES_ALONE)
    with_waker(tree, f"{ALLOWED}pub mod simd;")


def build(tree, *arguments):
    """Test binaries by suite; none when the tree doesn't compile."""
    messages, done = cargo(tree, "test", "--no-run", *arguments)
    if done.returncode:
        errors = [m["message"]["rendered"] for m in messages if m.get("reason") == "compiler-message"]
        print("".join(errors)[-3000:], done.stderr[-1000:])
        return {}
    built = [m for m in messages if m.get("reason") == "compiler-artifact" and m["profile"]["test"] and m["executable"]]
    return {"lib" if "lib" in m["target"]["kind"] else m["target"]["name"]: m["executable"] for m in built}


def limited(seconds):
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def ask(tree, name, command, number, seconds):
    """Runs tests with this mutant awake: how it ended, and by which test or signal."""
    environment = ENVIRONMENT | {"MUTANT": str(number), "CARGO_MANIFEST_DIR": str(tree)}
    try:
        done = subprocess.run(["nice", *command, "-q"], cwd=tree, env=environment, stdin=subprocess.DEVNULL, timeout=120,
                              capture_output=True, text=True, errors="replace",
                              preexec_fn=functools.partial(limited, seconds))
    except subprocess.TimeoutExpired:
        return "endless", name
    if done.returncode == 0:
        return "survived", None
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return "endless", name
    failed = sorted(set(re.findall(r"^    (\S+)$", done.stdout.split("\nfailures:")[-1], re.M)))
    return "caught", ", ".join(failed[:3]) or f"{name}, by signal {-done.returncode}"


class Unit:
    """A test, or the library's own tests together; `cost` is its CPU time in seconds when nothing is awake."""

    def __init__(self, tree, suite, executable, test=None):
        self.name = f"{suite}::{test}" if test else suite
        self.tree, self.command = tree, [executable, *(["--exact", test] if test else [])]
        before = os.times()
        how, by = ask(tree, self.name, self.command, 0, 300)
        after = os.times()
        assert how == "survived", f"{self.name} fails when nothing is awake: {by}"
        self.cost = after.children_user + after.children_system - before.children_user - before.children_system

    def ask(self, number):
        return ask(self.tree, self.name, self.command, number, int(3 * self.cost) + 10)


def units(tree, binaries, slowest):
    """The tests of these binaries that take up to `slowest` seconds of CPU, cheapest first."""
    found = []
    for suite, executable in binaries.items():
        if suite == "lib":
            found.append(Unit(tree, suite, executable))
            continue
        listed = subprocess.run([executable, "--list"], cwd=tree, stdout=subprocess.PIPE, text=True, check=True).stdout
        found += [Unit(tree, suite, executable, test) for test in re.findall(r"^(\S+): test$", listed, re.M)]
    found.sort(key=lambda unit: unit.cost)
    for unit in found:
        print(f"{unit.cost:7.2f} s{'' if unit.cost <= slowest else ', left out'}: {unit.name}", flush=True)
    return [unit for unit in found if unit.cost <= slowest]


class Outcomes:
    def __init__(self, path):
        self.path, self.lock = path, threading.Lock()
        lines = path.read_text().splitlines() if path.exists() else []
        self.known = {outcome["name"]: outcome for outcome in map(json.loads, lines)}

    def add(self, mutant, how, by=None):
        with self.lock, self.path.open("a") as file:
            outcome = {"n": mutant["n"], "name": mutant["name"], "how": how, "by": by}
            self.known[mutant["name"]] = outcome
            file.write(json.dumps(outcome) + "\n")

    def missing(self, mutants):
        return [mutant for mutant in mutants if mutant["name"] not in self.known]


def wake(mutants, tests, outcomes, threads):
    """Asks the tests about each, those first that caught the most in its file."""
    caught = collections.defaultdict(collections.Counter)

    def one(mutant):
        seen = caught[mutant["file"]]
        for test in sorted(tests, key=lambda test: (-seen[test.name], test.cost)):
            how, by = test.ask(mutant["n"])
            if how != "survived":
                seen[test.name] += 1
                return outcomes.add(mutant, how, by)
        return outcomes.add(mutant, "survived")

    with concurrent.futures.ThreadPoolExecutor(threads) as pool:
        for _ in pool.map(one, mutants):
            pass


def one_by_one(mutants, outcomes):
    """Builds each of these mutants by itself, and asks the suites that catch most."""
    tree = copy_tree("alone")
    for mutant in mutants:
        file, source = tree / mutant["file"], (TOP / mutant["file"]).read_bytes()
        file.write_bytes(plant.applied(source, mutant))
        if cargo(tree, "check", "--lib", *FEATURES)[1].returncode:
            outcomes.add(mutant, "doesn't compile")
        else:
            ask_alone(tree, mutant, outcomes)
        file.write_bytes(source)


def ask_alone(tree, mutant, outcomes):
    for suites in (["--lib"], ["--test", "golden_pairs"], [part for suite in SUITES[1:] for part in ("--test", suite)]):
        binaries = build(tree, *FEATURES, *suites)
        if not binaries:
            return outcomes.add(mutant, "doesn't compile")
        for suite, executable in binaries.items():
            how, by = ask(tree, suite, [executable], 0, 120)
            if how != "survived":
                return outcomes.add(mutant, how, by)
    return outcomes.add(mutant, "survived")


def place(name):
    """A mutant's name without line and column, which move with every change."""
    return re.sub(r":\d+:\d+:", ":", name, count=1)


def report(mutants, outcomes):
    """A Markdown table by room, of the mutants that were tried; fails on a survivor without a reason in tests/survivors.csv."""
    hows = ["doesn't compile", "caught", "endless", "survived"]
    rooms = collections.defaultdict(collections.Counter)
    for mutant in mutants:
        for room in (mutant["file"].split("/")[1], "all"):
            rooms[room][outcomes.known[mutant["name"]]["how"]] += 1
    print("| room | mutants | don't compile | caught | by a loop without end | survive |\n|---|--:|--:|--:|--:|--:|")
    for room, counts in sorted(rooms.items(), key=lambda row: row[0] == "all"):
        print(f"| `{room}` | {counts.total()} | {' | '.join(str(counts[how]) for how in hows)} |")
    with (TOP / "tests/survivors.csv").open() as file:
        explained = {row["mutant"] for row in csv.DictReader(file)}
    survivors = [mutant["name"] for mutant in mutants if outcomes.known[mutant["name"]]["how"] == "survived"]
    unexplained = [name for name in survivors if place(name) not in explained]
    print("\n".join(f"unexplained: {name}" for name in unexplained))
    return len(unexplained)


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("--only", default="", help="mutants whose name has this regular expression")
    options.add_argument("--sample", type=int, help="so many of them, drawn by a fixed seed")
    options.add_argument("--slowest", type=float, default=15, help="seconds of CPU: a survivor is asked by every faster test")
    options.add_argument("--threads", type=int, default=os.cpu_count(), help="so many tests at a time")
    options.add_argument("--outcomes", type=pathlib.Path, default=WORK / "outcomes.jsonl")
    options = options.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    listed = subprocess.run(["cargo", "mutants", "--list", "--json"], cwd=TOP, stdout=subprocess.PIPE, check=True).stdout
    # A module that is public behind a feature alone has two declarations, and its mutants are listed twice.
    unlike = {mutant["name"]: mutant for mutant in json.loads(listed)}.values()
    mutants = [mutant | {"n": n} for n, mutant in enumerate(unlike, 1)]
    outcomes = Outcomes(options.outcomes)
    chosen = [mutant for mutant in mutants if re.search(options.only, mutant["name"])]
    if options.sample is not None:
        chosen = random.Random(1).sample(chosen, min(options.sample, len(chosen)))
    wanted = outcomes.missing(chosen)
    print(f"{len(mutants)} mutants, {len(wanted)} to try", flush=True)

    lanes = [mutant for mutant in wanted if mutant["file"].startswith("src/simd/")]
    others = [mutant for mutant in wanted if mutant not in lanes]
    tests = ["--lib", *(part for suite in SUITES for part in ("--test", suite))]
    for name, own, prepare, check, test in (
        ("lanes", lanes, lanes_tree, ["--lib"], ["--lib"]),
        ("asleep", others, main_tree, ["--lib", *FEATURES], [*FEATURES, *tests]),
    ):
        if own:
            tree = copy_tree(name)
            asleep = settle(tree, own, prepare, check)
            print(f"{name}: {len(asleep)} of {len(own)} sleep", flush=True)
            binaries = build(tree, *test) or sys.exit(f"the tree {name} doesn't build")
            wake([mutant for mutant in own if mutant["n"] in asleep], units(tree, binaries, options.slowest), outcomes,
                 options.threads)
    one_by_one(outcomes.missing(wanted), outcomes)
    sys.exit(f"{unexplained} survivors have no reason" if (unexplained := report(chosen, outcomes)) else 0)


if __name__ == "__main__":
    main()
