# SPDX-License-Identifier: Apache-2.0
"""A remap table as text: one function for each output format."""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable, Iterator
from math import inf

from multibot_rewrite.base.loose_xml import ESCAPES
from multibot_rewrite.planning.records import Table
from multibot_rewrite.planning.ways import (
    Delivery,
    Started,
    arguments,
    deliveries,
    key_of,
    launch_arguments,
    rules_by_taker,
    started,
)
from multibot_rewrite.system.records import COMPONENT, HOST, PLUGIN, PROCESS, SPAWNER

EVERY_ROBOT = "all robots"
# What programs read of a finding about the table.
OF_A_PROBLEM = ("code", "level", "robot", "node", "message", "hint")


def ros_args(table: Table) -> str:
    """Return a line for each process with the arguments of ``ros2 run PACKAGE EXECUTABLE``.

    A controller has those of its spawner, a component those of ``ros2 component load``."""
    text = _release_comment(table)
    for it in started(table):
        by = f" ({it.way})" if it.way != PROCESS else ""
        line = shlex.join(arguments(it)) or "(no rule)"
        text += f"# {it.node.robot or EVERY_ROBOT}: {it.node.node}{by}\n{line}\n"
    return text


def _release_comment(table: Table) -> str:
    """Return a line with the release of the table, for shells and Python."""
    return f"# ROS 2 {table.release}\n" if table.runs else ""


def launch(table: Table) -> str:
    """Return Python for a launch file: robot -> node -> arguments, by what is started for the nodes."""
    found = list(started(table))
    return _release_comment(table) + "".join(_python_table(found, *it) for it in _LAUNCH)


_LAUNCH = (
    (PROCESS, "NODES", "nodes", "Node", "package=..., "),
    (COMPONENT, "COMPONENTS", "components", "ComposableNode", "package=..., "),
    (SPAWNER, "SPAWNERS", "spawners of controllers", "Node", ""),
)


def _python_table(found: list[Started], way: str, name: str, *words: str) -> str:
    """Return a dictionary as Python: robot -> node -> arguments; empty without rows."""
    what, action, package = words
    rows = [
        f"# Arguments of {what}, by robot and node: {action}(**{name}[robot][node], {package}...)\n"
    ]
    rows.append(f"{name} = {{\n")
    own = [it for it in found if it.way == way]
    if not own and way != PROCESS:
        return ""
    for robot in dict.fromkeys(it.node.robot for it in own):
        rows.append(f"    {(robot or EVERY_ROBOT)!r}: {{\n")
        for it in (it for it in own if it.node.robot == robot):
            rows.append(f"        {it.node.node!r}: {{\n")
            for key, value in launch_arguments(it).items():
                rows.append(f"            {json.dumps(key)}: {value!r},\n")
            rows.append("        },\n")
        rows.append("    },\n")
    return "".join([*rows, "}\n"])


def as_data(table: Table) -> dict[str, object]:
    """Return the table as plain data, as in the YAML and JSON formats."""
    return {
        "layout": table.layout,
        "distro": table.release,
        "robots": {
            robot: {
                it.node.node: {
                    "namespace": it.node.namespace,
                    "name": it.node.name,
                    "way": it.way,
                    "at": it.taker,
                    "remappings": [list(pair) for pair in it.rules],
                }
                for it in given
            }
            for robot, given in standing_by_robot(table)
        },
        "names": [
            {
                "robot": run.robot,
                "node": run.full_name,
                "kind": end.kind,
                "role": end.role,
                "asked": end.name,
                "name": name,
            }
            for run, end, name in table.ends
        ],
        "problems": [{key: getattr(it, key) for key in OF_A_PROBLEM} for it in table.problems],
    }


def as_json(table: Table) -> str:
    """Return JSON of ``as_data``."""
    return json.dumps(as_data(table), indent=1) + "\n"


def as_yaml(table: Table) -> str:
    """Return YAML of ``as_data``."""
    import yaml

    return str(yaml.safe_dump(as_data(table), sort_keys=False, width=inf))


def gazebo(table: Table) -> str:
    """Return ``<ros>`` blocks for Gazebo Classic and gz_ros2_control plugins, one for each node."""
    blocks = [f"<!-- ROS 2 {table.release} -->\n"] * bool(table.release)
    for node in table.runs:
        rows = [f"  <namespace>{node.namespace.translate(ESCAPES)}</namespace>"] * (
            node.namespace != "/"
        )
        rows += [
            f"  <remapping>{f'{source}:={target}'.translate(ESCAPES)}</remapping>"
            for source, target in node.rules
        ]
        if rows:
            comment = f"<!-- {node.robot or EVERY_ROBOT}: {node.node} -->"
            blocks.append("\n".join([comment, "<ros>", *rows, "</ros>"]) + "\n")
    return "".join(blocks)


def given_to(it: Delivery) -> str:
    """Return where the rules of a node go, for people."""
    if it.way == HOST:
        return f"process of {it.taker}"
    return {PROCESS: "its process", SPAWNER: "its spawner", PLUGIN: "its plugin"}.get(
        it.way, it.way
    )


def standing_by_robot(table: Table) -> Iterator[tuple[str, list[Delivery]]]:
    """Yield by robot, or EVERY_ROBOT, where rules go: all rules of a process, with its taker."""
    given = deliveries(table)
    rules = rules_by_taker(given)
    each = {key_of(it.node): it for it in reversed(given)}
    whole = [
        it._replace(rules=rules.get((it.node.robot, it.taker), it.rules))
        if it.taker == it.node.node
        else it
        for it in reversed(each.values())
    ]
    for robot in dict.fromkeys(it.node.robot for it in whole):
        yield robot or EVERY_ROBOT, [it for it in whole if it.node.robot == robot]


FORMS: dict[str, Callable[[Table], str]] = {
    "ros-args": ros_args,
    "launch": launch,
    "yaml": as_yaml,
    "json": as_json,
    "gazebo": gazebo,
}
