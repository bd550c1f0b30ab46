# SPDX-License-Identifier: Apache-2.0
"""A vendor's robot as its launch files run it, against what is built for it: rows that differ."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from plans import sends
from vendor_rows import (
    Rows,
    bridge_argument,
    bridge_rows,
    description_rows,
    parameter_rows,
    rviz_rows,
    static_edge,
)
from vendor_systems import Vendors, started_by

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.rosnames import (
    BoundNode,
    RemapRule,
    bind,
    check_topic_name,
    parse_remap,
    resolve_bound,
)
from multibot_rewrite.checks.build import Outputs
from multibot_rewrite.fleet.fleet import Fleet
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.planning.of_runs import parsed
from multibot_rewrite.system.records import RUNS, System

DESCRIPTION = "robot_description"
BRIDGES = ("parameter_bridge", "bridge_node")
_LINK = re.compile(r"robot/link\[[^]]*\]@name$")


class Difference(NamedTuple):
    """A value of which vendor and build say something else; ``reason`` is why ours is right."""

    where: str
    vendor: str
    ours: str
    reason: str = ""


class Compared(NamedTuple):
    """How many values are equal, and what differs."""

    equal: int
    differences: tuple[Difference, ...]


class Built(NamedTuple):
    """What is built of a recipe in a layout; ``refused`` says why nothing is."""

    layout: str
    robots: tuple[str, ...]
    fleet: Fleet | None
    plan: System | None
    outputs: Outputs | None
    refused: str = ""

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The warnings and errors of the build."""
        found = self.outputs.findings if self.outputs else ()
        return tuple(it for it in found if it.level != "note")


def compare(built: Built, robot: str, rows: list[dict[str, Any]], vendors: Vendors) -> Compared:
    """Return a robot by its vendor's launch files, and as it is built."""
    theirs: Rows = {}
    ours: Rows = {}
    managers = {it["namespace"]: it for it in rows if it["executable"] == "ros2_control_node"}
    for row in rows:
        for node in started_by(row, vendors.named):
            # Releases in which controllers do not get the rules of their manager are not among these.
            manager = managers.get(node.name.rpartition("/")[0], {})
            source = manager if row["executable"] == "spawner" else row
            if source:
                _node(built, robot, source, node.name, theirs, ours)
    theirs |= {f"node {it}": "runs" for it in _names(rows, vendors)}
    ours |= {f"node {it}": "runs" for it in _planned(built, robot, theirs)}
    same = [it for it in theirs if theirs[it] == ours.get(it)]
    places = [it for it in dict.fromkeys([*theirs, *ours]) if theirs.get(it) != ours.get(it)]
    return Compared(
        len(same), tuple(Difference(it, theirs.get(it, "-"), ours.get(it, "-")) for it in places)
    )


def _planned(built: Built, robot: str, theirs: Rows) -> list[str]:
    """Return the nodes of a robot that have to run by the plan, and those that may and do."""
    nodes = [it for it in built.plan.nodes if it.robot == robot] if built.plan else []
    return [it.name for it in nodes if it.sure == RUNS or f"node {it.name}" in theirs]


def _names(rows: list[dict[str, Any]], vendors: Vendors) -> Iterator[str]:
    for row in rows:
        yield from (it.name for it in started_by(row, vendors.named))


def _node(
    built: Built, robot: str, row: dict[str, Any], name: str, theirs: Rows, ours: Rows
) -> None:
    """Put what vendor and build say of a node into their rows."""
    files = files_of(built, robot)
    values = row.get("values", [])
    inline = parameter_rows([it["text"] for it in values if not it["file"]], name)
    given = parameter_rows([it["text"] for it in values if it["file"]], name)
    mine = parameter_rows([it for path, it in files.items() if path.endswith(".yaml")], name)
    theirs |= {f"{name} parameter {at}": it for at, it in given.items()}
    ours |= {f"{name} parameter {at}": mine[at] for at in given if at in mine}
    urdf = next((it for path, it in files.items() if path.endswith(".urdf")), "")
    # A dock or another thing may have a robot_state_publisher, too.
    if urdf and DESCRIPTION in inline and _same_robot(inline[DESCRIPTION], urdf):
        prefix = inline.get("frame_prefix", "").lstrip("/")
        theirs |= _put("description", description_rows(inline[DESCRIPTION], robot, prefix))
        later = built.layout == "frame-prefix"
        ours |= _put("description", description_rows(urdf, robot, prefix if later else ""))
    if row["executable"] not in BRIDGES:
        _topics(built, row, name, {**given, **inline}, theirs, ours)
    _special(row, name, robot, built, theirs, ours)


def _same_robot(one: str, other: str) -> bool:
    counts = [sum(bool(_LINK.match(at)) for at in description_rows(it, "")) for it in (one, other)]
    return counts[0] == counts[1]


def _put(word: str, rows: Rows) -> Rows:
    return {f"{word} {at}": it for at, it in rows.items()}


def files_of(built: Built, robot: str) -> dict[str, str]:
    """Return the texts of what is built for a robot, by their paths in its folder."""
    files = built.outputs.files if built.outputs else ()
    mine = (it for it in files if it.path.startswith(f"{robot}/"))
    return {it.path.partition("/")[2]: it.data.decode() for it in mine}


def _topics(
    built: Built, row: dict[str, Any], name: str, given: Rows, theirs: Rows, ours: Rows
) -> None:
    """Where the names of a node lead by the vendor's parameters and rules, and by the table."""
    nodes = built.fleet.table.runs if built.fleet else ()
    table = next((it for it in nodes if it.full_name == name), None)
    if table is None or built.fleet is None:
        return
    facts = next((it for it in built.fleet.facts if it.name == table.node), None)
    vendor = bind(table.name, table.namespace, rules_of(row))
    own = bind(table.name, table.namespace, parsed(table.rules))
    for it in facts.endpoints if facts else ():
        if "<" not in it.name and not it.helper:
            kind = "service" if it.kind == "service" else "topic"
            at = f"{name} {it.kind} {it.name}"
            theirs[at] = resolve_bound(_told(it, given), kind, vendor)
            ours[at] = resolve_bound(it.name, kind, own)


def _told(it: Endpoint, given: Rows) -> str:
    """Return an endpoint's name as a parameter has it: an absolute one may have the robot's."""
    told = given.get(it.parameter, "")
    return told if told.startswith("/") and not check_topic_name(told) else it.name


def rules_of(row: Mapping[str, Any]) -> list[RemapRule]:
    """Return the remap rules of a program."""
    found = (parse_remap(f"{old}:={new}") for old, new in row["rules"])
    return [it for it in found if it is not None]


def _special(
    row: dict[str, Any], name: str, robot: str, built: Built, theirs: Rows, ours: Rows
) -> None:
    """Bridges, RViz and static transforms."""
    program = row["executable"]
    if program == "static_transform_publisher":
        theirs[f"{name} sends"] = static_edge(row["own"])
        ours[f"{name} sends"] = sends(built.plan).get(name, "-") if built.plan else "-"
    if program == "rviz2":
        _rviz(row, name, robot, built, theirs, ours)
    if program in BRIDGES:
        _bridge(row, name, files_of(built, robot), theirs, ours)
        _bridge_arguments(row, name, built, theirs, ours)


def _rviz(
    row: dict[str, Any], name: str, robot: str, built: Built, theirs: Rows, ours: Rows
) -> None:
    """Compare the config that the vendor opens with the built one, each under its own rules."""
    vendor = next((it for it in row.get("texts", {}).values()), "")
    namespace = row["namespace"] or "/"
    found = rviz_rows(vendor, bind("rviz2", namespace, rules_of(row)), robot)
    texts = {it.path: it.data.decode() for it in (built.outputs.files if built.outputs else ())}
    windows = [it for it in texts if it.endswith(".rviz")]
    path = next((it for it in windows if it.startswith(f"{robot}/")), next(iter(windows), ""))
    opened = rviz_rows(texts.get(path, ""), _window(texts, path), robot)
    theirs |= {f"{name} rviz {at}": it for at, it in found.items()}
    ours |= {f"{name} rviz {at}": it for at, it in opened.items()}


def _window(texts: Mapping[str, str], path: str) -> BoundNode:
    """How the rviz2 of a config is started by ``commands.md``."""
    lines = texts.get("commands.md", "").splitlines()
    words = next((shlex.split(it) for it in lines if f"rviz2 -d {path}" in it), [])
    rules = dict(it.split(":=", 1) for it in words if ":=" in it)
    namespace = rules.pop("__ns", "/")
    return bind("rviz2", namespace, rules_of({"rules": rules.items()}))


def _bridge(
    row: dict[str, Any], name: str, files: Mapping[str, str], theirs: Rows, ours: Rows
) -> None:
    namespace, _, node = name.rpartition("/")
    bound = bind(node, namespace or "/", rules_of(row))
    given = parameter_rows([it["text"] for it in row["values"]], name)
    pairs = [*bridge_rows(Path(given["config_file"]).read_text())] if "config_file" in given else []
    # The bridge expands the names in the simulator, too, if it is told (parameter_bridge.cpp).
    above = f"{namespace}/" if given.get("expand_gz_topic_names") == "True" else ""
    for topic, what in pairs:
        theirs[f"bridge {resolve_bound(topic, 'topic', bound)}"] = _gz(what, above)
    here = bind("bridge", namespace or "/", [])
    for text in (it for path, it in files.items() if "bridge" in path):
        for topic, what in bridge_rows(text):
            ours[f"bridge {resolve_bound(topic, 'topic', here)}"] = _gz(what, "")


def _bridge_arguments(
    row: dict[str, Any], name: str, built: Built, theirs: Rows, ours: Rows
) -> None:
    """Compare the ROS side of a bridge's arguments: the launch file of the vendor runs it."""
    namespace, _, node = name.rpartition("/")
    bound = bind(node, namespace or "/", rules_of(row))
    ends = built.plan.ends if built.plan else ()
    mine = {it.name for it in ends if it.node == name}
    for topic, _ in (it for it in map(bridge_argument, row["own"]) if it):
        full = resolve_bound(topic, "topic", bound)
        theirs[f"{name} bridges {full}"] = "known"
        ours[f"{name} bridges {full}"] = "known" if full in mine else "-"


def _gz(what: str, above: str) -> str:
    """Return what a bridge passes on, with the slash that Gazebo puts before a topic."""
    return what if what.startswith("/") else f"{above or '/'}{what}"
