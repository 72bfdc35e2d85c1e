#!/usr/bin/env python3
"""Many ranks: measures, fits the model and writes the tables of many-ranks.md.

    model.py measure SDOP BODIES:RANKS…   runs `mpirun -n RANKS SDOP run` on uniform scenes, adds to runs.json
    model.py page [--check]               fits what runs.json holds and rewrites the tables of ../many-ranks.md

Counts (ghosts, bytes, migrations) are facts of a scene; seconds are of one machine, and with more ranks than cores they are
those of ranks that take turns: the fit takes seconds from runs with a core a rank alone.
"""
import json, os, re, resource, subprocess, sys, tempfile
from pathlib import Path

HERE = Path(__file__).parent
RUNS = HERE / "runs.json"
PAGE = HERE.parent / "many-ranks.md"
FRAMES = 8
SCENE = """name = "uniform"
seed = 1
seeding = "by-body"
frames = {frames}
dt = 0.016666667
[box]
partners = 1.5
[[bodies]]
shape = "box"
count = {count}
radius = 1.0
speed = [0.5, 2.0]
[effects]
motion = true
walls = "specular"
[cull]
pairs = "grid"
"""
# The reach of a unit ball is 1 but for rounding; a ghost's owner may stand 2w + 2·skin off a cell's faces, skin = w/4.
REACH, SKIN, PARTNERS = 1.0, 0.25, 1.5
# What a cluster is taken to be: seconds a message, bytes a second and rank.
ALPHA, BETA = 5e-6, 1e9


def measure(sdop, jobs):
    runs = json.loads(RUNS.read_text()) if RUNS.exists() else []
    for job in jobs:
        count, ranks = map(int, job.split(":"))
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "uniform.toml"
            scene.write_text(SCENE.format(frames=FRAMES, count=count))
            alone = [sdop, "run", str(scene), "--format", "json"]
            launch = ["mpirun", "--oversubscribe", "--allow-run-as-root", "-n", str(ranks)] if ranks > 1 else []
            child = [sys.executable, __file__, "child", folder]
            done = subprocess.run(launch + child + alone, check=True, stdout=subprocess.PIPE)
            report = json.loads(done.stdout)
            peaks = [int(path.read_text()) for path in sorted(Path(folder).glob("peak-*"))]
        keep = ["bodies", "frames", "simd", "strategy", "finder", "counters", "seconds", "pairs_digest", "ranks"]
        run = {key: report.get(key) for key in keep} | {"cores": os.cpu_count(), "processes": ranks, "peak_bytes": peaks}
        runs = [r for r in runs if (r["bodies"], r["processes"]) != (count, ranks)] + [run]
        runs.sort(key=lambda r: (r["bodies"], r["processes"]))
        RUNS.write_text(json.dumps(runs, indent=1) + "\n")
        print(count, ranks, run["pairs_digest"])


def child(folder, command):
    """Runs one rank and notes the most memory that it held."""
    code = subprocess.run(command).returncode
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024
    (Path(folder) / f"peak-{os.getpid()}").write_text(str(peak))
    sys.exit(code)


def density():
    """Bodies a volume at 1.5 overlaps each: partners = n·(4/3)π(2r)³."""
    return PARTNERS / (4 / 3 * 3.141592653589793 * 8)


def shell(bodies, faces):
    """Bodies in the shell about a cubic cell of so many, as far as its own may reach, over so many of its six faces."""
    side = (bodies / density()) ** (1 / 3)
    width = (2 + 2 * SKIN) * REACH
    return bodies * ((1 + faces / 3 * width / side) ** 3 - 1)


def faces(ranks):
    """Faces that a cell shares with another: halving space once, twice, thrice gives each one more; in a large world all six."""
    return {1: 0, 2: 1, 4: 2, 8: 3}.get(ranks, 6)


def least_squares(rows, values):
    """The x of least |Ax − b|², by the normal equations."""
    n = len(rows[0])
    m = [[sum(r[i] * r[j] for r in rows) for j in range(n)] + [sum(r[i] * v for r, v in zip(rows, values))] for i in range(n)]
    for i in range(n):
        p = max(range(i, n), key=lambda k: abs(m[k][i]))
        m[i], m[p] = m[p], m[i]
        m[i] = [x / m[i][i] for x in m[i]]
        for k in range(n):
            if k != i:
                m[k] = [a - m[k][i] * b for a, b in zip(m[k], m[i])]
    return [row[n] for row in m]


def fit(runs):
    """The constants: a shape factor and bytes from counts of all runs, seconds from runs with a core a rank."""
    lines = [(r, line) for r in runs for line in r["ranks"] or []]
    frames = lambda r: r["frames"]
    pairs = [(shell(l["bodies"], faces(r["processes"])), l["ghosts"] / frames(r)) for r, l in lines]
    constants = {"shape": least_squares([[m] for m, _ in pairs], [g for _, g in pairs])[0]}
    constants["bytes"] = sum(l["ghost_bytes"] for _, l in lines) / sum(l["ghosts"] for _, l in lines)
    constants["renewals"] = sum(l["renewals"] for _, l in lines) / sum(frames(r) for r, _ in lines)
    quiet = [(r, l) for r, l in lines if r["processes"] <= r["cores"]]
    held = [(l["bodies"] + l["ghosts"] / frames(r), l["ghosts"] / frames(r)) for r, l in quiet]
    a_frame = lambda key: [l[key] / frames(r) for r, l in quiet]
    constants["culling"] = least_squares([[h] for h, _ in held], a_frame("culling_seconds"))[0]
    constants["ghosts"] = least_squares([[h] for h, _ in held], a_frame("ghosts"))[0]
    # A renewal's seconds, so that a frame's are those times renewals a frame.
    renewed = [l["migration"] / l["renewals"] for _, l in quiet]
    constants["migration"] = least_squares([[h] for h, _ in held], renewed)[0]
    ours = [r for r in runs if r["processes"] <= r["cores"]]
    constants["effects"] = least_squares(
        [[r["bodies"] / r["processes"]] for r in ours], [r["seconds"]["effects"] / frames(r) for r in ours])[0]
    return constants


def predict(c, bodies, ranks, messages):
    """Milliseconds a frame by term, and ghosts a rank."""
    n = bodies / ranks
    g = c["shape"] * shell(n, faces(ranks))
    terms = {
        "culling": c["culling"] * (n + g),
        "effects": c["effects"] * n,
        "ghosts": c["ghosts"] * (n + g) if ranks > 1 else 0.0,
        "migration": c["renewals"] * c["migration"] * (n + g) if ranks > 1 else 0.0,
        "network": (ALPHA * messages + c["bytes"] * g / BETA) if ranks > 1 else 0.0,
    }
    return {k: 1e3 * v for k, v in terms.items()}, g


def table(header, rows):
    text = lambda cells: "| " + " | ".join(map(str, cells)) + " |\n"
    return text(header) + "|" + "---|" * len(header) + "\n" + "".join(text(row) for row in rows)


def measured(runs):
    rows = []
    for r in runs:
        ranks, frames, s = r["ranks"] or [], r["frames"], r["seconds"]
        mean = lambda key: sum(l[key] for l in ranks) / max(1, len(ranks)) / frames
        ms = lambda key: f"{1e3 * s[key] / frames:.1f}" if key in s else "–"
        rows.append([f"{r['bodies']:,}", r["processes"], f"{mean('ghosts'):,.0f}",
                     f"{mean('ghost_bytes') / max(1, mean('ghosts')):.1f}" if ranks else "–",
                     f"{sum(r['peak_bytes']) / r['bodies']:.0f}", ranks[0]["renewals"] if ranks else "–", *map(ms, ["total", "effects", "ghosts", "migration", "waiting"]),
                     "yes" if r["processes"] <= r["cores"] else "no", f"`{r['pairs_digest'][:8]}`"])
    return table(["bodies", "ranks", "ghosts a rank", "bytes a ghost and frame", "peak bytes a body", "renewals", "culling ms", "effects", "ghosts",
                  "migration", "waiting", "a core a rank", "digest"], rows)


def scaling(c):
    def row(bodies, ranks):
        near, g = predict(c, bodies, ranks, 26)
        far, _ = predict(c, bodies, ranks, ranks)
        total, one = sum(near.values()), sum(predict(c, bodies / ranks, 1, 0)[0].values())
        return [f"{bodies:,.0f}", f"{ranks:,}", f"{bodies / ranks:,.0f}", f"{g:,.0f}", *(f"{x:.2f}" for x in near.values()),
                f"{total:.2f}", f"{one / total:.0%}", f"{sum(far.values()):.2f}"]
    header = ["bodies", "ranks", "bodies a rank", "ghosts a rank", "culling ms", "effects", "ghosts", "migration", "network",
              "T ms", "efficiency", "T ms, all to all"]
    weak = [row(1e6 * r, r) for r in (1, 8, 64, 512, 1000)]
    strong = [row(1e9, r) for r in (256, 1024, 4096, 16384, 65536)]
    return table(header, weak), table(header, strong)


def page(check):
    runs = json.loads(RUNS.read_text())
    c = fit(runs)
    weak, strong = scaling(c)
    units = [("shape", "shell to ghosts", 1, ""), ("bytes", "bytes a ghost and frame", 1, ""), ("renewals", "renewals a frame", 1, ""),
             ("culling", "culling a body held", 1e9, " ns"), ("effects", "effects a body owned", 1e9, " ns"),
             ("ghosts", "ghosts' work a body held", 1e9, " ns"), ("migration", "a renewal, a body held", 1e9, " ns")]
    constants = table(["constant", "fitted"], [[what, f"{c[key] * by:.3g}{unit}"] for key, what, by, unit in units])
    text = PAGE.read_text()
    for name, made in [("measured", measured(runs)), ("constants", constants), ("weak", weak), ("strong", strong)]:
        place = re.compile(rf"(<!-- {name} -->\n).*?(<!-- end -->)", re.S)
        assert place.search(text), f"many-ranks.md has no place for {name}"
        text = place.sub(lambda m: m[1] + made + m[2], text)
    if check:
        sys.exit(0 if text == PAGE.read_text() else "many-ranks.md is not what runs.json says: run model.py page")
    PAGE.write_text(text)


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["measure", sdop, *jobs]:
            measure(sdop, jobs)
        case ["child", folder, *command]:
            child(folder, command)
        case ["page"]:
            page(False)
        case ["page", "--check"]:
            page(True)
        case _:
            sys.exit(__doc__)
