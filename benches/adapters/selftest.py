"""Does an adapter speak the wire? `python selftest.py COMMAND [CLAIM] [--cases DIR]`; the claim is
aabb unless given.

Two cases in one process: three cubes of which two overlap, then a second frame in which one goes
and another comes. Every line is checked by wire.schema.json, and every case in DIR with it. Exit
code 1 where an answer is wrong.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import jsonschema

parser = argparse.ArgumentParser()
parser.add_argument("command")
parser.add_argument("claim", nargs="?", default="aabb")
parser.add_argument("--cases", type=Path)
arguments = parser.parse_args()
SCHEMA = jsonschema.Draft202012Validator(json.loads(Path(__file__).with_name("wire.schema.json").read_text()))
CUBE = {"name": "cube", "vertices": [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], "ball": [0, 0, 0, 1.75]}
CUBE["triangles"] = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
CUBE["ordop"] = {"k": 6, "basis": [1, 0, 0, 0, 1, 0, 0, 0, 1], "lo": [-1, -1, -1], "hi": [1, 1, 1]}


def frame(number, places, **more):
    boxes = {"boxes": [[x - 1, -1, -1, x + 1, 1, 1] for x in places]} if arguments.claim == "aabb" else {}
    return {"frame": number, "poses": [[0, 0, 0, 1, x, 0, 0] for x in places], **boxes, **more}


body = {"shape": 0, "static": False}
head = {"format": "sdop-record", "version": 1, "scene": "selftest", "shapes": [CUBE], "bodies": [body] * 3, "claims": [arguments.claim]}
changed = [{**body, "was": 2}, {**body, "was": 0}, body]
lines = [head, frame(0, [0, 1, 9]), head, frame(0, [0, 8, 9]), frame(1, [9, 0, 10], bodies=changed)]
expected = [[[0, 1]], [[1, 2]], [[0, 2]]]

run = subprocess.run(arguments.command, shell=True, input="".join(json.dumps(line) + "\n" for line in lines), text=True, stdout=subprocess.PIPE)
answers = [json.loads(line) for line in run.stdout.splitlines()]
given = [json.loads(line) for case in sorted(arguments.cases.rglob("*.ndjson")) for line in case.open()] if arguments.cases else []
for line in [*lines, *answers, *given]:
    SCHEMA.validate(line)
pairs = [sorted(answer.get("pairs", [answer.get("skipped")])) for answer in answers]
print("right" if pairs == expected and run.returncode == 0 else f"exit code {run.returncode}, {pairs} instead of {expected}")
sys.exit(pairs != expected or run.returncode != 0)
