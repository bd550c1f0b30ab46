# SPDX-License-Identifier: Apache-2.0
"""A launched domain_bridge -> its nodes, one in each ROS domain, and what each has, by its files.

Source: ros2/domain_bridge c2523e1, process_cmd_line_arguments.hpp (options, then files; ``--from`` and
``--to`` hold for all topics), parse_domain_bridge_yaml_config.cpp (the keys of a file),
domain_bridge.cpp (``get_node_for_domain``, ``bridge_topic``, ``add_bridges``).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any, NamedTuple

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.producers.launch.records import LaunchNote
from multibot_rewrite.spelling.domain_bridge import DOMAIN_BRIDGE
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC, End, Node

_PROGRAM = f"{DOMAIN_BRIDGE}/{DOMAIN_BRIDGE}"
_FROM, _TO = "--from", "--to"
# All options have a value but these.
_FLAGS = ("-h", "--help")


class BridgedDomains(NamedTuple):
    """The nodes that bridges have in ROS domains, their ends, and the files that are not read."""

    nodes: tuple[Node, ...]
    ends: tuple[End, ...]
    notes: tuple[LaunchNote, ...]


def bridged_domains(running: Sequence[Run]) -> BridgedDomains:
    """Return what the domain_bridges among some nodes have besides the node of their process."""
    notes: list[LaunchNote] = []
    nodes: dict[str, Node] = {}
    ends: list[End] = []
    for it in (it for it in running if it.program == _PROGRAM):
        for end in _ends(it, notes):
            ends.append(end)
            node = Node(end.node, it.process, place=it.place, known=DOMAIN_BRIDGE)
            nodes.setdefault(end.node, node)
    return BridgedDomains((*nodes.values(),), (*dict.fromkeys(ends),), (*notes,))


def _ends(it: Run, notes: list[LaunchNote]) -> Iterator[End]:
    """Yield the ends of one bridge. All its files are for one name: the last that has one."""
    options, paths = _words(it.arguments)
    files = [*_read(it, paths, notes)]
    name = [DOMAIN_BRIDGE, *(str(file["name"]) for file in files if file.get("name"))][-1]
    for file in files:
        topics = file.get("topics")
        for topic, row in topics.items() if isinstance(topics, Mapping) else ():
            if isinstance(row, Mapping):
                yield from _of_row(it, name, str(topic), {**file, **row, **options})


def _words(words: Sequence[str]) -> tuple[dict[str, object], list[str]]:
    """Split the arguments of a bridge: the domains that options give, as a file has them; the files."""
    options: dict[str, object] = {}
    paths, left = [], list(words)
    while left:
        word = left.pop(0)
        if not word.startswith("-"):
            paths.append(word)
        elif word not in _FLAGS and left:
            value = left.pop(0)
            if word in (_FROM, _TO):
                options[f"{word[2:]}_domain"] = value
    return options, paths


def _read(it: Run, paths: Sequence[str], notes: list[LaunchNote]) -> Iterator[Mapping[str, Any]]:
    for path in paths:
        try:
            data = load_yaml(read_file(path).decode("utf-8", "replace"), path)
        except (InputError, OSError) as error:
            notes.append(LaunchNote(it.place, f"domain_bridge does not read {path}: {error}"))
            continue
        if isinstance(data, Mapping):
            yield data


def _of_row(it: Run, bridge: str, topic: str, row: Mapping[str, Any]) -> Iterator[End]:
    """Yield both ends of a topic, and those of the way back; of one domain nothing is bridged."""
    domains: tuple[int, ...] = ()
    with suppress(KeyError, TypeError, ValueError):
        domains = (int(row["from_domain"]), int(row["to_domain"]))
    if len({*domains}) < 2:
        return
    ways = [domains[::-1] if row.get("reversed") else domains]
    ways += [ways[0][::-1]] if row.get("bidirectional") else []
    for here, there in ways:
        yield _end(it, f"/{bridge}_{here}", SUBSCRIBES, topic, row)
        yield _end(it, f"/{bridge}_{there}", PUBLISHES, str(row.get("remap") or topic), row)


def _end(it: Run, node: str, role: str, topic: str, row: Mapping[str, Any]) -> End:
    """Return an end of a node in the root namespace, which has no rules."""
    name, type_ = f"/{topic.lstrip('/')}", str(row.get("type", ""))
    return End(TOPIC, role, name, type_, "", node, None, it.process, topic)
