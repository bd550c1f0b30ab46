"""Sentences for findings: the most likely cause, and what to do about it."""

from __future__ import annotations

from multibot_rewrite.graph.expectation import PlannedEndpoint
from multibot_rewrite.graph.rules.comparison import View
from multibot_rewrite.remap.records import ACTION, CALLS, PUBLISHES, SERVES, SUBSCRIBES
from multibot_rewrite.rosnames import check_topic_name, expand

# What a node does with a name, by the role of its endpoint.
DOES = {
    PUBLISHES: "publishes",
    SUBSCRIBES: "subscribes to",
    SERVES: "offers",
    CALLS: "has a client for",
}


def plugin_of(view: View, node: str) -> tuple[str, str]:
    """The plugin that starts a node, and its place in the description; both empty without one."""
    place = view.places.get(node, "")
    if not place:
        return "", ""
    plain = view.ownership.without_robot(node, view.robot_of.get(node, ""))
    return f"plugin {plain.rpartition('/')[2]}", place


def remap_rule(planned: PlannedEndpoint) -> str:
    """The remap rule that gives the node's name its planned form; empty where none is needed."""
    if not planned.code_name or name_without_rules(planned) == planned.name:
        return ""
    namespace = planned.node.rpartition("/")[0] + "/"
    return f"{planned.code_name}:={planned.name.removeprefix(namespace)}"


def name_without_rules(planned: PlannedEndpoint) -> str:
    """The full name that the name in the node's code has without any remap rule."""
    if check_topic_name(planned.code_name):
        return ""
    namespace, _, node = planned.node.rpartition("/")
    return expand(planned.code_name, namespace or "/", node)


def why_not_remapped(view: View, planned: PlannedEndpoint) -> str:
    """Why a name is still the one in the code, although a rule should remap it."""
    rule = remap_rule(planned)
    plugin, place = plugin_of(view, planned.node)
    if plugin:
        missing = f"remap rule {rule}" if rule else "namespace or remap rule for it"
        return f"{plugin} has no {missing}, see {place}"
    if not rule:
        return "another remap rule, or an absolute name in its parameters, changes it"
    return f"the remap rule {rule} is not applied"


def how_to_remap(view: View, planned: PlannedEndpoint) -> str:
    """How to pass the rule to a node of the stack; empty for a plugin's node, which has a file."""
    rule = remap_rule(planned)
    if not rule or planned.node in view.places:
        return ""
    parts = ", and one rule for each of its _action/ names" if planned.kind == ACTION else ""
    source, _, target = rule.partition(":=")
    launch = f"remappings=[({source!r}, {target!r})] in the launch file"
    return f"; pass it with --ros-args -r {rule}, or with {launch}{parts}"


def why_other_name(view: View, node: str, match: str) -> str:
    """Why a planned node runs under another name, which is ``match``."""
    robot = view.robot_of[node]
    plugin, place = plugin_of(view, node)
    plain = view.ownership.without_robot(node, robot)
    namespaced = node == f"/{robot}{plain}"
    if match not in (plain, f"/{plain.rpartition('/')[2]}"):
        return f"{match} is running; is it this node under another name?"
    if plugin:
        missing = "namespace" if namespaced else "separate name for each robot"
        return f"{match} is running: {plugin} has no {missing}, see {place}"
    if namespaced:
        option = f"namespace={robot!r} in the launch file, or --ros-args -r __ns:=/{robot}"
        return f"{match} is running: it was started without the robot's namespace; use {option}"
    option = f"--ros-args -r __node:={node.rpartition('/')[2]}"
    return f"{match} is running: it was started without the robot's name; use {option}"
