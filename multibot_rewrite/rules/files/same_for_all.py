# SPDX-License-Identifier: Apache-2.0
"""Values and sections that stay the same for all robots, or get a robot's name twice."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, rule
from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.knowledge.node_entries import OWN_KINDS, PORT, RUN_TIME
from multibot_rewrite.knowledge.parameters import is_absolute
from multibot_rewrite.producers.addresses import held_by
from multibot_rewrite.related_files.context import Context
from multibot_rewrite.related_files.named_file import MOVEIT, PARAMS, RVIZ, NamedFile
from multibot_rewrite.related_files.names.by_kind import (
    expressible,
    frames_differ,
    is_emptied,
    is_plain,
)
from multibot_rewrite.related_files.names.placeholders import filled, is_robot
from multibot_rewrite.related_files.names.rename_map import is_declared
from multibot_rewrite.related_files.params.sections import ANY, ParamSection, flattened, scalars
from multibot_rewrite.related_files.rviz.read_config import (
    GRAPH_NAMESPACE,
    LINK,
    TF_PREFIX,
    RvizItem,
    text_of,
)
from multibot_rewrite.related_files.sites import Site
from multibot_rewrite.rules.declaration import TWO, of_robots, remark, remark_at, robots_rule
from multibot_rewrite.rules.files.section_facts import given_in
from multibot_rewrite.system.records import COMPUTER

# Patterns that match everything or nothing hold no robot's name.
_OPEN_PATTERNS = frozenset({".*", "*", "[*]", "(?!)", "^$"})
_OWN_VALUE = "set it for each robot, in a parameter file that is loaded after this one"


@of_robots
def _exclusive(file: NamedFile) -> Iterator[Finding]:
    """Report each parameter that only one node can have so, in a file for several robots."""
    if file.is_for_one:
        return
    # Of a fleet each robot gets a number of its own.
    kinds = ("exclusive",) if file.is_certain else ("exclusive", PORT)
    for site in file.names:
        if site.kind in kinds and site.text and site.text.lower() not in ("false", "no", "off"):
            yield remark(site, _same_message(site.key, site.text), _OWN_VALUE)
    known = {site.slot.start for site in file.names if site.kind in OWN_KINDS}
    for section, _ in file.pages:
        for key, value in () if section.shared else scalars(section.body):
            text = str(value.value)
            kind = "" if value.start_mark.index in known else held_by(key.value, text)
            if kind == COMPUTER:
                hint = f"fine if each robot has a computer of its own; else {_OWN_VALUE}"
                yield remark_at(value, _same_message(key.value, text), hint, NOTE)
            elif kind:
                hint = f"one device has one driver: {_OWN_VALUE}"
                yield remark_at(value, _same_message(key.value, text), hint)


def _same_message(key: str, text: str) -> str:
    return f"{key} {text} is the same for all robots"


@robots_rule("MB881", "value-not-renamed", WARNING, PARAMS, RVIZ)
def not_renamed(file: NamedFile) -> Iterator[Finding]:
    """Report patterns and expressions of nodes, and values of displays, that stay unchanged."""
    for site in file.names if file.kind == PARAMS else ():
        sure = site.kind == "pattern"
        sure = sure or (site.kind == "text" and _mentions(file.context, site.text))
        if sure and site.text not in _OPEN_PATTERNS:
            message = f"names in {site.key} {site.text!r} are not rewritten"
            yield remark(site, message, "check that it works for each robot")
    for one, place in ((item, site) for item in file.shown for site in item.places):
        why = _why_not(file.context, one, place) if place.slot.value else None
        if why:
            message, hint = why
            yield remark(place, f"{place.key.rstrip('.*')} {place.slot.value!r} {message}", hint)


def _mentions(context: Context, value: str) -> bool:
    words = "".join(c if c.isalnum() or c in "_-/" else " " for c in value).split()
    return any(is_declared(context.names, kind, it) for it in words for kind in ("link", "joint"))


def _why_not(context: Context, one: RvizItem, place: Site) -> tuple[str, str] | None:
    """Return why a value of a display stays unchanged, and what to do; None for one that may."""
    naming = context.names.naming
    if place.kind == "regex" and naming.layout.frames:
        return "is a pattern for frames and stays unchanged", "make it match the robots' frames"
    if place.kind == "file" and text_of(one.node, "Description Source") == "File":
        renamed = LINK in naming.separators
        hint = "set Description Source to Topic" if renamed else "fine if all robots look the same"
        return "is one description file, shown for every robot", hint
    if place.kind == GRAPH_NAMESPACE and naming.topics != NAMESPACE:
        problem = "is a namespace of topics, but this layout renames each topic instead"
        return problem, "use a layout with namespaces"
    return None


@robots_rule("MB882", "robot-twice-in-value", ERROR, PARAMS, RVIZ)
def robot_twice(file: NamedFile) -> Iterator[Finding]:
    """Report prefixes that a node or a display puts before frames."""
    layout = file.context.names.naming.layout
    certain = frames_differ(file.context)
    for site in file.names if not layout.at_run_time else ():
        # Where there is none, or none is filled in, nothing is twice.
        if site.kind in RUN_TIME and site.text.strip("/") and not is_robot(site.text):
            emptied = is_emptied(file.context, site.kind, site.text)
            level = "" if certain and is_plain(site.text) and not emptied else WARNING
            message = prefix_twice(site.key, site.text)
            hint = "nothing to do; a rewrite empties it" if emptied else 'write ""'
            yield remark(site, message, hint, level)
    for place in (it for one in file.shown if layout.frames for it in one.places):
        given = place.slot.value
        if place.kind == TF_PREFIX and given and not is_robot(given):
            message = f"{prefix_twice('TF Prefix', given)}: it is emptied"
            hint = "nothing to do; RViz would add the prefix a second time"
            yield remark(place, message, hint, WARNING)


def prefix_twice(key: str, value: str) -> str:
    """Return the message about a prefix for frames that have the robot's name already."""
    return f"{key} {value!r} adds a prefix to frames that already have the robot's name"


@of_robots
def prefix_only(file: NamedFile) -> Iterator[Finding]:
    """Report prefixes that cannot hold the robot's name at the end, set or left to their default."""
    found: list[tuple[str, Finding]] = []
    for site in file.names if file.kind in (PARAMS, MOVEIT) else ():
        if not expressible(file.context, site.kind):
            found.append((site.key or site.kind, remark(site, "")))
    seen: set[str] = set()
    for section, _ in file.pages:
        if section.node and not (section.shared or section.inner or section.full in seen):
            seen.add(section.full)
            open_ = [
                it.path for it in section.node.defaults if not expressible(file.context, it.kind)
            ]
            given = [it for it in given_in(file) if it.node == section.path] if open_ else []
            there = {path for it in given for path in it.values}
            found += ((it, remark_at(section.keys[-1], "")) for it in open_ if it not in there)
    for name, at in found:
        message = f"{name} is put in front of names by the node, so a postfix cannot be added"
        yield at._replace(message=message, hint="set affix: prefix")


# The second one: camera_aravis, spinnaker_camera_driver.
_URLS = frozenset({"camera_info_url", "camerainfo_url"})
_SCHEMES = ("file://", "package://")


def one_device(file: NamedFile) -> Iterator[Finding]:
    """Yield devices that only one node can open, and calibrations of cameras."""
    yield from _exclusive(file)
    # Each calibration that all robots of a file read; a file for one robot has its own.
    # Source: image_common, camera_info_manager.cpp (humble to rolling). A camera_info_url is file:///,
    # package:// or flash:///, with ${NAME} and ${ROS_HOME} filled in; the file has no robot's name.
    sections = () if file.is_for_one else (it for it, _ in file.pages if not it.shared)
    for key, url in (it for section in sections for it in scalars(section.body)):
        text = str(url.value)
        own = filled(text, "") != text or "${ROS_HOME}" in text
        is_url = key.value.rpartition(".")[2] in _URLS and text.lower().startswith(_SCHEMES)
        if is_url and not own:
            message = f"every robot reads the calibration {text!r}; real cameras have one each"
            hint = "write <robot_namespace> into the path, which becomes the robot's name"
            yield remark_at(url, message, hint, NOTE)


@robots_rule("MB883", "section-of-one-robot", ERROR, PARAMS)
def section_of_one_robot(file: NamedFile) -> Iterator[Finding]:
    """Yield the sections whose name has a namespace: of one robot, or placed below each robot's."""
    context = file.context
    for section in (it for it, _ in file.pages if not it.shared):
        tokens = section.path.split("/")
        key = section.keys[0]
        if section.path in context.nodes or tokens[0] == "**" or section.full == section.path:
            continue
        if section.path != "/".join(it.value.strip("/") for it in section.keys):
            continue  # what is below the robot's own namespace is meant to be there
        tails = ["/".join(tokens[at:]) for at in range(1, len(tokens))]
        node_set = next((tail for tail in tails if tail in context.nodes), "")
        if node_set or (tokens[-1] in ANY and tokens[0] not in ANY):
            message = f"section {section.path} is for one robot only: its name includes a namespace"
            hint = f"write {node_set or '/**'}: instead; the build adds each robot's namespace"
            yield remark_at(key, message, hint)
        elif tails and not section.wild and not tokens[-1].startswith(tokens[0]):
            what = "has a namespace; it is placed below each robot's namespace"
            hint = f"if {tokens[0]} is the name of a robot, write {tails[0]}: instead"
            yield remark_at(key, f"section {section.path} {what}", hint, WARNING)


@rule(
    "MB886",
    "section-of-shared-node",
    WARNING,
    formats=(PARAMS,),
    options={"build": True, "node_sets": "own", "nodes": "nodes.yaml"},
)
def shared_section(file: NamedFile) -> Iterator[Finding]:
    """Report each node that serves all robots, at its first section."""
    shared = (it for it, _ in reversed(file.pages) if it.shared and file.is_certain)
    first = {it.path: it for it in shared}
    for path, section in first.items():
        message = f"{path} serves all robots, so its section stays as it is"
        yield remark_at(section.keys[-1], message, "start it once, with this file")


@robots_rule(
    "MB885",
    "costmap-source-without-topic",
    WARNING,
    PARAMS,
    options={"robots": TWO, "distro": "jazzy"},
)
def source_without_topic(file: NamedFile) -> Iterator[Finding]:
    """Report observation sources of a costmap layer without a topic: their id is the topic."""
    pages = (it for it, _ in file.pages if not it.shared and _resolves_below(it, file.context))
    for section in pages:
        names = dict(flattened(section.body))
        values = {id(key): str(value.value) for key, value in scalars(section.body)}
        for name, key in names.items():
            layer, _, last = name.rpartition(".")
            words = values.get(id(key), "") if last == "observation_sources" and layer else ""
            for source in (it for it in words.split() if f"{layer}.{it}.topic" not in names):
                message = f"source {source} of {layer} has no topic, so it subscribes to {source!r}"
                hint = f"add {layer}.{source}.topic: /{source}; it is renamed for each robot"
                yield remark_at(key, message, hint)


def _resolves_below(section: ParamSection, context: Context) -> bool:
    """Return whether the id of a source is another name than that of the robot's topic."""
    param = section.node.params.get("<id>.<id>.topic") if section.node else None
    namespaced = context.topics.naming.topics == NAMESPACE
    return param is not None and (not namespaced or is_absolute(param, context.distro))
