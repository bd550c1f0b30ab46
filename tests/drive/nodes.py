# SPDX-License-Identifier: Apache-2.0
"""The nodes that are started, before their names are resolved: name, rules, parameters, ends."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import gazebo
import programs
import vendors
import yaml

Start = dict[str, Any]
# Programs that put a robot into the simulator, with the option that names it there.
SPAWNERS = {"create": "-name", "spawn_entity.py": "-entity"}
# In a container a costmap has the rules of the process in these; later those of the component that
# makes it (nav2_costmap_2d 1.5.0 src/costmap_2d_ros.cpp, getChildNodeOptions).
BEFORE_HANDED_ON = ("humble", "iron", "jazzy", "kilted")


class Reader(NamedTuple):
    """What is started, and for whom ("" for all robots); ``sources`` are folders of packages."""

    starts: list[tuple[str, Start]]
    release: str
    folder: Path
    sources: tuple[Path, ...] = ()

    def of(self, *executables: str) -> Iterator[tuple[str, Start]]:
        return ((who, it) for who, it in self.starts if it.get("executable") in executables)


class Node(NamedTuple):
    """A node of a robot ("" for all of them) before its names are resolved; ``process`` are the
    namespace and the rules of its process, if they are not its own, ``own`` is whether it is a
    vendor's, which was read."""

    robot: str
    what: str
    name: str
    namespace: str
    rules: tuple[tuple[str, str], ...]
    values: Mapping[str, Any]
    ends: tuple[programs.Opened, ...]
    inside: str = ""
    process: tuple[str, tuple[tuple[str, str], ...]] | None = None
    own: bool = False

    @property
    def fqn(self) -> str:
        return f"{self.namespace.rstrip('/')}/{self.name}"


def nodes_of(given: Reader) -> Iterator[Node]:
    """Yield the nodes of programs and components, and those that they have inside."""
    containers = {
        who: ("/" + it["namespace"].strip("/"), tuple(tuple(rule) for rule in it["rules"]))
        for who, it in given.starts
        if is_container(it)
    }
    for who, it in given.starts:
        if "executable" not in it or it["executable"] in ("spawner", *SPAWNERS):
            continue
        what = programs.node_of(it["executable"])
        rules = [tuple(rule) for rule in it["rules"]] + rules_in(it["arguments"])
        space = dict(rules).get("__ns") or "/" + it["namespace"].strip("/")
        # A rule may be for the one node of a process that its code calls so.
        of_node = dict(rules).get(f"{what}:__node")
        name = dict(rules).get("__node") or it["name"] or of_node or what
        fqn = f"{space.rstrip('/')}/{name}"
        plain = tuple(rule for rule in rules if not rule[0].rpartition(":")[2].startswith("__"))
        values = {**programs.defaults(what, given.release)}
        values |= programs.parameters_of(fqn, sections_of(it))
        values |= {"": it["arguments"]} if it["arguments"] else {}
        ends = tuple(programs.opened(what, values, given.release))
        ends += tuple(programs.muxed(values)) if what == "twist_mux" else ()
        ends += tuple(programs.executed(values)) if what == "move_group" else ()
        process = containers.get(who) if it.get("component") else None
        source = None if programs.is_known(what, given.release) else own_source(it, given)
        if source:
            read = vendors.opened(source, values)
            ends, values = read.ends, {**values, **({"": read.frames} if read.frames else {})}
        yield Node(who, what, name, space, plain, values, ends, process=process, own=bool(source))
        costmap = programs.COSTMAPS.get(what)
        if costmap:
            process = process or (space, plain)
            inner = process[1] if given.release in BEFORE_HANDED_ON else plain
            made = costmap_of(who, it, costmap, space, inner, given.release)
            yield made._replace(process=process)


def own_source(start: Start, given: Reader) -> Path | None:
    package = start.get("package", "")
    return vendors.source_of(package, start["executable"], given.sources) if package else None


def is_container(start: Start) -> bool:
    return str(start.get("executable", "")).startswith("component_container")


def costmap_of(who: str, start: Start, name: str, space: str, rules: Any, release: str) -> Node:
    below = f"{space.rstrip('/')}/{name}"
    values = programs.parameters_of(f"{below}/{name}", sections_of(start))
    ends = (
        *programs.opened(f"{name}/{name}", values, release),
        *programs.costmap_sources(values, release),
    )
    kept = tuple(
        it for it in ends if "observation" not in it.name and "." not in it.name.replace("../", "")
    )
    return Node(
        who, name, name, below, rules, values, kept, inside=programs.node_of(start["executable"])
    )


def plugin_nodes(roots: Mapping[str, Any], models: Mapping[str, str]) -> list[Node]:
    """Return the nodes that Classic's plugins are."""
    return [
        Node(
            who,
            it.file,
            it.name,
            it.namespace,
            it.rules,
            {"": it.frames},
            tuple(programs.Opened(*end) for end in it.ends),
        )
        for who, root in roots.items()
        if who in models
        for it in gazebo.classic_plugins(root)
    ]


def sections_of(start: Start) -> list[Mapping[str, Any]]:
    """Return the parameters of a start: files as they are, values under ""."""
    found: list[Mapping[str, Any]] = []
    for it in start.get("parameters", ()):
        if set(it) == {""}:
            path = Path(it[""])
            found.append(yaml.safe_load(path.read_text()) or {} if path.is_file() else {})
        else:
            found.append({"": it})
    return found


def rules_in(arguments: list[str]) -> list[tuple[str, str]]:
    """Remap rules among a program's arguments."""
    words = iter(arguments)
    given = [next(words) for it in words if it in ("-r", "--remap")]
    return [(old, new) for old, _, new in (it.partition(":=") for it in given)]
