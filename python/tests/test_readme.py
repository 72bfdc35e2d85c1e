"""Every block of Python in the README runs, one after the other; and the examples in docstrings."""

import doctest
import re
from pathlib import Path

import sdop


def test_blocks_of_the_readme_run(monkeypatch):
    here = Path(__file__).resolve().parent.parent
    monkeypatch.chdir(here.parent)
    blocks = re.findall(r"```python\n(.*?)```", (here / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    names = {}
    for block in blocks:
        exec(compile(block, "README.md", "exec"), names)
    assert len(blocks) == 8 and names["pairs"].tolist() == [[0, 1]]
    assert names["near"].tolist() == [[0, names["a"]], [0, names["b"]]]
    assert names["hits"].tolist() == [[0, names["a"]]] and 0 < names["at"][0] < 0.5
    assert names["bodies"].tolist() == [[names["c"], names["d"]]] and names["numbers"].tolist() == [[1, 0]]
    assert names["found"].tolist() == [[names["left"], names["right"]]] and names["images"].tolist() == [[-1, 0, 0]]
    assert {row["metric"] for row in names["quality"]} >= {"precision", "time"} and len(names["prices"]) > 10


def test_examples_in_docstrings_hold():
    failed, tried = doctest.testmod(sdop)
    assert tried > 0 and failed == 0
