# SPDX-License-Identifier: Apache-2.0
"""The names in a section -> splices that rename them for a robot, and findings about them."""

from collections.abc import Iterator
from typing import NamedTuple

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.findings.finding import WARNING, Finding, declare
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.knowledge.node_entries import GRAPH_NAME_KINDS, RUN_TIME, SWITCH_KINDS
from multibot_rewrite.knowledge.parameters import KnownNodes, is_absolute
from multibot_rewrite.related_files.context import NAMESPACE_SLOT, TAG_SLOT, Context
from multibot_rewrite.related_files.engine import GRAPH, spell_site, splices_of, written
from multibot_rewrite.related_files.names.by_kind import (
    SPELLERS,
    is_component,
    is_emptied,
    is_plain,
)
from multibot_rewrite.related_files.names.node_topics import Facts, TopicText
from multibot_rewrite.related_files.names.placeholders import filled, is_robot
from multibot_rewrite.related_files.names.rename_map import KINDS, is_declared
from multibot_rewrite.related_files.params.name_sites import SectionNames, name_in
from multibot_rewrite.related_files.params.sections import ParamSection
from multibot_rewrite.related_files.sites import Site, found_in
from multibot_rewrite.related_files.yaml_text import Splice, YamlText, pairs, replaced

# Frames and links are one tree; the odometry's frame is in it, and in no description.
FRAMES = ("frame", "link")
ODOM = "odom"


def is_guessed(section: ParamSection) -> bool:
    """Return whether a section is for one node, of which nothing is known."""
    return section.node is None and not section.wild


def in_doubt(
    context: Context, section: ParamSection, names: SectionNames
) -> dict[str, yaml.ScalarNode]:
    """Return the kinds of names that stay in a section, each with a value that may be one of them."""
    found: dict[str, yaml.ScalarNode] = {}
    # ``odom`` alone may be a topic.
    has_frame = any(it.kind in FRAMES for it in names.sites)
    for scalar in names.unclaimed if is_guessed(section) and names.sites else ():
        text = name_in(scalar)
        bare = text.removeprefix("/")
        if is_declared(context.names, "frame", bare) or (bare == ODOM and has_frame):
            for kind in FRAMES:
                found.setdefault(kind, scalar)
        elif is_declared(context.names, "joint", text):
            found.setdefault("joint", scalar)
    return found


# Controllers make an empty prefix of it; an empty parameter may stand for the namespace.
NO_PREFIX = "/"
SIM_TIME = "use_sim_time"
# Kinds that are only guessed where the description declares the name: none declares a prefix.
_UNSURE = ("frame", "sensor", "interface", *RUN_TIME)
_SPELLED = frozenset((*GRAPH, *SPELLERS))


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
    """Yield the fleet file's clock in place of a section's own."""
    # From Jazzy on a file counts more than the launch argument of nav2_bringup, and nodes of one
    # robot need one clock.
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
    """Yield a splice for each name of a section that changes, or a finding if it cannot."""
    stay = frames_stay(job, section)
    doubt = in_doubt(job.context, section, names)
    found = [it for it in names.sites if it.kind not in doubt]
    sites = [it for it in found if it.in_key or is_filled(it) or it.kind in _SPELLED]
    made = [(it, _new_name(job, it, stay)) for it in sites]
    document = job.document
    yield from splices_of(document.text, document.file, ((it, new.text) for it, new in made))
    for site, new in made:
        yield from _topic_findings(job, site, new)
    for site in names.sites:
        if site.kind in SWITCH_KINDS:
            yield from _switch_off(job, site)
    # Values that are not known to be names, with what stands for the robot in them filled in.
    for scalar in (*names.unclaimed, *names.kept):
        text = filled(str(scalar.value), NAMESPACE_SLOT)
        if text != scalar.value and scalar.style not in ("|", ">"):
            yield replaced(scalar, text)


def is_filled(site: Site) -> bool:
    """Return whether a value is only the robot's name. A switch for a prefix is handled on its own."""
    return is_robot(site.text) and site.kind not in SWITCH_KINDS


def _new_name(job: ParamsJob, site: Site, stays: bool) -> TopicText:
    """Return the new name; ``stays`` if the node puts the robot's name before its frames."""
    if stays and site.kind == "frame":
        return TopicText(site.text)
    if is_filled(site) and not site.in_key:
        if site.kind not in RUN_TIME:
            return TopicText(NAMESPACE_SLOT if site.kind in GRAPH_NAME_KINDS else TAG_SLOT)
        # No prefix where frames have it already.
        run_time = job.context.names.naming.layout.at_run_time
        return TopicText(renamed(job.context, site) if run_time else "")
    if is_emptied(job.context, site.kind, site.text) and not site.in_key:
        return TopicText("")
    if site.bare and is_plain(site.text):
        site = site._replace(text=site.text.removeprefix("/"))
    if site.in_key or site.kind not in GRAPH:
        return TopicText(renamed(job.context, site))
    return spell_site(job.context, job.facts, site)


def frames_stay(job: ParamsJob, section: ParamSection) -> bool:
    """Return whether the node of a section puts the robot's name before its frames."""
    return section.path.rpartition("/")[2] in job.at_run_time


def renamed(context: Context, site: Site) -> str:
    """Return the name of a site for a robot; for topics the node's remap rules count, too."""
    # A value that is a frame only by its parameter's name may be a word such as enu.
    guessed = not site.is_sure and site.kind in _UNSURE
    if site.kind == "interface":
        certain = any(is_component(context, it) for it in site.text.split("/")[:-1])
    else:
        known = site.kind in KINDS and is_declared(context.names, site.kind, site.text.lstrip("/"))
        certain = known or site.text == "odom"
    if site.kind in GRAPH or (guessed and not certain):
        return site.text
    return spell_site(context, {}, site).text


WRONG_TARGET = declare(
    "MF120",
    "parameter-topic-remapped",
    WARNING,
    formats=("params",),
    options={"node_sets": "own", "nodes": "nodes.yaml"},
)

MADE_ABSOLUTE = declare(
    "MF121",
    "costmap-topic-made-absolute",
    WARNING,
    formats=("params",),
    options={"distro": "jazzy"},
)


def _topic_findings(job: ParamsJob, site: Site, made: TopicText) -> Iterator[Finding]:
    if made.wrong_target:
        message = f"{site.key}: remap rules turn {made.text} into {made.wrong_target}"
        hint = "remove the name from the remap rules of this node or from this file"
        yield found_in(job.document.file, site.slot, WRONG_TARGET, message, hint)
    if site.param and made.made_absolute and made.text != site.text:
        message = "relative topics of a costmap are resolved below the costmap: made absolute"
        found = [it for it in RELEASES if not is_absolute(site.param, it)]
        others = f"{', '.join(found[:-1])} and {found[-1]}" if len(found) > 1 else "".join(found)
        hint = f"{others} resolve them below the robot: set distro: if the file is for one"
        yield found_in(job.document.file, site.slot, MADE_ABSOLUTE, message, hint)


UNCLEAR_SWITCH = declare(
    "MF116",
    "frame-prefix-switch-unclear",
    WARNING,
    formats=("params",),
    options={"distro": "kilted"},
)


def _switch_off(job: ParamsJob, site: Site) -> Iterator[Splice | Finding]:
    """Yield the change that turns off a switch or prefix for frames that are renamed already."""
    # A default says what an empty prefix means.
    is_off, text = site.kind == "off", site.text
    wanted = "false" if is_off else NO_PREFIX
    if is_off and text.lower() in ("true", "yes", "on", "y"):
        yield Splice(site.slot.start, site.slot.end, wanted)
    elif "$" in text or "<" in text:
        # Only a launch file tells the value.
        what = "true adds the namespace to" if is_off else "a prefix is put before"
        message = f"{site.key} is {text} and must turn out {wanted}"
        hint = f"{what} frames that already have the robot's name"
        yield found_in(job.document.file, site.slot, UNCLEAR_SWITCH, message, hint)
    elif not is_off and text != wanted and (text or (site.param and site.param.default)):
        yield written(job.document.text, job.document.file, site.slot, wanted)
