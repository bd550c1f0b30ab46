# SPDX-License-Identifier: Apache-2.0
"""What a bridge to Gazebo, or a domain_bridge, is told -> its topics, services and nodes in ROS.

Source: ros_gz jazzy 739cb42, ros_gz_bridge/src/parameter_bridge.cpp (``TOPIC@TYPE[GZ_TYPE``, with ``[``
from Gazebo, ``]`` to Gazebo, ``@`` both, and ``@GZ_TOPIC`` behind it where that is called otherwise;
``SERVICE@TYPE``), bridge_config.cpp (the keys of its file),
ros_gz_image/src/image_bridge.cpp. ros2/domain_bridge c2523e1, process_cmd_line_arguments.hpp (options,
then files; ``--from`` and ``--to`` hold for all topics), parse_domain_bridge_yaml_config.cpp (the keys
of a file), domain_bridge.cpp (``get_node_for_domain``, ``bridge_topic``, ``add_bridges``).
"""

import os
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import lru_cache
from typing import Any, NamedTuple

import yaml

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.releases import OF_OLD
from multibot_rewrite.base.rosnames import check_topic_name, expand
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.planning.domain_bridge import DOMAIN_BRIDGE
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchNote
from multibot_rewrite.related_files.bridge import (
    BOTH,
    GZ,
    ROS,
    SERVICE as SERVICE_ROW,
    as_loaded,
)
from multibot_rewrite.related_files.yaml_text import read_yaml
from multibot_rewrite.system.records import PUBLISHES, SERVES, SERVICE, SUBSCRIBES, TOPIC, End, Node

_ROW = lazy_compile(
    r"(?P<name>[^@]+)@(?P<type>[\w/]+)(?P<way>[@\[\]]?)(?P<gz>[^@]*)(?:@(?P<inside>.+))?"
)
_ROLES = {"[": (PUBLISHES,), "]": (SUBSCRIBES,), "@": (PUBLISHES, SUBSCRIBES)}
_WAYS = {"GZ_TO_ROS": "[", "ROS_TO_GZ": "]", "BIDIRECTIONAL": "@"}
# The parameter that names a bridge's file.
CONFIG_FILE = "config_file"
_IMAGE = "sensor_msgs/msg/Image"
_BRIDGES = ("ros_gz_bridge/parameter_bridge", "ros_ign_bridge/parameter_bridge")
_OF_IMAGES = ("ros_gz_image/image_bridge", "ros_ign_image/image_bridge")


class Row(NamedTuple):
    """What a bridge has in ROS, and the name that it has in the simulator."""

    end: Endpoint
    inside: str


def bridge_rows(node: LaunchedNode, words: Collection[str]) -> tuple[Endpoint, ...]:
    """Return the ROS topics in the arguments of a bridge; empty for another program.

    A name with one of ``words`` is that of one robot: its remap rule counts, without one it is left
    out."""
    rules = {f"/{old.lstrip('/')}": new for old, new in node.remappings}
    rows = _argument_rows(f"{node.package}/{node.executable}", node.arguments)
    return tuple(end for it in rows for end in _for_any_robot(it.end, rules, words))


def services_in(words: Iterable[str]) -> dict[str, Row]:
    """Return the rows of services among the arguments of programs, each by its argument."""
    found = ((word, _ROW.fullmatch(word)) for word in words)
    rows = ((word, [*_rows_of(row)]) for word, row in found if row and "/srv/" in row["type"])
    return {word: row for word, own in rows for row in own}


def passes_topics_on(package: str, program: str) -> bool:
    """Return whether a program is a bridge to a simulator, which the bridges of a build replace."""
    return f"{package}/{program}" in (*_BRIDGES, *_OF_IMAGES, "ros_gz_bridge/bridge_node")


def files_in(node: LaunchedNode) -> Iterator[str]:
    """Yield the files that a launch file tells a bridge to read; they need not be here."""
    if passes_topics_on(node.package, node.executable):
        values = (load_yaml(it.text, it.file or node.place.file) for it in node.parameters)
        sections = (one for it in values if isinstance(it, dict) for one in it.values())
        given = [one.get("ros__parameters") for one in sections if isinstance(one, dict)]
        paths = (str(it.get(CONFIG_FILE) or "") for it in given if isinstance(it, dict))
        yield from filter(None, paths)


def made_files(node: LaunchedNode) -> dict[str, str]:
    """Return the texts that a launch makes of a bridge's files (``ReplaceString``), by their paths."""
    given = node.parameters if passes_topics_on(node.package, node.executable) else ()
    made = {it.source: it.text for it in given if it.source and not it.file}
    return {path: text for path, text in made.items() if isinstance(load_yaml(text, path), list)}


def is_bridge(it: Run) -> bool:
    """Return whether a node passes topics of a simulator on."""
    known = it.fact.kind == "ros_gz_bridge"
    return known or it.program in (*_BRIDGES, *_OF_IMAGES)


def bridged_by(it: Run) -> Iterator[Row]:
    """Yield all that a bridge passes on, maybe below its namespace (expand_gz_topic_names)."""
    if not is_bridge(it):
        return
    below = it.namespace if expands(it) else "/"
    given = it.values.get(CONFIG_FILE)
    path = str(given.value) if given else ""
    own = [read_file(path).decode("utf-8", "replace")] if os.path.isfile(path) else []
    rows = [*_argument_rows(it.program, it.arguments)]
    for text in (*own, *it.texts):
        rows += rows_of_text(text)
    yield from (Row(row.end, expand(row.inside, below, it.name)) for row in rows)


def expands(it: Run) -> bool:
    """Return whether a bridge takes simulator names as those below its namespace."""
    return it.value("expand_gz_topic_names") is True


def rows_in_arguments(it: Run) -> str:
    """Return the topics in the arguments of a bridge, as its file would have them; empty without."""
    return rows_in_words(it.program, it.arguments) if it.program in _BRIDGES else ""


def rows_in_words(
    program: str, words: Sequence[str], rules: Sequence[tuple[str, str]] = (), above: str = ""
) -> str:
    """Return a bridge's topics as bridge file text, with its remap rules, in namespace ``above``."""
    renamed = {expand(old, f"/{above}", ""): expand(new, f"/{above}", "") for old, new in rules}
    ways = {word: name for name, word in _WAYS.items()}
    rows = (_ROW.fullmatch(word) for word in words if program in _BRIDGES)
    found = [it.groups() for it in rows if it and it["way"] and "/srv/" not in it["type"]]
    images = (word for word in words if _is_image(program, word))
    found += [(word, _IMAGE, "[", "gz.msgs.Image", None) for word in images]
    entries = []
    for name, type_, way, gz, inside in found:
        own = expand(name, f"/{above}", "") if above else name
        ros = renamed.get(f"/{own.lstrip('/')}", own)
        names = {BOTH: name} if ros == (inside or name) else {ROS: ros, GZ: inside or name}
        kinds = {"ros_type_name": type_, "gz_type_name": gz, "direction": ways[way]}
        entries.append(names | kinds)
    return yaml.safe_dump(entries, sort_keys=False) if entries else ""


def refused_rows(it: Run) -> Iterator[str]:
    """Yield the arguments of a bridge that are meant as a row and are none: it ends then."""
    for word in it.arguments if it.program in _BRIDGES else ():
        row = _ROW.fullmatch(word)
        whole = row is not None and (row["way"] or "/srv/" in row["type"])
        if "@" in word and not whole:
            yield word


def _argument_rows(program: str, words: Sequence[str]) -> Iterator[Row]:
    for word in words:
        row = _ROW.fullmatch(word)
        if program in _BRIDGES and row is not None:
            yield from _rows_of(row)
        elif _is_image(program, word):
            yield Row(Endpoint(TOPIC, PUBLISHES, word, _IMAGE, transport=True), word)


def _is_image(program: str, word: str) -> bool:
    """Return whether an argument is the topic of a bridge of images; rcl refuses other names."""
    return program in _OF_IMAGES and word[:1] != "-" and check_topic_name(word) is None


def _rows_of(row: re.Match[str]) -> Iterator[Row]:
    """Yield the rows of an argument ``TOPIC@TYPE[GZ_TYPE`` or ``SERVICE@TYPE``."""
    name, type_, way, _, inside = row.groups()
    if "/srv/" in type_:
        yield Row(Endpoint(SERVICE, SERVES, name, type_), name)
    else:
        yield from _topic_rows(name, type_, way, inside or name)


def _topic_rows(name: str, type_: str, way: str, inside: str) -> Iterator[Row]:
    full = type_ if type_.count("/") > 1 else type_.replace("/", "/msg/")
    for role in _ROLES.get(way, ()):
        yield Row(Endpoint(TOPIC, role, name, full), inside)


@lru_cache(maxsize=4096)  # a fleet has one a robot, and several rules ask for it
def rows_of_text(text: str) -> tuple[Row, ...]:
    """Return the rows of a bridge file; none for another text."""
    rows: list[Row] = []
    try:
        entries = load_yaml(as_loaded(read_yaml(text.encode(), ""), OF_OLD).text, "")
    except InputError:
        return ()
    for entry in entries if isinstance(entries, list) else ():
        if isinstance(entry, Mapping):
            # A row with one name has it on both sides.
            topic = entry.get(BOTH) or entry.get(ROS) or entry.get(GZ)
            way = _WAYS.get(str(entry.get("direction", "BIDIRECTIONAL")), "@")
            inside, type_ = entry.get(GZ) or topic, str(entry.get("ros_type_name", ""))
            if service := entry.get(SERVICE_ROW):
                rows.append(Row(Endpoint(SERVICE, SERVES, str(service), type_), str(service)))
            elif topic:
                rows += _topic_rows(str(topic), type_, way, str(inside))
    return (*rows,)


def _for_any_robot(
    it: Endpoint, rules: dict[str, str], words: Collection[str]
) -> Iterator[Endpoint]:
    """Yield an endpoint; that of one robot under its remap rule, or not at all."""
    if not set(it.name.split("/")) & set(words):
        yield it
        return
    target = rules.get(f"/{it.name.lstrip('/')}", "")
    if target and not set(target.split("/")) & set(words):
        # The layout decides where tf is, as for every node.
        yield it._replace(name=f"/{target}" if target in ("tf", "tf_static") else target)


_DOMAIN_BRIDGE = f"{DOMAIN_BRIDGE}/{DOMAIN_BRIDGE}"
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
    for it in (it for it in running if it.program == _DOMAIN_BRIDGE):
        for end in _ends(it, notes):
            ends.append(end)
            node = Node(end.node, it.process, place=it.place, known=DOMAIN_BRIDGE)
            nodes.setdefault(end.node, node)
    return BridgedDomains((*nodes.values(),), (*dict.fromkeys(ends),), (*notes,))


def _ends(it: Run, notes: list[LaunchNote]) -> Iterator[End]:
    """Yield the ends of one bridge; its files are all for one node, named by the last that does so."""
    options, paths = _domains_and_files(it.arguments)
    files: list[Mapping[str, Any]] = []
    for path in paths:
        try:
            data = load_yaml(read_file(path).decode("utf-8", "replace"), path)
        except (InputError, OSError) as error:
            notes.append(LaunchNote(it.place, f"domain_bridge does not read {path}: {error}"))
            continue
        files += [data] if isinstance(data, Mapping) else []
    name = [DOMAIN_BRIDGE, *(str(file["name"]) for file in files if file.get("name"))][-1]
    for file in files:
        topics = file.get("topics")
        for topic, row in topics.items() if isinstance(topics, Mapping) else ():
            if isinstance(row, Mapping):
                yield from _of_topic(it, name, str(topic), {**file, **row, **options})


def _domains_and_files(words: Sequence[str]) -> tuple[dict[str, object], list[str]]:
    """Return (domains by the keys of a bridge's file, files) in a domain_bridge's arguments."""
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


def _of_topic(it: Run, bridge: str, topic: str, row: Mapping[str, Any]) -> Iterator[End]:
    """Yield the ends of a topic in both domains, and of the way back; none if these are one domain."""
    domains: tuple[int, ...] = ()
    with suppress(KeyError, TypeError, ValueError):
        domains = (int(row["from_domain"]), int(row["to_domain"]))
    if len({*domains}) < 2:
        return
    ways = [domains[::-1] if row.get("reversed") else domains]
    ways += [ways[0][::-1]] if row.get("bidirectional") else []
    type_, sent = str(row.get("type", "")), str(row.get("remap") or topic)
    for here, there in ways:
        # Its nodes are in the root namespace, and have no rules.
        for domain, role, name in ((here, SUBSCRIBES, topic), (there, PUBLISHES, sent)):
            full, node = f"/{name.lstrip('/')}", f"/{bridge}_{domain}"
            yield End(TOPIC, role, full, type_, "", node, None, it.process, name)
