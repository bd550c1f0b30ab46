"""A user's ros_gz_bridge file -> one for each robot, and what one bridge carries for all.

Sources: ros_gz jazzy ``ros_gz_bridge/src/bridge_config.cpp``; gz-sim's names ``/model/<name>/...``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.companions.context import Companion, Context
from multibot_rewrite.companions.graph_names import NOTHING, is_topic, robot_topic
from multibot_rewrite.companions.respell import is_declared, respell
from multibot_rewrite.companions.rviz.blocks import Block, blocks, cut_out, is_block, moved, newline
from multibot_rewrite.companions.rviz.names import without_placeholder
from multibot_rewrite.companions.rviz.read import text_of
from multibot_rewrite.companions.template import Template, cut, fill
from multibot_rewrite.companions.yaml_text import (
    Splice,
    YamlText,
    anchors,
    is_text,
    items,
    line_of,
    pairs,
    quoted,
    read_yaml,
    replaced,
)
from multibot_rewrite.fleets.describe import Described
from multibot_rewrite.model import ERROR, WARNING, Finding, InputError
from multibot_rewrite.naming import POSTFIX
from multibot_rewrite.nearest import did_you_mean
from multibot_rewrite.remap.bridge import Bridged, as_yaml

# Stands for the name of the spawned model, which may be a third word.
MODEL = "multibotModelHole"
BOTH, ROS, GZ = "topic_name", "ros_topic_name", "gz_topic_name"
TYPES = ("ros_type_name", "gz_type_name")
DIRECTIONS = ("BIDIRECTIONAL", "GZ_TO_ROS", "ROS_TO_GZ")
SERVICE = "service_name"
# One topic that several gz topics may come out on.
TF = frozenset({"/tf", "/tf_static"})
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
# gz topics of the whole simulation beside those below /world.
WORLD = frozenset({"clock", "stats"})
_MODEL = re.compile(r"(?P<above>/?(?:world/[^/]+/)?model/)(?P<model>[^/]+)(?P<rest>/.*)?")
_PART = re.compile(r"(?<=/)(link|joint|sensor)/([^/]+)")
_PLACEHOLDER = re.compile(r"[<>{}$%]")
# What gz-transport takes in a topic (gz-transport TopicUtils).
_GZ_WORD = re.compile(r"[A-Za-z0-9_.-]+")


class BridgeFile(NamedTuple):
    """A bridge file: the entries of each robot with holes, and the text of those for all."""

    own: Companion
    shared: str


class _Entry(NamedTuple):
    """An entry and its names: of both sides as they are, and as each robot has them.

    ``own`` tells that each robot has it for itself.
    """

    node: yaml.MappingNode
    block: Block
    ros: str
    gz: str
    new_ros: str
    new_gz: str
    own: bool


def bridge(document: YamlText, context: Context, known: Mapping[str, str] = NOTHING) -> BridgeFile:
    """Find what each robot needs for itself; ``known`` is ``known_topics`` of the robot hole.

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
    template = cut(document.text, [*_only(document, own), *splices]) if own else cut("", ())
    text = cut_out(document, 0, len(document.text), _only(document, shared)) if shared else ""
    return BridgeFile(Companion(template, tuple(findings)), text)


def _entries(
    document: YamlText, context: Context, known: Mapping[str, str], findings: list[Finding]
) -> list[_Entry]:
    """The entries that the bridge loads; what is to be told of any goes to the findings."""
    model = _model_of(document, findings)
    found: list[_Entry] = []
    assert document.root is not None
    for node, block in zip(document.root.value, blocks(document, document.root), strict=True):
        fault = _fault(node)
        if fault:
            hint = "the bridge skips the entry, so it is left out"
            findings.append(_finding(document, node, "MF502", WARNING, fault, hint))
            continue
        found.append(_entry(node, block, context, model, known))
        findings += _remarks(document, found[-1], context)
    return found


def filled(template: Template, graph: str, spelled: str, model: str) -> str:
    """A robot's bridge file; InputError where its model's name cannot be part of a gz topic."""
    text = fill(template, graph, spelled)
    if MODEL in text and not _GZ_WORD.fullmatch(model):
        raise InputError(
            f"model {model!r}: a gz topic cannot hold it; use letters, digits, _ . and - in it"
        )
    return text.replace(MODEL, model)


def _refuse(document: YamlText) -> None:
    root, file = document.root, document.file
    if root is None:
        raise InputError(f"{file}: the bridge file is empty; write a list of topics")
    if not isinstance(root, yaml.SequenceNode):
        raise InputError(f"{file}:{line_of(root)}: no list of topics; start each with a dash")
    if root.value and not is_block(root):
        raise InputError(
            f"{file}:{line_of(root)}: a list in brackets; start each entry with a dash"
        )
    for line, anchor in anchors(document):
        raise InputError(f"{file}:{line}: the anchor or alias {anchor}; write the value out")


def _fault(node: yaml.Node) -> str:
    """Why the bridge does not load an entry; empty where it does."""
    if not isinstance(node, yaml.MappingNode):
        return "the entry is no map of keys and values"
    both, ros, gz = (text_of(node, key) for key in (BOTH, ROS, GZ))
    if both and (ros or gz):
        return f"{BOTH} and {ROS if ros else GZ} exclude each other"
    if text_of(node, SERVICE):
        return ""
    missing = [key for key in TYPES if not text_of(node, key)]
    if missing or not (both or ros or gz):
        return f"{' and '.join(missing or (ROS, GZ))} is missing"
    direction = text_of(node, "direction")
    known = not direction or direction in DIRECTIONS
    return "" if known else f"direction {direction!r} is none of {', '.join(DIRECTIONS)}"


def _model_of(document: YamlText, findings: list[Finding]) -> str:
    """The one model the file is for; others are told."""
    first = ""
    told: set[str] = set()
    for node in items(document.root):
        for key in (BOTH, ROS, GZ):
            found = _MODEL.fullmatch(text_of(node, key))
            name = found["model"] if found else ""
            if not name or _PLACEHOLDER.search(name) or key == ROS:
                continue
            first = first or name
            if name != first and name not in told:
                told.add(name)
                message = f"model {name!r} beside {first!r}, of which there is one for each robot"
                hint = "its topics stay as they are, once for all robots"
                findings.append(_finding(document, node, "MF505", WARNING, message, hint))
    return first


def _entry(
    node: yaml.MappingNode, block: Block, context: Context, model: str, known: Mapping[str, str]
) -> _Entry:
    both = text_of(node, BOTH)
    ros = both or text_of(node, ROS) or text_of(node, GZ)
    gz = both or text_of(node, GZ) or text_of(node, ROS)
    bare_ros, bare_gz = (without_placeholder(name, "/") for name in (ros, gz))
    found = _MODEL.fullmatch(bare_gz)
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
    """A relative name would follow the namespace of the bridge; one to be filled in stays."""
    return name if _PLACEHOLDER.search(name) else f"/{name.lstrip('/')}"


def gz_topic(context: Context, name: str, gz_type: str = "") -> str:
    """A gz topic as the rewritten description and the spawned model have it."""
    found = _MODEL.fullmatch(name)
    rest = (found["rest"] or "") if found else name
    if _PLACEHOLDER.search(rest):
        return name
    if found:
        return found["above"] + MODEL + _PART.sub(lambda it: _part(context, it), rest)
    bare = name.strip("/")
    if bare in WORLD or bare.startswith("world/"):
        return name
    base, ending = _family(name, gz_type) if context.topics.naming.topics == POSTFIX else (name, "")
    return respell(context.topics, "topic", base, namespaced=False) + ending


def _part(context: Context, found: re.Match[str]) -> str:
    """A link, joint or sensor in a topic's name; one that is not declared stays."""
    kind, name = found.groups()
    known = is_declared(context.names, kind, name)
    return f"{kind}/{respell(context.names, kind, name) if known else name}"


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
    """One side's name, and the other's where the file leaves it to be the same."""
    other = GZ if key == ROS else ROS
    new = entry.new_ros if key == ROS else entry.new_gz
    alone = not text_of(entry.node, other) and entry.new_ros != entry.new_gz
    if alone or new != node.value:
        text = names[key] + (f"{ends}{other}: {names[other]}" if alone else "")
        yield Splice(node.start_mark.index, node.end_mark.index, text)


def _frame(node: yaml.ScalarNode, context: Context) -> Iterator[Splice]:
    new = respell(context.names, "frame", node.value)
    if new != node.value:
        yield replaced(node, new)


def _only(document: YamlText, kept: Sequence[_Entry]) -> list[Splice]:
    """The splices that take all other entries out of the file."""
    assert document.root is not None
    stay = {it.block for it in kept}
    found = blocks(document, document.root)
    return [Splice(it.start, it.end, "") for it in found if it not in stay]


def _remarks(document: YamlText, entry: _Entry, context: Context) -> Iterator[Finding]:
    node = entry.node
    if _PLACEHOLDER.search(entry.new_ros + entry.new_gz):
        message = f"{entry.ros!r} or its gz topic holds a placeholder that stays"
        hint = "fill it for each robot, or write the names of one robot without its own name"
        yield _finding(document, node, "MF503", WARNING, message, hint)
    elif not text_of(node, SERVICE) and not is_topic(entry.ros):
        message = f"{entry.ros!r} is no name of a ROS topic"
        yield _finding(document, node, "MF501", WARNING, message, f"give the entry a {ROS}")
    for kind, name in _PART.findall(entry.gz if MODEL in entry.new_gz else ""):
        if not is_declared(context.names, kind, name) and not _PLACEHOLDER.search(name):
            near = _near(name, context.names.declared.get(kind, ()))
            message = f"the description has no {kind} {name!r}{near}"
            yield _finding(document, node, "MF507", WARNING, message, "mend the name")
    if text_of(node, SERVICE) and not text_of(node, SERVICE).strip("/").startswith("world/"):
        message = f"service {text_of(node, SERVICE)!r} is bridged once for all robots"
        yield _finding(document, node, "MF503", WARNING, message, "name it by hand for each robot")
    for key, there in pairs(node):
        if key.value not in KEYS:
            message = (
                f"unknown key {key.value!r}, which the bridge reads over{_near(key.value, KEYS)}"
            )
            yield _finding(document, key, "MF504", WARNING, message, "mend the key")
        elif key.value not in (BOTH, ROS, GZ, "frame_id") and _is_mention(there, context):
            message = (
                f"{there.value!r} is a link or joint, and nothing known says what it means here"
            )
            yield _finding(document, there, "MF508", WARNING, message, "rename it by hand")


def _is_mention(node: yaml.Node, context: Context) -> bool:
    known = context.names
    return is_text(node) and any(is_declared(known, it, node.value) for it in ("link", "joint"))


def _near(name: str, known: Iterable[str]) -> str:
    near = did_you_mean(name, known)
    return f", {near}" if near else ""


def _finding(
    document: YamlText, node: yaml.Node, code: str, level: str, message: str, hint: str
) -> Finding:
    mark = node.start_mark
    return Finding(code, level, message, hint, document.file, mark.line + 1, mark.column + 1)


def as_spawned(carried: Iterable[Bridged], robots: Iterable[Described]) -> list[Bridged]:
    """What descriptions say has to be carried, below the names that the models are spawned by.

    ``ros_gz_sim create -name`` gives a model another name than its description has.
    """
    names = {it.spec.namespace: it for it in robots}
    return [_spawned(it, names[it.robot]) if it.robot in names else it for it in carried]


def _spawned(it: Bridged, robot: Described) -> Bridged:
    # Where frames stay bare the generated name is the robot's, not that of the description.
    inner = robot.member.inventory.document.root.get("name", "")
    found = _MODEL.fullmatch(it.gz)
    if not found or found["model"] not in (inner, robot.spec.namespace):
        return it
    return it._replace(gz=f"{found['above']}{robot.spec.model}{found['rest'] or ''}")


def merged(
    texts: Iterable[tuple[str, str]], generated: Iterable[Bridged]
) -> tuple[str, tuple[Finding, ...]]:
    """One file of several (file, text) and what descriptions say has to be carried.

    An entry of a file wins over a generated one of the same gz topic. Two gz topics that would come
    out on one ROS topic are an error.
    """
    parts: list[str] = []
    findings: list[Finding] = []
    carried: dict[str, tuple[int, str]] = {}
    for at, (file, text) in enumerate(texts):
        document = read_yaml(text.encode(), file)
        root = document.root
        if not isinstance(root, yaml.SequenceNode) or not root.value:
            continue
        for node, (start, end, column) in zip(root.value, blocks(document, root), strict=True):
            gz = _full(text_of(node, BOTH) or text_of(node, GZ) or text_of(node, ROS))
            ros = _full(text_of(node, BOTH) or text_of(node, ROS) or text_of(node, GZ))
            # What several files carry for all, as the clock, one does.
            if carried.setdefault(gz, (at, ros))[0] == at:
                findings += _meeting(document, node, gz, ros, carried)
                parts.append(moved(cut_out(document, start, end), -column))
    more = [it for it in generated if _full(it.gz) not in carried]
    return "".join(parts) + as_yaml(more), tuple(findings)


def _full(name: str) -> str:
    return f"/{name.lstrip('/')}"


def _meeting(
    document: YamlText, node: yaml.Node, gz: str, ros: str, carried: Mapping[str, tuple[int, str]]
) -> Iterator[Finding]:
    first = next((other for other, (_, name) in carried.items() if name == ros), gz)
    if first != gz and ros not in TF and text_of(node, "direction") != "ROS_TO_GZ":
        message = f"gz topics {first} and {gz} both come out on {ros}"
        yield _finding(document, node, "MF506", ERROR, message, "give each a ROS topic of its own")
