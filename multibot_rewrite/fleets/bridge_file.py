"""A user's ros_gz_bridge file for one robot -> its entries for any robot, and those that all share.

Sources: ros_gz jazzy ``ros_gz_bridge/src/bridge_config.cpp``; gz-sim's names ``/model/<name>/...``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.companions.context import Companion, Context
from multibot_rewrite.companions.names.rename_map import is_declared, spell
from multibot_rewrite.companions.names.robot_topics import NOTHING, is_topic, robot_topic
from multibot_rewrite.companions.rviz.read_config import text_of
from multibot_rewrite.companions.rviz.values import without_placeholder
from multibot_rewrite.companions.template import make_template
from multibot_rewrite.companions.yaml_blocks import Block, blocks, cut_out, is_block, newline
from multibot_rewrite.companions.yaml_text import (
    Splice,
    YamlText,
    finding_at,
    is_text,
    items,
    line_of,
    pairs,
    quoted,
    refuse_anchors,
    replaced,
)
from multibot_rewrite.model import WARNING, Finding, InputError
from multibot_rewrite.naming import POSTFIX
from multibot_rewrite.nearest import did_you_mean

# Stands for the name of the spawned model: it may differ from the namespace and the tag.
MODEL_SLOT = "multibotModelSlot"
BOTH, ROS, GZ = "topic_name", "ros_topic_name", "gz_topic_name"
TYPES = ("ros_type_name", "gz_type_name")
DIRECTIONS = ("BIDIRECTIONAL", "GZ_TO_ROS", "ROS_TO_GZ")
SERVICE = "service_name"

KEYS: tuple[str, ...] = (
    BOTH,
    ROS,
    GZ,
    *TYPES,
    SERVICE,
    "direction",
    "publisher_queue",
    "subscriber_queue",
    "lazy",
)
KEYS += ("publish_optical_frame", "frame_id", "qos_profile", "gz_req_type_name", "gz_rep_type_name")
# gz topics of the whole simulation, like those below /world.
WORLD = frozenset({"clock", "stats"})
GZ_MODEL = re.compile(r"(?P<above>/?(?:world/[^/]+/)?model/)(?P<model>[^/]+)(?P<rest>/.*)?")
_PART = re.compile(r"(?<=/)(link|joint|sensor)/([^/]+)")
_PLACEHOLDER = re.compile(r"[<>{}$%]")


class BridgeFile(NamedTuple):
    """A bridge file: the entries of each robot with slots, and the text of those that all share."""

    own: Companion
    shared: str


class _Entry(NamedTuple):
    """An entry and its names: both sides as they are, and as each robot has them.

    ``own`` is true if each robot needs its own.
    """

    node: yaml.MappingNode
    block: Block
    ros: str
    gz: str
    new_ros: str
    new_gz: str
    own: bool


def rewrite_bridge(
    document: YamlText, context: Context, known: Mapping[str, str] = NOTHING
) -> BridgeFile:
    """Find what each robot needs for itself; ``known`` is ``fleet_topics`` of the namespace slot.

    Names come out in full, so it makes no difference which namespace the bridge runs in, whether it
    expands gz names, and whether one bridge carries all robots. Raises InputError for a file that
    is no list of entries.
    """
    _refuse(document)
    findings: list[Finding] = []
    entries = _entries(document, context, known, findings)
    own = [it for it in entries if it.own]
    shared = [it for it in entries if not it.own]
    splices = [splice for it in own for splice in _splices(document, it, context)]
    template = (
        make_template(document.text, [*_only(document, own), *splices])
        if own
        else make_template("", ())
    )
    text = cut_out(document, 0, len(document.text), _only(document, shared)) if shared else ""
    return BridgeFile(Companion(template, tuple(findings)), text)


def _entries(
    document: YamlText, context: Context, known: Mapping[str, str], findings: list[Finding]
) -> list[_Entry]:
    """The entries that the bridge loads; what is wrong with others goes to ``findings``."""
    model = _model_of(document, findings)
    found: list[_Entry] = []
    assert document.root is not None
    for node, block in zip(document.root.value, blocks(document, document.root), strict=True):
        fault = _fault(node)
        if fault:
            hint = "ros_gz_bridge skips this entry, so it is left out"
            findings.append(finding_at(document, node, "MF502", WARNING, fault, hint))
            continue
        found.append(_entry(node, block, context, model, known))
        findings += _entry_findings(document, found[-1], context)
    return found


def _refuse(document: YamlText) -> None:
    root, file = document.root, document.file
    if root is None:
        raise InputError(f"{file}: the bridge file is empty; write a list of topics")
    if not isinstance(root, yaml.SequenceNode):
        raise InputError(
            f"{file}:{line_of(root)}: not a list of topics; start each entry with a dash"
        )
    if root.value and not is_block(root):
        raise InputError(
            f"{file}:{line_of(root)}: the list is in brackets; start each entry with a dash"
        )
    refuse_anchors(document)


def _fault(node: yaml.Node) -> str:
    """Why the bridge does not load an entry; empty if it does."""
    if not isinstance(node, yaml.MappingNode):
        return "the entry is not a map of keys and values"
    both, ros, gz = (text_of(node, key) for key in (BOTH, ROS, GZ))
    if both and (ros or gz):
        return f"{BOTH} cannot be used together with {ROS if ros else GZ}"
    if text_of(node, SERVICE):
        return ""
    missing = [key for key in TYPES if not text_of(node, key)]
    if missing or not (both or ros or gz):
        return f"{' and '.join(missing or (ROS, GZ))} is missing"
    direction = text_of(node, "direction")
    known = not direction or direction in DIRECTIONS
    return "" if known else f"direction {direction!r} is not one of {', '.join(DIRECTIONS)}"


def _model_of(document: YamlText, findings: list[Finding]) -> str:
    """The one model the file is for; others are findings."""
    first = ""
    reported: set[str] = set()
    for node in items(document.root):
        for key in (BOTH, ROS, GZ):
            found = GZ_MODEL.fullmatch(text_of(node, key))
            name = found["model"] if found else ""
            if not name or _PLACEHOLDER.search(name) or key == ROS:
                continue
            first = first or name
            if name != first and name not in reported:
                reported.add(name)
                message = f"model {name!r} is not the robot's model {first!r}"
                hint = "its topics stay as they are and are bridged once for all robots"
                findings.append(finding_at(document, node, "MF505", WARNING, message, hint))
    return first


def _entry(
    node: yaml.MappingNode, block: Block, context: Context, model: str, known: Mapping[str, str]
) -> _Entry:
    both = text_of(node, BOTH)
    ros = both or text_of(node, ROS) or text_of(node, GZ)
    gz = both or text_of(node, GZ) or text_of(node, ROS)
    bare_ros, bare_gz = (without_placeholder(name, "/") for name in (ros, gz))
    found = GZ_MODEL.fullmatch(bare_gz)
    another = found and found["model"] != model and not _PLACEHOLDER.search(found["model"])
    if text_of(node, SERVICE) or another:
        return _Entry(node, block, ros, gz, ros, gz, False)
    new_gz = gz_topic(context, bare_gz, text_of(node, "gz_type_name"))
    new_ros = robot_topic(context.topics, bare_ros, known)
    own = new_gz != gz or new_ros != ros or bool(_PLACEHOLDER.search(ros + gz))
    if own:
        new_gz, new_ros = _in_full(new_gz), _in_full(new_ros)
    return _Entry(node, block, ros, gz, new_ros, new_gz, own)


def _in_full(name: str) -> str:
    """A relative name would follow the namespace of the bridge; a placeholder stays."""
    return name if _PLACEHOLDER.search(name) else f"/{name.lstrip('/')}"


def gz_topic(context: Context, name: str, gz_type: str = "") -> str:
    """A gz topic as the rewritten description and the spawned model have it."""
    found = GZ_MODEL.fullmatch(name)
    rest = (found["rest"] or "") if found else name
    if _PLACEHOLDER.search(rest):
        return name
    if found:
        return found["above"] + MODEL_SLOT + _PART.sub(lambda it: _part(context, it), rest)
    bare = name.strip("/")
    if bare in WORLD or bare.startswith("world/"):
        return name
    base, ending = _family(name, gz_type) if context.topics.naming.topics == POSTFIX else (name, "")
    return spell(context.topics, "topic", base, namespaced=False) + ending


def _part(context: Context, found: re.Match[str]) -> str:
    """A link, joint or sensor in a topic; one that the description does not declare stays."""
    kind, name = found.groups()
    known = is_declared(context.names, kind, name)
    return f"{kind}/{spell(context.names, kind, name) if known else name}"


def _family(name: str, gz_type: str) -> tuple[str, str]:
    """gz-sim puts a lidar's or depth camera's points below the topic that the description names."""
    base, _, last = name.rpartition("/")
    return (
        (base, "/points") if base and last == "points" and "PointCloud" in gz_type else (name, "")
    )


def _splices(document: YamlText, entry: _Entry, context: Context) -> Iterator[Splice]:
    ends = ", " if entry.node.flow_style else newline(document) + " " * entry.node.start_mark.column
    for key, node in pairs(entry.node):
        if not isinstance(node, yaml.ScalarNode):
            continue
        style = node.style or ""
        names = {ROS: quoted(entry.new_ros, style), GZ: quoted(entry.new_gz, style)}
        if key.value == BOTH and entry.new_ros != entry.new_gz:
            text = ends.join(f"{side}: {name}" for side, name in names.items())
            yield Splice(key.start_mark.index, node.end_mark.index, text)
        elif key.value == BOTH and entry.new_ros != node.value:
            yield replaced(node, entry.new_ros)
        elif key.value in names:
            yield from _side(entry, key.value, node, names, ends)
        elif key.value == "frame_id":
            yield from _frame(node, context)


def _side(
    entry: _Entry, key: str, node: yaml.ScalarNode, names: Mapping[str, str], ends: str
) -> Iterator[Splice]:
    """One side's name, and the other's if the file leaves it out because it is the same."""
    other = GZ if key == ROS else ROS
    new = entry.new_ros if key == ROS else entry.new_gz
    single = not text_of(entry.node, other) and entry.new_ros != entry.new_gz
    if single or new != node.value:
        text = names[key] + (f"{ends}{other}: {names[other]}" if single else "")
        yield Splice(node.start_mark.index, node.end_mark.index, text)


def _frame(node: yaml.ScalarNode, context: Context) -> Iterator[Splice]:
    new = spell(context.names, "frame", node.value)
    if new != node.value:
        yield replaced(node, new)


def _only(document: YamlText, kept: Sequence[_Entry]) -> list[Splice]:
    """The splices that take all other entries out of the file."""
    assert document.root is not None
    stay = {it.block for it in kept}
    found = blocks(document, document.root)
    return [Splice(it.start, it.end, "") for it in found if it not in stay]


def _entry_findings(document: YamlText, entry: _Entry, context: Context) -> Iterator[Finding]:
    node = entry.node
    if _PLACEHOLDER.search(entry.new_ros + entry.new_gz):
        message = f"the placeholder in {entry.ros!r} or its gz topic is not replaced"
        hint = "replace it for each robot, or write the topic without the robot's name"
        yield finding_at(document, node, "MF503", WARNING, message, hint)
    elif not text_of(node, SERVICE) and not is_topic(entry.ros):
        message = f"{entry.ros!r} is not a valid ROS topic name"
        yield finding_at(document, node, "MF501", WARNING, message, f"add a {ROS}")
    for kind, name in _PART.findall(entry.gz if MODEL_SLOT in entry.new_gz else ""):
        if not is_declared(context.names, kind, name) and not _PLACEHOLDER.search(name):
            known = context.names.declared.get(kind, ())
            message = f"the description has no {kind} {name!r}{_near(name, known)}"
            yield finding_at(document, node, "MF507", WARNING, message, "correct the name")
    if text_of(node, SERVICE) and not text_of(node, SERVICE).strip("/").startswith("world/"):
        message = f"service {text_of(node, SERVICE)!r} is bridged once for all robots"
        yield finding_at(document, node, "MF503", WARNING, message, "add an entry for each robot")
    for key, there in pairs(node):
        if key.value not in KEYS:
            message = (
                f"unknown key {key.value!r}, which ros_gz_bridge ignores{_near(key.value, KEYS)}"
            )
            yield finding_at(document, key, "MF504", WARNING, message, "correct the key")
        elif key.value not in (BOTH, ROS, GZ, "frame_id") and _is_mention(there, context):
            message = (
                f"{there.value!r} is the name of a link or joint, but its use here is not known"
            )
            yield finding_at(
                document,
                there,
                "MF508",
                WARNING,
                message,
                "if it is a name, rename it by hand",
            )


def _is_mention(node: yaml.Node, context: Context) -> bool:
    known = context.names
    return is_text(node) and any(is_declared(known, it, node.value) for it in ("link", "joint"))


def _near(name: str, known: Iterable[str]) -> str:
    near = did_you_mean(name, known)
    return f", {near}" if near else ""
