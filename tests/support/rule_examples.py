# SPDX-License-Identifier: Apache-2.0
"""The examples of rules, each in the surroundings that its format needs: what is found in them."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, cast

import yaml
from fleet_folder import planned_fleet
from graph_calls import diagnose, seen_plan
from graph_examples import read_example, read_looks, read_system
from paths import fixture_text, write_files

from multibot_rewrite import RewriteRefused, rewrite_all, strip
from multibot_rewrite.base.findings.finding import SRDF, URDF, XACRO, Finding, Rule
from multibot_rewrite.base.findings.selection import grouped
from multibot_rewrite.base.naming import Policy
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.judged_plan import make_fleet
from multibot_rewrite.fleet.fleet import known_nodes
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.producers.launch.read import read_own
from multibot_rewrite.producers.launch.running import Knowledge
from multibot_rewrite.producers.launch.snapshot import launched
from multibot_rewrite.rules.check import check, judge
from multibot_rewrite.rules.declaration import LAUNCH, SYSTEM
from multibot_rewrite.rules.launch.judge import judge_launch
from multibot_rewrite.rules.settings import Settings

# What every related file file of an example stands beside, unless ``beside`` has another robot.urdf.
DESCRIPTION = fixture_text("rule_examples_description.urdf")
# Format of an example -> its file, and the key of a fleet file that names it.
RELATED_FILES = {
    "params": ("example.yaml", "params"),
    "rviz": ("example.rviz", "rviz"),
    "moveit": ("joint_limits.yaml", "moveit"),
    "tree": ("example.xml", "behavior_trees"),
    "lua": ("example.lua", "lua"),
    "bridge": ("example.yaml", "bridge"),
}
# An option of rules about a file that only a build can ask.
BUILT = "build"
REMAP = ("remap", "remap-urdf")
# What is found in these has no line of a file.
WITHOUT_FILE = (SYSTEM, *REMAP)
POLICY: Policy = {"layout": "frames-per-robot", "affix": "prefix"}
FLEET: dict[str, Any] = {
    **POLICY,
    "robots": [
        {"name": "robot1", "description": "robot.urdf"},
        {"name": "robot2", "description": "robot.urdf"},
    ],
}


def found(
    rule: Rule, example: str, folder: Path, beside: Mapping[str, str] | None = None
) -> list[Finding]:
    """Return what the rule finds in an example, with the files that are beside it (its own by
    default)."""
    write_files(folder, rule.page.beside if beside is None else beside)
    run = beside_example if _is_alone(rule) else RUNNERS[_format(rule)]
    findings = run(rule, example, folder)
    return [it for it in findings if it.code == rule.code]


def is_built(rule: Rule) -> bool:
    """Is a whole fleet built for the examples of the rule?"""
    made = (related_file_example, fleet_example, description_example)
    return not _is_alone(rule) and RUNNERS[_format(rule)] in made


def _is_alone(rule: Rule) -> bool:
    """Is the example a related file file that is linted by itself?"""
    return (
        _format(rule) in RELATED_FILES and rule.code.startswith("MB") and BUILT not in rule.options
    )


def _format(rule: Rule) -> str:
    return next(iter(rule.formats), URDF)


def whole(example: str) -> str:
    """Return the document that an example stands for."""
    if re.match(r"\W*(<\?xml|<robot|<sdf)", example):
        return example
    return f'<robot name="r">{example}</robot>'


def lint_example(rule: Rule, example: str, folder: Path) -> list[Finding]:
    """Return the file of the example, linted with the rule's options."""
    ending = "urdf.xacro" if XACRO in rule.formats or "xmlns:xacro" in example else "urdf"
    ending = "srdf" if rule.formats == (SRDF,) else ending
    file = folder / f"example.{ending}"
    file.write_text(whole(example))
    options: dict[str, Any] = {"roots": (str(folder),), **rule.options}
    if "urdf" in options:
        options["urdf"] = str(folder / options["urdf"])
    options["definitions"] = tuple(str(folder / it) for it in options.get("definitions", ()))
    return lint_file(str(file), Settings(select=(rule.code,), **options))


def beside_example(rule: Rule, example: str, folder: Path) -> list[Finding]:
    """Return the example as a file of a package, with the rule's files beside it."""
    write_files(folder, {"example.yaml": example})
    options: dict[str, Any] = dict(rule.options)
    return lint_file(str(folder / "example.yaml"), Settings(select=(rule.code,), **options))


def rewrite_example(rule: Rule, example: str, folder: Path) -> list[Finding]:
    """Return the example rewritten for ``robots`` of the rule's options, or with ``strip`` taken
    back for that robot; the other options are those of the call."""
    endings = {SRDF: "srdf", XACRO: "urdf.xacro"}
    ending = next((endings[it] for it in rule.formats if it in endings), "urdf")
    file = folder / f"example.{ending}"
    file.write_text(whole(example))
    options: dict[str, Any] = {"robots": ["robot1"], **rule.options}
    if "urdf" in options:
        options["urdf"] = folder / options["urdf"]
    robots, stripped = options.pop("robots"), options.pop("strip", "")
    try:
        if stripped:
            strip(file, stripped, **options)
            return []
        return list(next(iter(rewrite_all(file, robots, **options))).findings)
    except RewriteRefused as refused:
        return list(refused.findings)


def related_file_example(rule: Rule, example: str, folder: Path) -> list[Finding]:
    """Return a fleet of two robots with the example as one of their files."""
    file, key = RELATED_FILES[rule.formats[0]]
    write_files(folder, {file: example})
    named = rule.options.get("related_files", {})
    assert isinstance(named, dict)
    return _fleet(rule, {"related_files": {**named, key: file}}, folder)


def fleet_example(rule: Rule, example: str, folder: Path) -> list[Finding]:
    """Return the findings of the example as a fleet file; what it leaves out is appended."""
    return _fleet(rule, {}, folder, example)


def description_example(rule: Rule, example: str, folder: Path) -> list[Finding]:
    """Return the findings of a fleet whose robots have the example as description."""
    return _fleet(rule, {}, folder, description=example)


def _fleet(
    rule: Rule,
    keys: dict[str, Any],
    folder: Path,
    text: str = "",
    description: str = DESCRIPTION,
) -> list[Finding]:
    """Return what is found in a fleet file of ``text`` and, where it lacks them, ``keys``."""
    if "robot.urdf" not in rule.page.beside:
        write_files(folder, {"robot.urdf": description})
    said = yaml.safe_load(text) or {}
    options = {it: value for it, value in rule.options.items() if it != BUILT}
    more = {it: value for it, value in {**FLEET, **options, **keys}.items() if it not in said}
    write_files(folder, {"fleet.yaml": text + (yaml.safe_dump(more) if more else "")})
    plan = planned_fleet(folder / "fleet.yaml")
    found = [it for it in make_outputs(plan).findings if it.code == rule.code]
    return found or list(plan.fleet.table.problems)


def remap_example(rule: Rule, example: str, folder: Path) -> list[Finding]:
    """Return the findings of the remap table of ``robots`` by their description or file of nodes."""
    nodes = {} if example.startswith("<") else yaml.safe_load(example)["nodes"]
    write_files(folder, {"robot.urdf": DESCRIPTION if nodes else example, "nodes.yaml": example})
    options: dict[str, Any] = {"robots": ["robot1", "robot2"], **POLICY, **rule.options}
    robots = options.pop("robots")
    file = str(folder / "nodes.yaml") if nodes else None
    policy = cast(Policy, options)
    made = make_fleet(
        str(folder / "robot.urdf"), robots, list(nodes), policy, nodes=file, release=NEWEST_LTS
    )
    return grouped(made.table.problems, {it: it for it in robots})


def system_example(rule: Rule, example: str, folder: Path) -> list[Finding]:
    """Return a graph in the lines of ``graph_examples``, and its plan for a rule that asks for one."""
    if "as before: " in example:
        before, graph = read_looks(example)
        return check(seen_plan(diagnose(before)), graph, before=before)
    if rule.options["planned"]:
        return check(*read_example(example))
    return judge(read_system(example))


def launch_example(rule: Rule, example: str, folder: Path) -> list[Finding]:
    """Return a launch file, read without launch."""
    file = folder / "example.launch.py"
    file.write_text(example)
    own = folder / "made"
    own.mkdir()
    graph = read_own(str(file), str(own))
    release = str(rule.options.get("distro", NEWEST_LTS))
    library = known_nodes(None, release, ()).library
    known = Knowledge(library.nodes, load_known_nodes("", release), release)
    return judge_launch(launched(graph, known))


RUNNERS: dict[str, Callable[[Rule, str, Path], list[Finding]]] = {
    **dict.fromkeys((URDF, SRDF, XACRO), lint_example),
    **dict.fromkeys(RELATED_FILES, related_file_example),
    "rewrite": rewrite_example,
    "fleet": fleet_example,
    "fleet-urdf": description_example,
    **dict.fromkeys(REMAP, remap_example),
    SYSTEM: system_example,
    LAUNCH: launch_example,
}
