"""The names in a section -> splices that rename them for a robot, and findings about them."""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.releases import RELEASES, has_release
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.names.by_kind import SPELLERS, is_component, is_plain
from multibot_rewrite.companions.names.node_topics import (
    FROM_NODE,
    FROM_PARENT,
    IN_FULL,
    Facts,
    spell_topic,
)
from multibot_rewrite.companions.names.placeholders import filled, is_robot
from multibot_rewrite.companions.names.rename_map import is_declared
from multibot_rewrite.companions.params.name_sites import NameSite, SectionNames
from multibot_rewrite.companions.params.sections import ParamSection
from multibot_rewrite.companions.template import NAMESPACE_SLOT, TAG_SLOT
from multibot_rewrite.companions.yaml_text import Splice, YamlText, found_at, pairs, replaced
from multibot_rewrite.knowledge.parameter_entries import GRAPH_NAME_KINDS, RUN_TIME, SWITCH_KINDS
from multibot_rewrite.knowledge.parameters import KnownNodes, is_absolute
from multibot_rewrite.knowledge.records import Param

# Controllers make an empty prefix of it; an empty parameter may stand for the namespace.
NO_PREFIX = "/"
SIM_TIME = "use_sim_time"
# Kinds that are only guessed where the description declares the name.
_UNSURE = ("frame", "sensor", "interface")


class ParamsJob(NamedTuple):
    """One parameter file to rewrite, and all that its steps need.

    ``own`` are the words for the one robot that the file is for. ``at_run_time`` are nodes that put the
    robot's name before their frames themselves. ``clock`` is their ``use_sim_time``, None where
    nothing says.
    """

    document: YamlText
    context: Context
    known: KnownNodes
    facts: Facts
    own: tuple[str, ...] = ()
    at_run_time: frozenset[str] = frozenset()
    clock: bool | None = None


def clock_splices(job: ParamsJob, section: ParamSection) -> Iterator[Splice]:
    """The clock that the fleet file says, where a section says one: from Jazzy on a file counts more
    than the launch argument of nav2_bringup, and nodes of one robot need one clock."""
    if job.clock is None or section.shared:
        return
    text = "true" if job.clock else "false"
    for key, value in pairs(section.body):
        told = isinstance(value, yaml.ScalarNode) and not PLACEHOLDER.search(value.value)
        if key.value == SIM_TIME and told and value.value.lower() != text:
            yield Splice(value.start_mark.index, value.end_mark.index, text)


def name_splices(
    job: ParamsJob, section: ParamSection, names: SectionNames
) -> Iterator[Splice | Finding]:
    """A splice for every name of a section that changes, and a finding where that is not possible."""
    keys: dict[int, tuple[yaml.ScalarNode, list[str]]] = {}
    bare = frames_stay(job, section)
    for site in names.sites:
        if bare and site.kind == "frame":
            yield from _replaced(job, site, site.value)
            continue
        if site.at >= 0:
            words = keys.setdefault(
                id(site.scalar), (site.scalar, str(site.scalar.value).split("."))
            )[1]
            words[site.at] = renamed(job.context, site)
        elif is_filled(site):
            yield from _replaced(job, site, _as_robot(job, site))
        elif site.kind in ("topic", "service"):
            yield from _topic(job, section, site)
        elif site.kind in SPELLERS:
            yield from _replaced(job, site, renamed(job.context, _as_read(job, section, site)))
        elif site.kind == "off":
            yield from _off(job, site)
        elif site.kind == "no_prefix":
            yield from _no_prefix(job, site)
    yield from _filled(job, names)
    for key, words in keys.values():
        if (text := ".".join(words)) != key.value:
            yield replaced(key, text)


def is_filled(site: NameSite) -> bool:
    """Does a value stand for the robot alone? A switch for a prefix has an answer of its own."""
    return is_robot(site.value) and site.kind not in SWITCH_KINDS


def _as_robot(job: ParamsJob, site: NameSite) -> str:
    """What stands for the robot alone: its name, and no prefix where frames have it already."""
    if site.kind in RUN_TIME:
        run_time = job.context.names.naming.layout.at_run_time
        return renamed(job.context, site) if run_time else ""
    return NAMESPACE_SLOT if site.kind in GRAPH_NAME_KINDS else TAG_SLOT


def _filled(job: ParamsJob, names: SectionNames) -> Iterator[Splice]:
    """Values that are not known to be names, with what stands for the robot in them filled in."""
    for scalar in (*names.unclaimed, *names.kept):
        text = filled(str(scalar.value), NAMESPACE_SLOT)
        if text != scalar.value and scalar.style not in ("|", ">"):
            yield replaced(scalar, text)


def frames_stay(job: ParamsJob, section: ParamSection) -> bool:
    """Does the node of a section put the robot's name before its frames?"""
    return section.path.rpartition("/")[2] in job.at_run_time


def renamed(context: Context, site: NameSite) -> str:
    """The name of a site for a robot; topics and services also depend on the node's remap rules."""
    # A value that is a frame only by its parameter's name may be a word such as enu.
    guessed = site.param is None and site.kind in _UNSURE
    if guessed and not _is_certain(context, site):
        return site.value
    speller = SPELLERS.get(site.kind)
    return speller(context, site.value) if speller else site.value


def is_stripped(job: ParamsJob, section: ParamSection, site: NameSite) -> bool:
    """Does the node take off a slash that this frame starts with?"""
    words = section.node.facts.strips if section.node and site.kind == "frame" else ""
    return bool(words) and site.at < 0 and has_release(words, job.context.distro)


def _as_read(job: ParamsJob, section: ParamSection, site: NameSite) -> NameSite:
    if not is_stripped(job, section, site) or not is_plain(site.value):
        return site
    return site._replace(value=site.value.removeprefix("/"))


def _is_certain(context: Context, site: NameSite) -> bool:
    if site.kind == "interface":
        return any(is_component(context, it) for it in site.value.split("/")[:-1])
    return is_declared(context.names, site.kind, site.value.lstrip("/")) or site.value == "odom"


TEXT_BLOCK = declare(
    "MF119",
    "name-in-text-block",
    WARNING,
    what="A name is written as a block of text (| or >), so it is not rewritten.",
    why="The name stays that of one robot, and a block adds a line break to it, which no frame or "
    "topic has.",
    fix="Write the name on one line.",
    bad="""\
amcl:
  ros__parameters:
    base_frame_id: |
      base_link
""",
    good="""\
amcl:
  ros__parameters:
    base_frame_id: base_link
""",
    line=3,
    formats=("params",),
)


def _replaced(job: ParamsJob, site: NameSite, text: str) -> Iterator[Splice | Finding]:
    if text == site.scalar.value:
        return
    if site.scalar.style in ("|", ">"):
        message = f"{site.key.value} is a block of text, so the name in it is not rewritten"
        hint = f"write it on one line: {site.key.value}: {site.value.strip()}"
        yield found_at(job.document, site.scalar, TEXT_BLOCK, message, hint)
        return
    yield replaced(site.scalar, text)


WRONG_TARGET = declare(
    "MF120",
    "parameter-topic-remapped",
    WARNING,
    what="The remap rules of a node turn a topic that a parameter names into another one than they did "
    "for a single robot.",
    why="Remap rules also match names that come from parameters, and in a namespace another rule may "
    "match: the node uses a topic that nobody else uses.",
    fix="Remove the name from the remap rules of the node, or from the file.",
    bad="""\
slam_toolbox:
  ros__parameters:
    scan_topic: scan
""",
    good="""\
slam_toolbox:
  ros__parameters:
    scan_topic: front
""",
    line=3,
    formats=("params",),
    beside={"nodes.yaml": "stacks: {own: {nodes: [{node: slam_toolbox, remaps: {/scan: front}}]}}"},
    options={"stack": "own", "nodes": "nodes.yaml"},
)

MADE_ABSOLUTE = declare(
    "MF121",
    "costmap-topic-made-absolute",
    WARNING,
    what="A relative topic of a costmap layer is made absolute.",
    why="Up to Jazzy, the costmap resolves scan as /robot1/local_costmap/scan, where nobody publishes: "
    "it never sees an obstacle (navigation2 #1433, #3772). From Kilted on it resolves the topic in the "
    "robot's namespace.",
    fix="Nothing has to be done; a topic with a slash before it is not reported. If the file is for "
    "Kilted or later, name that release in the fleet file (distro:) or with --distro.",
    bad="""\
local_costmap:
  local_costmap:
    ros__parameters:
      obstacle_layer: {scan: {topic: scan}}
""",
    good="""\
local_costmap:
  local_costmap:
    ros__parameters:
      obstacle_layer: {scan: {topic: /scan}}
""",
    line=4,
    formats=("params",),
    options={"distro": "jazzy"},
)


def _topic(job: ParamsJob, section: ParamSection, site: NameSite) -> Iterator[Splice | Finding]:
    # A pattern such as /**/amcl is for the node of that name.
    node = section.path.rpartition("/")[2] if section.wild else section.path
    reach = _reach(job, section, site)
    result = spell_topic(job.context, node, site.kind, site.value, reach, job.facts)
    yield from _replaced(job, site, result.text)
    if result.wrong_target:
        message = f"{site.key.value}: remap rules turn {result.text} into {result.wrong_target}"
        hint = "remove the name from the remap rules of this node or from this file"
        yield found_at(job.document, site.scalar, WRONG_TARGET, message, hint)
    if result.made_absolute and result.text != site.value:
        message = "relative topics of a costmap are resolved below the costmap: made absolute"
        hint = f"{_others(site.param)} resolve them below the robot: set distro: if the file is for one"
        yield found_at(job.document, site.scalar, MADE_ABSOLUTE, message, hint)


def _reach(job: ParamsJob, section: ParamSection, site: NameSite) -> str:
    if site.param is None or not site.param.absolute:
        return FROM_NODE
    if is_absolute(site.param, job.context.distro) or _is_binary_filter(site):
        return IN_FULL
    return FROM_PARENT


def _others(param: Param | None) -> str:
    """The releases that resolve a relative topic in the robot's namespace."""
    found = [it for it in RELEASES if param and not is_absolute(param, it)]
    return f"{', '.join(found[:-1])} and {found[-1]}" if len(found) > 1 else "".join(found)


def _is_binary_filter(site: NameSite) -> bool:
    """The one filter that does not resolve its topics in the robot's namespace."""
    layer = {key.value: value.value for key, value in pairs(site.layer)}
    return "BinaryFilter" in str(layer.get("plugin", ""))


UNCLEAR_SWITCH = declare(
    "MF116",
    "frame-prefix-switch-unclear",
    WARNING,
    what="A launch file sets a parameter that must be false, or a prefix that must be /, because it "
    "adds the namespace to frames.",
    why="The frames have the robot's name already. With true, odom becomes robot1/robot1/odom, and no "
    "transform is found (ros2_controllers #482, #1048).",
    fix="Write false, or make sure that the launch file sets false.",
    bad="""\
diff_drive_controller:
  ros__parameters:
    tf_frame_prefix_enable: $(var prefix)
""",
    good="""\
diff_drive_controller:
  ros__parameters:
    tf_frame_prefix_enable: false
""",
    line=3,
    formats=("params",),
    options={"distro": "kilted"},
)


def _off(job: ParamsJob, site: NameSite) -> Iterator[Splice | Finding]:
    """A switch that makes the node put a namespace before frames that are renamed already."""
    if site.value.lower() in ("true", "yes", "on", "y"):
        yield Splice(site.scalar.start_mark.index, site.scalar.end_mark.index, "false")
    elif _is_open(site):
        message = f"{site.key.value} is {site.value} and must turn out false"
        hint = "true adds the namespace to frames that already have the robot's name"
        yield found_at(job.document, site.scalar, UNCLEAR_SWITCH, message, hint)


def _no_prefix(job: ParamsJob, site: NameSite) -> Iterator[Splice | Finding]:
    """A prefix for frames that are renamed already; a default says what an empty one stands for."""
    if _is_open(site):
        message = f"{site.key.value} is {site.value} and must turn out {NO_PREFIX}"
        hint = "a prefix is put before frames that already have the robot's name"
        yield found_at(job.document, site.scalar, UNCLEAR_SWITCH, message, hint)
    elif site.value != NO_PREFIX and (site.value or (site.param and site.param.default)):
        yield replaced(site.scalar, NO_PREFIX)


def _is_open(site: NameSite) -> bool:
    """Does only a launch file tell the value?"""
    return "$" in site.value or "<" in site.value
