"""Sentences: the most likely cause of what is found, and what to do about it."""

from __future__ import annotations

from collections.abc import Iterable

from multibot_rewrite.graph.expectation import Wanted
from multibot_rewrite.graph.rules.comparison import View
from multibot_rewrite.remap.records import ACTION
from multibot_rewrite.rosnames import check_topic_name, expand

SHOWN = 3


def some(names: Iterable[str]) -> str:
    """The first names of a list, and how many more there are."""
    there = list(dict.fromkeys(names))
    more = f" and {len(there) - SHOWN} more" if len(there) > SHOWN else ""
    return ", ".join(there[:SHOWN]) + more


def plugin(view: View, node: str) -> tuple[str, str]:
    """The plugin of the description that a node is, and its place; empty where it is none."""
    place = view.places.get(node, "")
    if not place:
        return "", ""
    bare = view.owners.bare(node, view.robot_of.get(node, ""))
    return f"plugin {bare.rpartition('/')[2]}", place


def rule(wanted: Wanted) -> str:
    """The remap rule that leads a node's name where the plan has it; empty where none is needed."""
    if not wanted.asked or unremapped(wanted) == wanted.name:
        return ""
    namespace = wanted.node.rpartition("/")[0] + "/"
    return f"{wanted.asked}:={wanted.name.removeprefix(namespace)}"


def unremapped(wanted: Wanted) -> str:
    """Where the name in the node's code leads without any rule."""
    if check_topic_name(wanted.asked):
        return ""
    namespace, _, node = wanted.node.rpartition("/")
    return expand(wanted.asked, namespace or "/", node)


def no_rule(view: View, wanted: Wanted) -> str:
    """Why a name is what the code asks for, though a rule was to move it."""
    text = rule(wanted)
    which, place = plugin(view, wanted.node)
    if which:
        lacks = f"rule {text}" if text else "namespace or rule for it"
        return f"{which} has no {lacks}: see {place}"
    if not text:
        return "a rule of its own or an absolute name in its parameters moves it"
    return f"its rule {text} did not reach it"


def how_to_give(view: View, wanted: Wanted) -> str:
    """How a stack's node gets its rule; empty where it is not the command line's."""
    text = rule(wanted)
    if not text or wanted.node in view.places:
        return ""
    parts = " and one for each of its _action/ names" if wanted.kind == ACTION else ""
    source, _, target = text.partition(":=")
    return f"; give --ros-args -r {text}, or remappings=[({source!r}, {target!r})]{parts}"


def not_named(view: View, node: str, stand_in: str) -> str:
    """Why a planned node is there under another name."""
    robot = view.robot_of[node]
    which, place = plugin(view, node)
    bare = view.owners.bare(node, robot)
    namespaced = node == f"/{robot}{bare}"
    if stand_in not in (bare, f"/{bare.rpartition('/')[2]}"):
        return f"{stand_in} is there: is it that one, under another name?"
    lacks = "namespace" if namespaced else "name of its own for each robot"
    if which:
        return f"{stand_in} is there: {which} has no {lacks}, see {place}"
    if namespaced:
        given = f"namespace={robot!r} in the launch file, or --ros-args -r __ns:=/{robot}"
        return f"{stand_in} is there: it was started without the robot's namespace; give {given}"
    given = f"--ros-args -r __node:={node.rpartition('/')[2]}"
    return f"{stand_in} is there: it was started without the robot's name; give {given}"
