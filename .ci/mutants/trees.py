"""Trees in which mutants sleep: what is planted in them, and what cargo builds of them."""

import collections
import functools
import json
import os
import pathlib
import re
import subprocess
import sys

import constants
import plant
from outcomes import TOP, digest, say

WORK = TOP / "target/mutants"
ENVIRONMENT = os.environ | {
    "CARGO_PROFILE_TEST_OPT_LEVEL": "1",
    "CARGO_PROFILE_TEST_DEBUG": "none",
    "CARGO_PROFILE_DEV_DEBUG": "none",
    "RUST_BACKTRACE": "0",
    "RUST_TEST_THREADS": "1",
}
# The room of the lanes as a crate, so that each of its functions may ask who is awake and still
# compile in seconds.
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
    command = ["cargo", *arguments, "--message-format=json", "--quiet"]
    # Not shared: cargo names what it builds by paths within a tree, and one tree's binaries would
    # replace another's.
    environment = ENVIRONMENT | {"CARGO_TARGET_DIR": str(WORK / "target" / tree.name)}
    done = subprocess.run(command, cwd=tree, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")], done


@functools.cache
def tracked():
    """The files of the tree, by name, as they are when first asked for: all that a run builds is of
    one state."""
    names = subprocess.run(["git", "ls-files", "-z"], cwd=TOP, stdout=subprocess.PIPE, check=True).stdout.decode()
    return {name: (TOP / name).read_bytes() for name in names.split("\0") if name and (TOP / name).is_file()}


def write_tree(tree, files):
    """Makes `tree` have these files. Those that are as they were keep their times, and cargo what
    it built of them."""
    for path in [path for path in tree.rglob("*") if path.is_file() and str(path.relative_to(tree)) not in files]:
        path.unlink()
    for name, text in files.items():
        path = tree / name
        if not path.is_file() or path.read_bytes() != text:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(text)


def plant_all(files, mutants, bad, with_constants=False):
    """The files with all these mutants but `bad` asleep in them, and the numbers that sleep."""
    own, planted, asleep = collections.defaultdict(list), dict(files), {}
    for mutant in mutants:
        own[mutant["file"]].append(mutant)
    late, reads = constants.late(files, mutants) if with_constants else ({}, {})
    for name in {**own, **reads}:
        those = [mutant for mutant in own[name] if mutant["name"] not in bad]
        file = plant.File(files[name], those, late.get(name, ()), reads.get(name, ()))
        planted[name] = file.text.encode()
        assert plant.numbers(file.text) >= set(file.asleep), f"{name}: mutants that are not in the text"
        asleep |= file.asleep
    return planted, asleep


def two_tiers(files):
    """The files without the middle tiers of x86 and without forced inlining, because kernels with
    many sleeping mutants compile slowly."""
    module = "src/simd/mod.rs"
    text, times = re.subn(rb"(sse2|avx2)::run\(token, kernel\)", b"kernel.run(scalar::Scalar::<false>::new())", files[module])
    assert times == 2, "the dispatch of tiers has moved"
    files[module] = text
    module = "src/simd/tier.rs"
    text, times = re.subn(rb"(sse2::Sse2|avx2::Avx2)::new\(\)\.map\(Isa::\w+\),", b"", files[module])
    assert times == 2, "the list of tiers has moved"
    files[module] = text
    for name in files:
        if re.match(r"src/(overlap|broad_phase|strategy|update|rounding)/.*\.rs$", name):
            files[name] = files[name].replace(b"inline(always)", b"inline(never)")


class Built:
    """A tree in which mutants sleep, and the facts about it, which are stored in a file for later
    runs."""

    def __init__(self, name, mutants):
        self.tree, self.file = WORK / name, WORK / f"{name}.json"
        self.mutants = [mutant["name"] for mutant in mutants]
        known = json.loads(self.file.read_text()) if self.file.exists() else {}
        self.is_current = known.get("mutants") == self.mutants
        # Mutants that don't compile together with the original; the place of each mutant that
        # sleeps; test binaries; cost and places of tests.
        self.refused = set(known.get("refused", []))
        self.asleep = {int(n): place for n, place in known.get("asleep", {}).items()}
        self.binaries, self.digests = known.get("binaries", {}), known.get("digests", {})
        self.tests = known.get("tests", {})

    def keep(self):
        self.file.write_text(json.dumps({"mutants": self.mutants, "refused": sorted(self.refused), "asleep": self.asleep,
                                         "binaries": self.binaries, "digests": self.digests, "tests": self.tests}))

    def replace(self, binaries):
        """Uses new test binaries. Costs of a changed suite stay as estimates."""
        digests = {suite: digest(pathlib.Path(path).read_bytes()) for suite, path in binaries.items()}
        changed = {suite for suite in digests if digests[suite] != self.digests.get(suite)}
        self.tests = {name: (cost, None) if name.split("::")[0] in changed else (cost, places)
                      for name, (cost, places) in self.tests.items()}
        self.binaries, self.digests = binaries, digests
        self.keep()


def settle(built, mutants, change, check, with_constants):
    """Plants until the tree compiles, leaving out what an error points at."""
    tree, bad, files = built.tree, built.refused, tracked()
    tree.mkdir(exist_ok=True)
    names = {mutant["n"]: mutant["name"] for mutant in mutants}
    while True:
        planted, asleep = plant_all(files, mutants, bad, with_constants)
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


def whole_tree(files):
    head, rest = re.match(r"((?://!.*\n|\n)*)((?s:.*))", files["src/lib.rs"].decode()).groups()
    with_waker(files, f"{head}{ALLOWED}{rest}")


def main_tree(files):
    whole_tree(files)
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
    return {"lib" if m["target"]["name"] == "sdop" else m["target"]["name"]: m["executable"] for m in built}
