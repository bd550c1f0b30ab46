# SPDX-License-Identifier: Apache-2.0
"""The page of vendors' robots, docs/contributing/robots.md.

    python benchmarks/vendor_pages.py [ROBOT ...]    print some robots, with all that differs
    python benchmarks/vendor_pages.py --write        write the page

MULTIBOT_SOURCES as in ``vendor_systems.py``. Needs launch, launch_ros and rclpy.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "support"))
from vendor_arm_pages import ARMS, told_of_arms
from vendor_compare import Built, Difference
from vendor_live import Told, said, told
from vendor_recipes import ROBOTS, Outcome, Recipe, false_findings, is_true, outcome, read_recipes
from vendor_sources import WITHOUT, sources_folder
from vendor_systems import read_vendors

PAGE = Path(__file__).parent.parent / "docs" / "contributing" / "robots.md"
_WIDE = 60
# Where packages are for a comparison.
_INSTALLED = re.compile(r"/tmp/\w+/prefix")
HEAD = """\
# Vendors' robots as they ship

Made by `MULTIBOT_SOURCES=FOLDER python benchmarks/vendor_pages.py --write`.
Each robot is built from its vendor's own files, in the vendor's
layout and one other, with two robots and with three. Its first two are compared with what the vendor's
own launch files and generators make of two robots: descriptions, parameters, names of nodes, where
topics, services and actions lead, bridges, static transforms, and RViz by displays and tools, with
topics as they are called in the graph. *Better* is a difference that has a reason, *wrong* any other:
`python benchmarks/vendor_pages.py ROBOT` prints them. *False* are warnings and errors of the build that
are not true of the vendor's files. Which nodes are known is in [vendors](vendors.md).

In a workspace that has the vendor's packages, with the fleet file of a robot:

    multibot build fleet.yaml -o fleet/
    multibot rehearse fleet.yaml
    multibot check fleet/plan.yaml

*Before* is what was false in the vendor's layout before the package knew these robots.
Every build is written; where not, the layout says so, for two robots and for three.

| robot | before | vendor's layout | other layout | equal | better | wrong |
|---|---|---|---|--:|--:|--:|\
"""
SAID = """
## What is said

Warnings and errors of `build`, of `rehearse`, which starts a stand-in for every node on a real graph,
and of `check` of that graph against the plan that was built, each once for all robots: of two robots,
and of three where that differs. *False* counts those that are not true.
What is equal of [arms](arms.md) is on their page.

| robot | layout | build | rehearse | check | false |
|---|---|--:|--:|--:|--:|\
"""


def section(found: Outcome, revisions: Mapping[str, str], uses: list[str], whole: bool) -> str:
    """Return the section of a robot: its fleet file, ``whole`` with the differences and findings."""
    it = found.recipe
    lines = ["", f"## {it.title}", "", it.about.strip(), ""]
    lines += ["```yaml", plain_paths(found.text).rstrip(), "```", ""]
    lines += [f"Build it with `shape: {it.shape}`.", ""] if it.shape else []
    if whole:
        lines += [f"Sources: {', '.join(revisions[use] for use in uses)}.", "", verdict(found), ""]
        lines += [*_reasons(found), *_findings(found)]
    return "\n".join(lines).rstrip() + "\n"


def plain_paths(text: str) -> str:
    """A fleet file with paths as a user has them."""
    return text.replace("{sources}/", "src/").replace("{work}/", "")


def verdict(found: Outcome) -> str:
    """The figures of a comparison in a line."""
    better = [it for it in found.compared.differences if it.reason]
    wrong = [it for it in found.compared.differences if not it.reason]
    counts = f"{found.compared.equal} values are equal, {len(better)} better, {len(wrong)} wrong"
    return f"Against the vendor's two robots {counts}."


def _reasons(found: Outcome) -> Iterator[str]:
    alike: dict[str, list[Difference]] = {}
    for it in found.compared.differences:
        if ROBOTS[1] not in it.where or it.reason:
            alike.setdefault(it.reason, []).append(it)
    yield from (
        ("| where | vendor | here | values | why |", "|---|---|---|--:|---|") if alike else ()
    )
    for reason, rows in alike.items():
        first = rows[0]
        shown = [f"`{_short(it)}`" for it in first[:3]]
        yield f"| {' | '.join(shown)} | {len(rows)} | {reason or '**wrong**'} |"
    yield ""


def _short(text: str) -> str:
    text = _INSTALLED.sub("/ws/install", text.replace("|", "/"))
    return text if len(text) <= _WIDE else f"{text[: _WIDE // 2]}...{text[-_WIDE // 2 :]}"


def _findings(found: Outcome) -> Iterator[str]:
    told = {it.code for built in found.built for it in built.findings}
    told |= {it.code for look in found.looked for it in (*look.rehearsed, *look.checked)}
    said = {it["code"]: it["reason"] for it in found.recipe.right if it["code"] in told}
    yield from ("What is said of the vendor's files, and is right:", "") if said else ()
    yield from (f"- {code}: {reason}" for code, reason in said.items())


def tables(found: Mapping[str, Outcome], arms: Mapping[str, Sequence[Told]]) -> str:
    """The head of the page: the tables of all robots."""
    rows = [HEAD, *(_row(it) for it in found.values()), SAID]
    rows += [line for it in found.values() for line in said_rows(it.recipe.title, told_of(it))]
    rows += [line for name, it in arms.items() for line in said_rows(ARMS[name], it)]
    return "\n".join([*rows, ""])


def told_of(found: Outcome) -> list[Told]:
    """What is said of each build of a recipe."""
    true = partial(is_true, found.recipe)
    return [
        told(built.layout, said(built.findings, built.robots), looked, true)
        for built, looked in zip(found.built, found.looked, strict=True)
    ]


def said_rows(title: str, every: Sequence[Told]) -> Iterator[str]:
    """Yield a row a layout: what build, rehearsal and check say of two robots and of three."""
    for two, three in zip(every[::2], every[1::2], strict=True):
        both = [_both(*pair) for pair in zip(two.numbers, three.numbers, strict=True)]
        false = two.false + three.false
        yield f"| {' | '.join(map(str, (title, two.layout, *both, false)))} |"


def _both(two: object, three: object) -> str:
    """Return what two robots have, and what three have if that differs."""
    return f"{two}" if two == three else f"{two}, {three}"


def _anchor(title: str) -> str:
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def _row(it: Outcome) -> str:
    better = sum(bool(row.reason) for row in it.compared.differences)
    wrong = len(it.compared.differences) - better
    builds = [_built(it.recipe, one) for one in it.built]
    layouts = [
        layout + ("" if (own := _both(*pair)) == "yes" else f": {own}")
        for layout, *pair in zip(it.recipe.layouts, builds[::2], builds[1::2], strict=True)
    ]
    cells = [
        f"[{it.recipe.title}](#{_anchor(it.recipe.title)})",
        it.recipe.before,
        *layouts,
    ]
    return f"| {' | '.join(map(str, [*cells, it.compared.equal, better, wrong]))} |"


def _built(recipe: Recipe, it: Built) -> str:
    if it.refused:
        return "refused"
    false = len(false_findings(recipe, it))
    return f"yes, {false} false" if false else "yes"


def main(words: list[str]) -> int:
    """Print the sections of some robots, or the page of all; or write that."""
    folder = sources_folder()
    if folder is None:
        print(WITHOUT, file=sys.stderr)
        return 2
    vendors, recipes = read_vendors(), read_recipes()
    names = [it for it in words if not it.startswith("--")] or list(recipes)
    found = {it: outcome(recipes[it], vendors, folder, live=True) for it in names}
    whole = len(found) == len(recipes)
    text = tables(found, told_of_arms(folder)) if whole else ""
    for it in found.values():
        uses = vendors.systems[it.recipe.system]["uses"]
        text += section(it, vendors.sources, uses, whole=not whole)
    if whole and "--write" in words:
        PAGE.write_text(text)
    else:
        print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
