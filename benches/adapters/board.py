"""The board: every adapter of claims.toml, judged by `sdop.judge` in a process of its own.

    python benches/adapters/board.py            # JSON
    python benches/adapters/board.py --check    # a table, and exit code 1 for a verdict or version that claims.toml does not name
    python benches/adapters/board.py --one coal

Verdicts: `pass`, every case was judged and nothing was missed; `partial`, nothing was missed in those that the library can
represent; `does not claim`, what was missed is outside of its claim; `fail`; `error`. Only published cases are judged: they are the
same everywhere.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import importlib.util
import json
import subprocess
import sys
import tomllib
from collections import Counter
from pathlib import Path

HERE = Path(__file__).resolve().parent
TRIES = 20


def claims() -> list[dict]:
    return tomllib.loads((HERE / "claims.toml").read_text(encoding="utf-8"))["adapter"]


def judged(name: str) -> dict:
    """One adapter's row. Loads the library, so it may end the process."""
    import sdop

    claimed = next(it for it in claims() if it["name"] == name)
    sys.path.append(str(HERE))
    spec = importlib.util.spec_from_file_location(f"adapter_{name}", HERE / name / "adapter.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    verdict = sdop.judge(module.Adapter, claims=claimed["claim"])
    outcomes = Counter(case["outcome"] for case in verdict.cases)
    pairs = Counter()
    for case in verdict.cases:
        pairs.update(case["pairs"])
    failed = [case["name"] for case in verdict.cases if case["outcome"] == "fail"]
    is_touching = bool(failed) and all(touches(module.Adapter, claimed["claim"], case) for case in failed)
    row = {
        **{key: claimed[key] for key in ("name", "package", "claim", "says")},
        "version": importlib.metadata.version(claimed["package"]),
        "cases": len(verdict.cases),
        **{outcome: outcomes[outcome] for outcome in ("pass", "fail", "skipped", "error")},
        "pairs": {key: pairs[key] for key in ("judged", "required", "missed", "extra")},
        "skipped_because": dict(sorted(Counter(c["why"] for c in verdict.cases if c["outcome"] == "skipped").items())),
        "missed_in": failed,
        "misses_only_touch": is_touching,
    }
    return {**row, "verdict": verdict_of(row, claimed.get("touching", True))}


def touches(adapter: type, claim: str, case: str) -> bool:
    """Whether the pair missed in the smallest scene that fails is parted by a shift of one float32 step.

    An answer that varies from run to run may be right when it is judged again: then it is judged until it fails."""
    import sdop

    for _ in range(TRIES):
        missed = sdop.judge(adapter, claims=claim, cases=case).missed
        if missed is not None:
            return missed.depth_ulps == 1
    return False


def verdict_of(row: dict, claims_touching: bool) -> str:
    if row["error"]:
        return "error"
    if row["fail"]:
        return "fail" if claims_touching or not row["misses_only_touch"] else "does not claim"
    if row["pass"] == 0:
        return "does not claim"
    return "partial" if row["skipped"] else "pass"


def in_own_process(name: str) -> dict:
    run = subprocess.run([sys.executable, "-P", __file__, "--one", name], capture_output=True, text=True)
    if run.returncode == 0:
        return json.loads(run.stdout)
    claimed = next(it for it in claims() if it["name"] == name)
    nothing = dict.fromkeys(("cases", "pass", "fail", "skipped", "error"), 0)
    pairs = dict.fromkeys(("judged", "required", "missed", "extra"), 0)
    said = run.stderr.strip().splitlines()[-1:]
    return {
        **{key: claimed[key] for key in ("name", "package", "claim", "says", "version")},
        **nothing,
        "pairs": pairs,
        "skipped_because": {},
        "missed_in": [],
        "misses_only_touch": False,
        "verdict": "error",
        "how": said[0] if said else f"exit code {run.returncode}",
    }


def check(rows: list[dict]) -> int:
    changed = []
    print(f"{'library':24}{'claim':8}{'cases':>6}{'judged':>8}{'required':>9}{'missed':>8}{'extra':>7}  verdict")
    for row, claimed in zip(rows, claims(), strict=True):
        library, pairs = f"{row['package']} {row['version']}", row["pairs"]
        cases = row["pass"] + row["fail"]
        print(
            f"{library:24}{row['claim']:8}{cases:>6}{pairs['judged']:>8}{pairs['required']:>9}"
            f"{pairs['missed']:>8}{pairs['extra']:>7}  {row['verdict']}"
        )
        for key in ("version", "verdict"):
            if row[key] != claimed[key]:
                changed.append(f"{row['name']}: {key} {row[key]}, and claims.toml has {claimed[key]}")
        if row["verdict"] == "error":
            changed.append(f"{row['name']}: {row.get('how') or 'a case ends in an error'}")
    print(*changed, sep="\n", file=sys.stderr)
    return 1 if changed else 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--one", metavar="NAME")
    arguments = parser.parse_args()
    if arguments.one:
        print(json.dumps(judged(arguments.one)))
        return 0
    rows = [in_own_process(it["name"]) for it in claims()]
    if arguments.check:
        return check(rows)
    print(json.dumps({"adapters": rows}, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
