# SPDX-License-Identifier: Apache-2.0
"""Names in related files that their description lacks, of unknown use, or in another file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, rule
from multibot_rewrite.base.naming import TF_TOPICS
from multibot_rewrite.base.nearest import HINTED, MISTYPED, did_you_mean, meant_name
from multibot_rewrite.base.rosnames import check_topic_name
from multibot_rewrite.description.checks.mentions import mentioned
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.related_files.engine import GRAPH
from multibot_rewrite.related_files.named_file import (
    BRIDGE,
    EVERY,
    LUA,
    MOVEIT,
    PARAMS,
    RVIZ,
    TREE,
    NamedFile,
)
from multibot_rewrite.related_files.names.by_kind import (
    frames_differ,
    is_component,
    is_plain,
    is_shared_frame,
)
from multibot_rewrite.related_files.names.rename_map import KINDS, is_declared, spell
from multibot_rewrite.related_files.params.values import in_doubt, is_guessed, renamed
from multibot_rewrite.related_files.sites import Site
from multibot_rewrite.related_files.yaml_text import line_of
from multibot_rewrite.rules.declaration import of_robots, remark, robots_rule
from multibot_rewrite.rules.files.declared import unknown_parameters

_FRAMES = ("frame", "link")
_PARTS = ("joint", "sensor", "group", "interface")
# Each value of these may be a name, and is looked through.
_LOOSE = (MOVEIT, TREE, LUA)
# What a word of the description may be, where a mention of it matters.
_MENTIONED = ("link", "joint", "frame", "group")
_REMEDIES = {
    "frame": "correct it, or let the node that sends it use the robot's name",
    "": "correct the name",
}
# Fewer names are mistakes in a file that is meant for the robot.
_FEWEST = 3
WORLD = "world"


@rule("MB853", "undeclared-frame-in-file", WARNING, formats=EVERY)
def undeclared_frame(file: NamedFile) -> Iterator[Finding]:
    """Report frames and links that the description does not declare."""
    return _undeclared_names(file, _FRAMES)


@rule("MB854", "undeclared-joint-in-file", NOTE, formats=EVERY)
def undeclared_joint(file: NamedFile) -> Iterator[Finding]:
    """Report joints, sensors, groups and interfaces that the description does not declare."""
    return _undeclared_names(file, _PARTS)


def _undeclared_names(file: NamedFile, kinds: tuple[str, ...]) -> Iterator[Finding]:
    joints = (it for it in file.names if it.kind == "joint")
    there = {it.together for it in joints if it.text in file.declared.get("joint", ())}
    foreign = set(_names_of_another_robot(file)[0])
    hinted: dict[str, str] = {}
    for site in (it for it in file.names if it.kind in kinds):
        name = _missing_name(file, site)
        if not name or (site.kind, site.text) in foreign:
            continue
        known = file.declared.get("link" if site.kind in _FRAMES else _kind_of(site), {})
        if name not in hinted and len(hinted) < HINTED:
            hinted[name] = _near_hint(file, site, name, known)
        near = hinted.get(name, "")
        alone = site.kind == "joint" and file.is_whole and site.together in there
        if not near and not (_is_sure(file, site) or (not file.is_certain and alone)):
            continue
        level = WARNING if file.is_certain else ""
        hint = near or _REMEDIES["frame" if site.kind == "frame" else ""]
        yield remark(site, f"{_kind_of(site)} {name!r} is in no description", hint, level)


def _kind_of(site: Site) -> str:
    """Return the kind of a site's name; of an interface that of its joint."""
    return "joint" if site.kind == "interface" else site.kind


def _is_sure(file: NamedFile, site: Site) -> bool:
    """Return whether what the description lacks is surely wrong; RViz shows frames of drivers."""
    return file.is_certain and not (file.kind == RVIZ and site.kind == "frame")


def _near_hint(file: NamedFile, site: Site, name: str, known: Iterable[str]) -> str:
    """Return the question whether a known name is meant; empty without one."""
    if not file.is_certain:
        near = meant_name(name, known)
        return f"did you mean {near!r}?" if near else ""
    return did_you_mean(name, known, *(() if _is_sure(file, site) else (MISTYPED,)))


def _missing_name(file: NamedFile, site: Site) -> str:
    """Return the name that the description should have and has not; empty for any other."""
    if " " in site.text or not is_plain(site.text) or site.own:
        return ""
    # RViz keeps links and frames that it has seen once, as keys.
    if (site.in_key and file.kind == RVIZ) or not (site.is_sure or file.is_certain):
        return ""
    if site.kind in _FRAMES:
        links, bare = file.declared.get("link", {}), site.text.strip("/")
        if not file.is_certain:
            bare = bare.rpartition("/")[2]
        declared = any(is_declared(file.context.names, it, bare) for it in (site.kind, "frame"))
        sent = bare in file.sent | built_in_nodes(file.context.distro).sent
        free = not links or declared or sent or is_shared_frame(file.context, bare)
        return "" if free else bare
    if site.kind == "interface":
        # ``joint1/position`` of an unknown controller: other ones may be another controller's.
        owner, slash, _ = site.text.rpartition("/")
        free = site.is_sure or not slash or "/" in owner or not file.declared.get("joint")
        return "" if free or is_component(file.context, owner) else owner
    name = site.text.lstrip("/")
    known = file.declared.get(site.kind, {})
    # A joint of another controller: controller/joint.
    chained = site.kind == "joint" and name.rpartition("/")[2] in known
    guessed = file.kind == PARAMS and not site.is_sure
    sensors = site.kind != "joint" and not file.is_certain
    none = not known and not (file.is_certain and file.kind == BRIDGE)
    return "" if none or name in known or chained or guessed or sensors else name


@rule("MB875", "file-of-another-robot", ERROR, formats=(MOVEIT,), options={"build": True})
def of_another_robot(file: NamedFile) -> Iterator[Finding]:
    """Report a file that names another robot's joints or links, once, at the first."""
    missing, count, first = _names_of_another_robot(file)
    if missing and first:
        few = ", ".join(text for _, text in missing[:2])
        message = f"{len(missing)} of the {count} names in this file are in no description: {few}"
        hint = did_you_mean(first.text, file.declared[first.kind])
        yield remark(first, f"{message} and others", hint or "name the file of this robot")


def _names_of_another_robot(file: NamedFile) -> tuple[list[tuple[str, str]], int, Site | None]:
    """Return (missing (kind, name) pairs, number of all names, first site), if most are missing."""
    if file.kind != MOVEIT or not file.is_certain:
        return [], 0, None
    closed: dict[tuple[str, str], Site] = {}
    for it in file.names:
        if it.kind in (*_FRAMES, *_PARTS):
            closed.setdefault((it.kind, it.text), it)
    missing = [key for key, it in closed.items() if _missing_name(file, it)]
    if len(missing) < _FEWEST or 2 * len(missing) <= len(closed):
        return [], 0, None
    return missing, len(closed), closed[missing[0]]


def unknown_uses(file: NamedFile) -> Iterator[Finding]:
    """Report texts of unknown use that are names, and in files of plugins those that hold one."""
    yield from _guessed(file)
    if not file.others:
        return
    level = "" if file.is_certain else NOTE
    known, renamed = _robots_names(file), _renamed(file)
    said = [(site, _mentioned(file, site, known, renamed)) for site in file.others]
    said = [(site, found) for site, found in said if found]
    misspelt = {it.line for it in unknown_parameters(file)} if said else set()
    for site, found in said:
        if site.line not in misspelt:
            message = f"{found} of the robot, but its use here is not known"
            yield remark(site, message, "it stays as it is; if it is a name, rename it", level)


@of_robots
def _guessed(file: NamedFile) -> Iterator[Finding]:
    """Report, once a section, parameters of an unknown node, taken for names by their own."""
    for section, names in (it for it in file.pages if is_guessed(it[0])):
        # Names of the graph, and others where the guess changes the value.
        taken = [
            it for it in names.sites if it.kind in GRAPH or renamed(file.context, it) != it.text
        ]
        doubt = in_doubt(file.context, section, names)
        left = [it for it in taken if it.kind in doubt]
        if guessed := [it for it in taken if not it.is_sure and it not in left]:
            told = f"parameters that hold names are guessed: {_listed_keys(guessed)}"
            yield _unknown_node(guessed[0], section.path, told)
        if left:
            other = doubt[left[0].kind]
            told = f"{other.value!r} in line {line_of(other)} may be a name, too: "
            yield _unknown_node(
                left[0], section.path, f"{told}{_listed_keys(left)} stay as they are"
            )


def _listed_keys(sites: Iterable[Site]) -> str:
    return ", ".join(dict.fromkeys(it.key for it in sites))


def _unknown_node(site: Site, node: str, told: str) -> Finding:
    hint = "describe the node in a file under nodes:"
    return remark(site, f"node {node} is not known; {told}", hint)


def _renamed(file: NamedFile) -> frozenset[str]:
    """Return the names that a rewrite renames; empty where the file alone is checked."""
    names, kinds = file.context.names, [it for it in _MENTIONED if it in KINDS]
    every = ((kind, it) for kind in kinds for it in file.declared.get(kind, ()))
    kept = (it for kind, it in every if not file.is_certain or spell(names, kind, it) != it)
    return frozenset(kept) if file.kind in _LOOSE else frozenset()


def _mentioned(
    file: NamedFile, site: Site, known: Mapping[str, str], renamed: frozenset[str]
) -> str:
    """Return how a text names something of the robot, for a message; empty if it does not."""
    text = site.text
    apart = file.is_certain and file.context.names.naming.layout.tf_per_robot
    if apart and not site.in_key and text.removeprefix("/") in TF_TOPICS and text[0] == "/":
        return f"{text!r} is a topic"
    if file.kind in _LOOSE:
        absolute = text[:1] == "/" and file.kind != LUA
        topic = absolute and is_plain(text) and not check_topic_name(text)
        held = mentioned(text, renamed) if file.kind != LUA or is_plain(text) else ""
        return f"{text!r} is a name" if topic or held else ""
    if text in known and (known[text] in ("link", "joint") or not site.in_key):
        return f"{text!r} is a {known[text]}"
    is_parameter = file.kind == PARAMS and not site.in_key
    if is_parameter and _begins_all(file, text):
        return f"{text!r} begins the names"
    return f"{text!r} is an interface" if is_parameter and _is_interface(file, text) else ""


def _begins_all(file: NamedFile, text: str) -> bool:
    """Return whether most links begin so. Code that adds it makes other names than the description."""
    links = [it for it in file.declared.get("link", ()) if it != WORLD]
    starts = tuple(f"{text.rstrip('_/')}{it}" for it in "_/")
    begun = [it for it in links if text and it.startswith(starts)]
    return len(links) >= _FEWEST and 2 * len(begun) > len(links)


def _robots_names(file: NamedFile) -> dict[str, str]:
    """Return the links and joints by name; in parameters also the frames and absolute topics."""
    declared = {it: kind for kind in ("link", "joint") for it in file.declared.get(kind, ())}
    if file.kind != PARAMS:
        return declared
    claimed = {it.text: it.kind for it in file.names if _is_claimed(file, it)}
    return {**claimed, **declared}


def _is_claimed(file: NamedFile, site: Site) -> bool:
    """Return whether a site names a frame or absolute topic of the robot; others are common words."""
    if site.in_key or not is_plain(site.text):
        return False
    if site.kind == "frame":
        sure = site.is_sure or site.text == "odom"
        return sure and not is_shared_frame(file.context, site.text)
    return site.kind == "topic" and site.text.startswith("/")


def _is_interface(file: NamedFile, value: str) -> bool:
    """Return whether a value is an interface like ``elbow/position``; ``imu/data`` is a topic."""
    *chain, interface = value.split("/")
    kinds = ("joint", "gpio", "sensor") if "." in interface else ("joint", "gpio")
    names = file.context.names
    return interface != "" and any(is_declared(names, kind, it) for kind in kinds for it in chain)


@robots_rule("MB887", "included-file", WARNING, LUA, TREE)
def included_file(file: NamedFile) -> Iterator[Finding]:
    """Report each file that is included."""
    key = "behavior_trees" if file.kind == TREE else "lua"
    for site in file.included:
        message = f"the included file {site.text!r} is not rewritten with this one"
        yield remark(site, message, f"if it has names, list it under {key} as well")


@robots_rule("MB888", "lua-frame-not-plain", WARNING, LUA)
def computed_frame(file: NamedFile) -> Iterator[Finding]:
    """Report each computed frame of a Lua file, if robots have frames of their own."""
    for site in file.computed if frames_differ(file.context) else ():
        message = f"{site.key} is not a plain string, so it stays unchanged"
        yield remark(site, message, "each robot needs its own frame here; write the name in quotes")
