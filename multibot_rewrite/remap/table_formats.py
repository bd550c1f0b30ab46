"""A remap table as text: one function for each output format."""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable, Iterator
from xml.sax.saxutils import escape

from multibot_rewrite.releases import facts_of_release
from multibot_rewrite.remap.records import NodeTable, Table

EVERY_ROBOT = "all robots"
# What programs read of a finding about the table.
OF_A_PROBLEM = ("code", "level", "robot", "node", "message", "hint")


def ros_args(table: Table) -> str:
    """One line for each node: the arguments of ``ros2 run PACKAGE EXECUTABLE``."""
    return _comment(table) + "".join(_ros_args(node) for node in table.nodes)


def _comment(table: Table) -> str:
    """A line that says whose facts the table rests on, for shells and Python."""
    return f"# Facts of {table.release}\n" if table.release and table.nodes else ""


def _ros_args(node: NodeTable) -> str:
    line = shlex.join(arguments(node)) or "(no rule)"
    return f"# {node.robot or EVERY_ROBOT}: {node.node}\n{line}\n"


def arguments(node: NodeTable) -> list[str]:
    """The arguments after the node's executable; empty if none are needed."""
    words = [f"{rule.source}:={rule.target}" for rule in node.rules]
    placed = [f"__ns:={node.namespace}"] if node.namespace != "/" else []
    named = [f"__node:={node.name}"] if node.name != node.node.rpartition("/")[2] else []
    given = [text for word in (*placed, *named, *words) for text in ("-r", word)]
    return ["--ros-args", *given] if given else []


def launch(table: Table) -> str:
    """Python for a launch file: robot -> node -> the arguments of ``launch_ros.actions.Node``."""
    rows = [
        _comment(table),
        "# Arguments of nodes, by robot and node: Node(**NODES[robot][node], package=..., ...)\n",
    ]
    rows.append("NODES = {\n")
    for robot, nodes in _by_robot(table):
        rows.append(f"    {robot!r}: {{\n")
        for node in nodes:
            pairs = [(rule.source, rule.target) for rule in node.rules]
            rows += [
                f"        {node.node!r}: {{\n",
                f'            "namespace": {node.namespace!r},\n',
                f'            "name": {node.name!r},\n',
                f'            "remappings": {pairs!r},\n',
                "        },\n",
            ]
        rows.append("    },\n")
    return "".join([*rows, "}\n"])


def as_data(table: Table) -> dict[str, object]:
    """The table as plain data, as in the YAML and JSON formats."""
    return {
        "layout": table.layout,
        "distro": table.release,
        "robots": {
            robot: {
                node.node: {
                    "namespace": node.namespace,
                    "name": node.name,
                    "remappings": [[rule.source, rule.target] for rule in node.rules],
                }
                for node in nodes
            }
            for robot, nodes in _by_robot(table)
        },
        "names": [
            {
                "robot": name.robot,
                "node": name.node,
                "kind": name.endpoint.kind,
                "role": name.endpoint.role,
                "asked": name.endpoint.name,
                "name": name.name,
            }
            for name in table.names
        ],
        "problems": [{key: getattr(it, key) for key in OF_A_PROBLEM} for it in table.problems],
    }


def as_json(table: Table) -> str:
    """JSON of ``as_data``."""
    return json.dumps(as_data(table), indent=1) + "\n"


def as_yaml(table: Table) -> str:
    """YAML of ``as_data``."""
    import yaml

    return str(yaml.safe_dump(as_data(table), sort_keys=False, width=100))


def gazebo(table: Table) -> str:
    """``<ros>`` blocks for Gazebo Classic and gz_ros2_control plugins, one for each node."""
    blocks = [f"<!-- Facts of {table.release} -->\n"] * bool(table.release)
    for node in table.nodes:
        rows = [f"  <namespace>{escape(node.namespace)}</namespace>"] * (node.namespace != "/")
        rows += [
            f"  <remapping>{escape(f'{rule.source}:={rule.target}')}</remapping>"
            for rule in node.rules
        ]
        if rows:
            comment = f"<!-- {node.robot or EVERY_ROBOT}: {node.node} -->"
            blocks.append("\n".join([comment, "<ros>", *rows, "</ros>"]) + "\n")
    return "".join(blocks)


def markdown(table: Table) -> str:
    """One Markdown table for each robot."""
    parts = [f"# Remap table, layout {table.layout}{facts_of_release(table.release)}\n"]
    for robot, nodes in _by_robot(table):
        parts.append(f"\n## {robot}\n\n| node | runs as | rule |\n|---|---|---|\n")
        for node in nodes:
            runs = f"{node.namespace.rstrip('/')}/{node.name}"
            rules = [f"`{rule.source}` -> `{rule.target}`" for rule in node.rules] or [""]
            parts += [f"| {node.node} | `{runs}` | {rule} |\n" for rule in rules]
    return "".join(parts)


def _by_robot(table: Table) -> Iterator[tuple[str, list[NodeTable]]]:
    """Nodes by robot; nodes for all robots are under a name that no robot can have."""
    for robot in dict.fromkeys(node.robot for node in table.nodes):
        yield robot or EVERY_ROBOT, [node for node in table.nodes if node.robot == robot]


FORMS: dict[str, Callable[[Table], str]] = {
    "ros-args": ros_args,
    "launch": launch,
    "yaml": as_yaml,
    "json": as_json,
    "gazebo": gazebo,
    "markdown": markdown,
}
