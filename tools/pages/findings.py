# SPDX-License-Identifier: Apache-2.0
"""The pages of rules: one a code, and the list of all."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby

from multibot_rewrite.base.findings.codes import examples, listed
from multibot_rewrite.base.findings.finding import Rule
from multibot_rewrite.lint.catalogue import declared
from multibot_rewrite.lint.groups import GROUPS
from multibot_rewrite.lint.registry import RULES
from tools.pages.markdown import plain

FOLDER = "findings"
HEAD = """\
# Findings

Every code that a command reports, with what it means, why it matters, how it is mended, and
examples; `multibot inspect CODE` prints one. An *error* stops the job, or cannot work; a *warning*
is very probably wrong and stops it with `--fail-on warning`; a *note* never does. Examples are
tested: the bad one has the finding, the good one does not. A fragment of XML belongs inside `<robot
name="r">`.
"""
LINT = """
# Rules of urdf-lint
"""
OTHERS = """
# Rules of the other commands
"""
TABLE = """
| code | level | name | |
|---|---|---|---|
"""
INTROS = {
    "MG1": """\
`multibot check` and `multibot rehearse` compare a plan with the running graph. A line of an example
begins with `planned:` (in the plan), `running:` (in the graph) or `as planned:` (in both). Whole fleets
with a fault each, and the lines that are printed, are in `fixtures/graphs`.

Where the view of the graph may be incomplete, a finding about something missing is *inconclusive*
instead of an error.

Not reported: further topics of a node below its robot's name; operator topics without a publisher;
tools (RViz, rqt, ros2 CLI, rosbag2, bridges, teleop, containers, Gazebo's own nodes); frames below a
declared link whose names begin like the link's (`camera_link` has `camera_depth_frame`).
""",
    "MG3": """\
`multibot check` finds these in a running system without a plan. All lines of an example begin with
`running:`; the robots are `robot1`, `robot2`.
""",
    "MF6": """\
`multibot build` checks all files once more before it writes them. Each kind of mistake is reported once
for a file, with the number of lines.
""",
}
# What an example is written in -> how a Markdown page colours it; XML where it is not here.
_LANGUAGES = {
    **dict.fromkeys(("params", "rviz", "moveit", "bridge", "fleet", "remap"), "yaml"),
    **dict.fromkeys(("params file", "rviz file", "moveit file", "bridge file"), "yaml"),
    "graph": "text",
    "lua": "lua",
}

# What the rules are about, by how their codes begin.
RULES_OF_LINT = {
    "MB0": "the lint itself",
    "MB1": "file, encoding and values",
    "MB2": "references",
    "MB3": "names",
    "MB4": "several robots",
    "MB5": "structure",
    "MB6": "physics",
    "MB7": "meshes and packages",
    "MB8": "files beside the URDF: SRDF, parameters, RViz, MoveIt, bridges",
    "MB9": "rewriting",
}
# What rules of other commands are about, by how their codes begin.
TITLES = {
    "MB1": "rewriting a description",
    "MF1": "parameter files",
    "MF2": "RViz",
    "MF5": "bridges",
    "MF7": "start poses and spawning",
    "MF8": "what a robot's files say of its nodes",
    "MG1": "not as planned: nodes, names, states",
    "MG2": "not as planned: frames",
    "MG3": "any system: nodes, names, commands, data",
    "MG4": "any system: tf",
    "MG5": "any system: time and states",
    "MG7": "launch files",
    "MR1": "remap tables",
}


def pages() -> dict[str, str]:
    """Path below docs/ -> Markdown."""
    linted = {
        f"{it.start}: {RULES_OF_LINT[it.start]}": [
            rule for code, rule in RULES.items() if code.startswith(it.start)
        ]
        for it in GROUPS
    }
    others = {
        start: (TITLES[start], list(rules))
        for start, rules in groupby(declared(), key=lambda rule: rule.code[:3])
    }
    parts = [HEAD, LINT, *(_group(title, rules) for title, rules in linted.items()), OTHERS]
    parts += [
        _group(f"{start}: {title}", rules, INTROS.get(start, ""))
        for start, (title, rules) in others.items()
    ]
    every = [*linted.values(), *(rules for _, rules in others.values())]
    found = {f"{FOLDER}/{rule.code}.md": _page(rule) for rules in every for rule in rules}
    return {f"{FOLDER}/index.md": "".join(parts), **found}


def _group(title: str, rules: Iterable[Rule], intro: str = "") -> str:
    rows = (
        f"| [{code}]({code}.md) | {level} | {name} | {_cell(what)} |\n"
        for code, level, name, what in listed(rules)
    )
    above = f"\n{intro}" if intro else ""
    return f"\n## {title}\n{above}{TABLE}{''.join(rows)}"


def _page(rule: Rule) -> str:
    return "\n".join(_lines(rule))


def _lines(rule: Rule) -> Iterator[str]:
    yield f"# {rule.code} {rule.name}\n"
    yield f"*{rule.level}*. {plain(rule.what)}\n"
    yield f"**Why.** {plain(rule.why)}\n"
    yield f"**Fix.** {plain(rule.fix)}\n"
    language = next((_LANGUAGES[it] for it in rule.formats if it in _LANGUAGES), "xml")
    for title, example in examples(rule):
        yield f"{title}:\n\n```{language}\n{example.rstrip()}\n```\n"


def _cell(text: str) -> str:
    return plain(text).replace("|", "\\|")
