# SPDX-License-Identifier: Apache-2.0
"""Rewrites a ros_gz_bridge file: entries for each robot, and those that all share.

Sources: gazebosim/ros_gz jazzy ros_gz_bridge/src/bridge_config.cpp (parseEntry, and its
messages); gz-sim's names ``/model/<name>/...``."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.base.bounded import compose_yaml
from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import POSTFIX, spelled
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.base.releases import OF_OLD
from multibot_rewrite.description.rewriters.forms import NamePart
from multibot_rewrite.description.rewriters.model_namespaces import STEM, parts_of
from multibot_rewrite.related_files.context import Context, FileTemplate, make_template
from multibot_rewrite.related_files.engine import splices_of, text_of as spelled_text
from multibot_rewrite.related_files.named_file import BRIDGE, NamedFile, RelatedFile
from multibot_rewrite.related_files.names.node_topics import NOTHING, robot_topic
from multibot_rewrite.related_files.names.placeholders import without_robot
from multibot_rewrite.related_files.names.rename_map import is_declared, spell
from multibot_rewrite.related_files.rviz.read_config import text_of
from multibot_rewrite.related_files.sites import GZ_TOPIC, Site, site_at
from multibot_rewrite.related_files.yaml_text import (
    Block,
    Splice,
    YamlText,
    blocks,
    cut_out,
    is_block,
    is_text,
    items,
    newline,
    pairs,
    quoted,
    refuse_anchors,
    refused,
    replaced,
)

# Stands for the name of the spawned model: it may differ from the namespace and the tag.
MODEL_SLOT = "multibotModelSlot"
BOTH, ROS, GZ = "topic_name", "ros_topic_name", "gz_topic_name"
TYPES = ("ros_type_name", "gz_type_name")
DIRECTIONS = ("BIDIRECTIONAL", "GZ_TO_ROS", "ROS_TO_GZ")
SERVICE, FRAME = "service_name", "frame_id"
KEYS: tuple[str, ...] = (BOTH, ROS, GZ, *TYPES, SERVICE, "direction", "publisher_queue")
KEYS += ("subscriber_queue", "lazy", "publish_optical_frame", FRAME, "qos_profile")
KEYS += ("gz_req_type_name", "gz_rep_type_name")
# What the bridge of Humble reads as these (bridge_config.cpp, branch humble; not in branch jazzy).
_OF_IGNITION = {"ign_type_name": TYPES[1], "ign_topic_name": GZ}
_OF_IGNITION |= {"IGN_TO_ROS": DIRECTIONS[1], "ROS_TO_IGN": DIRECTIONS[2]}
GZ_MODEL = re.compile(r"(?P<above>/?(?:world/[^/]+/)?model/)(?P<model>[^/]+)(?P<rest>/.*)?")
# A link, joint or sensor in a gz topic.
PART = re.compile(r"(?<=/)(link|joint|sensor)/([^/]+)")


class BridgeEntry(NamedTuple):
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


class RowFault(NamedTuple):
    """Why the bridge leaves an entry out, and the node that it is about."""

    node: yaml.Node
    message: str
    hint: str


Row = Mapping[str, tuple[yaml.ScalarNode, yaml.Node]]
_OUT = "the bridge leaves it out"


def row_of(node: yaml.Node) -> Row:
    """Return the keys and values of an entry by the texts of the keys."""
    return {str(key.value): (key, value) for key, value in pairs(node)}


def text_in(row: Row, key: str) -> str:
    """Return the value of a key as text; empty if it is missing or not a scalar."""
    value = row[key][1] if key in row else None
    return str(value.value) if isinstance(value, yaml.ScalarNode) else ""


def as_loaded(document: YamlText, release: str) -> YamlText:
    """Return a file with Ignition's words that a release reads as gz words; all keep their columns."""
    text, rows = document.text, [row_of(it) for it in items(document.root)]
    keys = [row[it][0] for row in rows for it in row if _OF_IGNITION.get(it, it) not in row]
    ways = [row["direction"][1] for row in rows if text_in(row, "direction") in _OF_IGNITION]
    for node in dict.fromkeys((*keys, *ways)) if release == OF_OLD else ():
        start, end = node.start_mark.index, node.end_mark.index
        new = _OF_IGNITION[node.value].join(text[start:end].rsplit(node.value, 1))
        padded = (new.ljust if node in keys else new.rjust)(end - start)
        text = text[:start] + padded + text[end:]
    root = document.root if text == document.text else compose_yaml(text, document.file)
    return document._replace(text=text, root=root)


def faults(node: yaml.Node) -> Iterator[RowFault]:
    """Yield for an entry each reason why the bridge does not load it."""
    row = row_of(node)
    if not row:
        yield RowFault(node, f"the row is not a map of keys and values: {_OUT}", "")
        return
    for other in (ROS, GZ) if BOTH in row else ():
        if other in row:
            message = f"the row has {BOTH} and {other}: {_OUT}"
            yield RowFault(row[other][0], message, f"delete {BOTH}")
    direction = text_in(row, "direction")
    if direction and direction not in DIRECTIONS:
        hint = did_you_mean_one_of(direction, DIRECTIONS)
        message = f"the bridge has no direction {direction!r}: {_OUT}"
        yield RowFault(row["direction"][1], message, hint)
    lacks = " and ".join(it for it in TYPES if not text_in(row, it))
    if not any(text_in(row, it) for it in (BOTH, ROS, GZ)):
        lacks = ROS
    if lacks and not text_in(row, SERVICE):
        yield RowFault(node, f"the row has no {lacks}: {_OUT}", f"add {lacks}")


def below(name: str, above: str) -> str:
    """Return a ROS name of a bridge that runs in the namespace ``above`` below the robot's."""
    return f"/{above}/{name}" if above and not name.startswith("/") else name


def models(document: YamlText, context: Context) -> Iterator[tuple[yaml.Node, str]]:
    """Yield (entry, model) for each entry that is for a model, but not for one of the world."""
    for node in items(document.root):
        for key in (BOTH, GZ):
            found = GZ_MODEL.fullmatch(text_in(row_of(node), key))
            name = found["model"] if found else ""
            if found and name not in context.of_world and not PLACEHOLDER.search(name):
                yield node, name


def model_of(document: YamlText, context: Context) -> str:
    """Return the model that a file is for: the first in its gz topics, empty for none."""
    return next((name for _, name in models(document, context)), "")


# gz topics of the whole simulation, like those below /world.
WORLD = frozenset({"clock", "stats"})


class BridgeFile(NamedTuple):
    """A bridge file: each robot's entries with slots, the shared text, and both with slots."""

    own: RelatedFile
    shared: str
    whole: FileTemplate


def rewrite_bridge(
    document: YamlText, context: Context, known: Mapping[str, str] = NOTHING, above: str = ""
) -> BridgeFile:
    """Return the entries that each robot needs for itself, and those for all robots.

    ``known`` is ``fleet_topics`` of the namespace slot, ``above`` the namespace in the robot's that the
    file is for. Names come out in full, so neither the bridge's namespace nor its expansion of gz names
    changes them. Raises InputError for a file that is no list of entries.
    """
    document = as_loaded(document, context.distro)
    entries = _entries(document, context, known, above)
    own = [it for it in entries if it.own]
    shared = [it for it in entries if not it.own]
    named = _named_file(document, context, entries)
    frames = [site for it in own for site in _entry_sites(it) if site.kind == "frame"]
    made = ((it, spelled_text(context, {}, it)) for it in frames)
    splices = [splice for it in own for splice in _entry_splices(document, it)]
    splices += splices_of(document.text, document.file, made)
    template = (
        make_template(document.text, [*_cut_others(document, own), *splices])
        if own
        else make_template("", ())
    )
    text = cut_out(document, 0, len(document.text), _cut_others(document, shared)) if shared else ""
    whole = make_template(document.text, [*_cut_others(document, entries), *splices])
    return BridgeFile(RelatedFile(template, named), text, whole)


def read_bridge(document: YamlText, context: Context) -> NamedFile:
    """Return the names of a file, whatever its form; raises nothing."""
    document = as_loaded(document, context.distro)
    model, nowhere = model_of(document, context), Block(0, 0, 0)
    loaded = (it for it in items(document.root) if not any(faults(it)))
    maps = (it for it in loaded if isinstance(it, yaml.MappingNode))
    entries = [_entry_of(it, nowhere, context, model, NOTHING, "") for it in maps]
    return _named_file(document, context, entries)


def _entries(
    document: YamlText, context: Context, known: Mapping[str, str], above: str
) -> list[BridgeEntry]:
    """Return the entries that the bridge loads; raises InputError for a file without a list."""
    root = document.root
    if root is None:
        raise InputError(f"{document.file}: the bridge file is empty; write a list of topics")
    if not isinstance(root, yaml.SequenceNode):
        raise refused(document, root, "not a list of topics; start each entry with a dash")
    if root.value and not is_block(root):
        raise refused(document, root, "the list is in brackets; start each entry with a dash")
    refuse_anchors(document)
    model = model_of(document, context)
    found = zip(root.value, blocks(document, root), strict=True)
    return [
        _entry_of(node, block, context, model, known, above)
        for node, block in found
        if not any(faults(node))
    ]


def _named_file(document: YamlText, context: Context, entries: Iterable[BridgeEntry]) -> NamedFile:
    names = tuple(site for it in entries for site in _entry_sites(it))
    others = tuple(
        site_at(value, "", text_in(row, key), key)
        for row in (row_of(it.node) for it in entries)
        for key, (_, value) in row.items()
        if key in KEYS and key not in (BOTH, ROS, GZ, FRAME) and is_text(value)
    )
    return NamedFile(
        BRIDGE, document.file, document.text, context, {}, names, others, document=document
    )


def _entry_sites(entry: BridgeEntry) -> Iterator[Site]:
    row = row_of(entry.node)
    if not text_in(row, SERVICE):
        ros = next(it for it in (BOTH, ROS, GZ) if text_in(row, it))
        gz = next(it for it in (BOTH, GZ, ROS) if text_in(row, it))
        yield site_at(row[ros][1], "topic", entry.ros, ros)
        model = GZ_MODEL.fullmatch(entry.gz)
        bare = f"{model['above']}{model['rest'] or ''}" if model else entry.gz
        yield site_at(row[gz][1], GZ_TOPIC, bare, gz)
        for kind, name in PART.findall(entry.gz if MODEL_SLOT in entry.new_gz else ""):
            yield site_at(row[gz][1], kind, name, gz)
    if text_in(row, FRAME):
        yield site_at(row[FRAME][1], "frame", text_in(row, FRAME), FRAME)


def _entry_of(
    node: yaml.MappingNode,
    block: Block,
    context: Context,
    model: str,
    known: Mapping[str, str],
    above: str,
) -> BridgeEntry:
    both = text_of(node, BOTH)
    ros = both or text_of(node, ROS) or text_of(node, GZ)
    gz = both or text_of(node, GZ) or text_of(node, ROS)
    bare_ros, bare_gz = (without_robot(name, "/") for name in (ros, gz))
    bare_ros = below(bare_ros, above)
    made = _made_parts(context, bare_gz)
    found = None if made else GZ_MODEL.fullmatch(bare_gz)
    another = found and found["model"] != model and not PLACEHOLDER.search(found["model"])
    bare = bare_gz.strip("/")
    of_world = bare in context.of_world and bare not in context.names.given
    if text_of(node, SERVICE) or another or of_world:
        return BridgeEntry(node, block, ros, gz, ros, gz, False)
    new_gz = gz_topic(context, bare_gz, text_of(node, "gz_type_name"))
    new_ros = robot_topic(context.topics, bare_ros, known)
    own = new_gz != gz or new_ros != ros or bool(PLACEHOLDER.search(ros + gz))
    if own:
        new_gz, new_ros = _absolute(new_gz), _absolute(new_ros)
    return BridgeEntry(node, block, bare_ros, bare_gz, new_ros, new_gz, own)


def _absolute(name: str) -> str:
    """Return an absolute name, which the bridge's namespace does not change; a placeholder stays."""
    return name if PLACEHOLDER.search(name) else f"/{name.lstrip('/')}"


def gz_topic(context: Context, name: str, gz_type: str = "") -> str:
    """Return a gz topic as the rewritten description and the spawned model have it."""
    found = GZ_MODEL.fullmatch(name)
    rest = (found["rest"] or "") if found else name
    if PLACEHOLDER.search(rest):
        return name
    if made := _made_parts(context, name):
        # The topic with its names as the rewritten description has them.
        for it in reversed(made):
            (kind,) = it.matched
            names = context.topics if (kind,) == STEM else context.names
            spelled_part = spelled(names.naming, names.robot, kind, it.text)
            name = name[: it.at] + spelled_part + name[it.at + len(it.text) :]
        return name

    def part(found: re.Match[str]) -> str:
        """Return a matched ``kind/name`` of a topic with the robot's name of that."""
        kind, name = found.groups()
        known = is_declared(context.names, kind, name)
        return f"{kind}/{spell(context.names, kind, name) if known else name}"

    if found and found[0].lstrip("/") not in context.names.given:
        # A lidar's points are below the topic that the description names.
        above, _, last = name.rpartition("/")
        if above.lstrip("/") in context.names.given:
            return f"{gz_topic(context, above, gz_type)}/{last}"
        return found["above"] + MODEL_SLOT + PART.sub(part, rest)
    bare = name.strip("/")
    if bare in WORLD or bare.startswith("world/"):
        return name
    # gz-sim puts a camera's images and a lidar's points below the topic that the description names.
    is_behind = context.topics.naming.topics == POSTFIX
    base = name if is_behind else ""
    while base and base.lstrip("/") not in context.names.given:
        base = base.rpartition("/")[0]
    is_cloud = is_behind and "PointCloud" in gz_type
    base = base or (name.removesuffix("/points") if is_cloud else name) or name
    return spell(context.topics, "topic", base, namespaced=False) + name[len(base) :]


def _made_parts(context: Context, name: str) -> list[NamePart]:
    """Return the names in a topic that a Gazebo system builds from one of its parameters."""
    parts = [*parts_of(name, context.names.words, context.names.declared)]
    # The description spells what it gives in full: there the model is one of its names.
    naming, is_given = context.names.naming, name.lstrip("/") in context.names.given
    is_model = is_given and naming.layout.renames_models
    return parts if parts and (parts[0].kinds == STEM or is_model) else []


def _entry_splices(document: YamlText, entry: BridgeEntry) -> Iterator[Splice]:
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
            # The other side's name, too, if the file leaves it out because it is the same.
            other = GZ if key.value == ROS else ROS
            new = entry.new_ros if key.value == ROS else entry.new_gz
            single = not text_of(entry.node, other) and entry.new_ros != entry.new_gz
            if single or new != node.value:
                text = names[key.value] + (f"{ends}{other}: {names[other]}" if single else "")
                yield Splice(node.start_mark.index, node.end_mark.index, text)


def _cut_others(document: YamlText, kept: Sequence[BridgeEntry]) -> list[Splice]:
    """Return the splices that remove all other entries from the file."""
    assert document.root is not None
    stay = {it.block for it in kept}
    found = blocks(document, document.root)
    return [Splice(it.start, it.end, "") for it in found if it not in stay]
