# SPDX-License-Identifier: Apache-2.0
"""Measure parameter files against other ways to namespace them: ratios, taken in pairs in one run.

python benchmarks/bench_params.py [FILE]            print the table
python benchmarks/bench_params.py [FILE] --write    and put it into docs/contributing/measurements.md

FILE is a Nav2 parameter file; without one, Nav2's own is looked for in the corpus.
"""

from __future__ import annotations

import gc
import os
import sys
import tempfile
from functools import partial
from pathlib import Path

import yaml
from one_page import write_section
from pairs import HOW, MACHINE, Row, paired, seconds, table

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.knowledge.node_sets import load_node_set
from multibot_rewrite.related_files.context import Context, fill_template, make_context
from multibot_rewrite.related_files.params.rewrite import rewrite_params
from multibot_rewrite.related_files.yaml_text import read_yaml

ROOT = Path(__file__).parent.parent
NAV2 = "nav2_params/ros-navigation+navigation2/nav2_bringup__params__nav2_params.yaml"
FILE = ROOT.parent / "shared" / "corpus" / NAV2
DECLARED: dict[str, dict[str, None]] = {
    "link": dict.fromkeys(("base_link", "base_footprint", "base_scan")),
    **{kind: {} for kind in ("joint", "model", "group", "frame", "sensor")},
}


def context(layout: str, affix: str) -> Context:
    """Nav2 on a robot of three links."""
    naming = make_naming(layout=layout, affix=affix)
    return make_context(DECLARED, naming, load_node_set("nav2", NEWEST_LTS), distro=NEWEST_LTS)  # type: ignore[arg-type]


def first(data: bytes, setting: Context) -> str:
    """Return a file for its first robot."""
    related_file = rewrite_params(read_yaml(data, "nav2_params.yaml"), setting)
    return fill_template(related_file.template, "robot1", "robot1")


def load_and_dump(data: bytes) -> str:
    """Return what nav2_common's RewrittenYaml does: load, put a key on top, dump; both in Python."""
    return yaml.dump({"robot1": yaml.safe_load(data)})


def raw_write(data: bytes, path: str) -> None:
    """Write the file unchanged to the disk."""
    with open(path, "wb") as file:
        file.write(data)


def rows(data: bytes) -> list[Row]:
    """All measurements."""
    l2, l4 = context("L2", "prefix"), context("L4", "postfix")
    template = rewrite_params(read_yaml(data, "nav2_params.yaml"), l2).template
    again, composed = "fill(template)", "yaml.compose, which reads it"
    second = partial(fill_template, template, "robot2", "robot2")
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "raw.yaml")
        return [
            Row("first robot, L2", "PyYAML load and dump (RewrittenYaml)",
                paired(lambda: first(data, l2), lambda: load_and_dump(data)), "0.1"),
            Row("first robot, L4", "PyYAML load and dump (RewrittenYaml)",
                paired(lambda: first(data, l4), lambda: load_and_dump(data)), "0.1"),
            Row("first robot, L2", composed,
                paired(lambda: first(data, l2), lambda: read_yaml(data, "x"), 40), ""),
            Row(f"each further robot: {again}", "first robot",
                paired(second, lambda: first(data, l2), 40), "0.1"),
            Row("first robot, L2", "a raw write of the file",
                paired(lambda: first(data, l2), lambda: raw_write(data, path), 40), ""),
            Row(f"each further robot: {again}", "a raw write of the file",
                paired(second, lambda: raw_write(data, path), 40), "1"),
        ]  # fmt: skip


def least(data: bytes, runs: int = 200) -> float:
    """Milliseconds for a file's first robot, at best: other work on the machine aside."""
    setting = context("L2", "prefix")
    gc.collect()
    return 1000 * min(seconds(lambda: first(data, setting)) for _ in range(runs))


def page(data: bytes) -> str:
    """Return the page as Markdown."""
    lines = data.count(b"\n")
    return f"""# Benchmark of parameter files

Made by `python benchmarks/bench_params.py --write` in one run, on Nav2's own file of {lines} lines:
{HOW}. {MACHINE}.
What is known of nodes is loaded before.

{table(rows(data))}
At best {least(data):.1f} ms for the first robot, in process (goal: 3 ms).
"""


def main(arguments: list[str]) -> None:
    """Print the page, or write it."""
    paths = [it for it in arguments if not it.startswith("-")]
    path = Path(paths[0]) if paths else FILE
    if not path.exists():
        sys.exit(f"{path}: there is no such file; name a Nav2 parameter file")
    text = page(path.read_bytes())
    print(text)
    if "--write" in arguments:
        write_section(text)


if __name__ == "__main__":
    main(sys.argv[1:])
