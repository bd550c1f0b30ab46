"""Names in a section that a rewrite cannot spell for several robots."""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.names.by_kind import (
    expressible,
    frames_differ,
    is_plain,
)
from multibot_rewrite.companions.names.placeholders import is_robot
from multibot_rewrite.companions.names.rename_map import is_declared
from multibot_rewrite.companions.params.values import ParamsJob
from multibot_rewrite.companions.sites import Site, found_in
from multibot_rewrite.companions.yaml_text import YamlText, found_at
from multibot_rewrite.knowledge.parameter_entries import PREFIX_KINDS, RUN_TIME

# Patterns that match everything or nothing hold no robot's name.
_OPEN_PATTERNS = frozenset({".*", "*", "[*]", "(?!)", "^$"})


def name_findings(job: ParamsJob, site: Site) -> Iterator[Finding]:
    """The finding about the rewrite of one name, if any."""
    if site.kind in ("stem", "link_prefix", *PREFIX_KINDS):
        yield from _inexpressible(job, site)
    elif site.kind in RUN_TIME and not job.context.names.naming.layout.at_run_time:
        yield from _prefix_twice(job, site)
    elif site.kind == "exclusive":
        yield from _same_for_all(job, site)
    elif site.kind in ("pattern", "text"):
        yield from _not_rewritten(job, site)


PREFIX_ONLY = declare(
    "MF117",
    "parameter-adds-prefix-only",
    WARNING,
    what="A parameter, or the link_prefix of an IKFast solver, can only put something before names, "
    "but the fleet puts the robot's name behind them.",
    why="The node makes its frames or joints out of this parameter: none of them gets the robot's "
    "name, so two robots publish the same frames.",
    fix="Set affix: prefix in the fleet file.",
    bad="""\
camera:
  ros__parameters:
    camera_name: front
""",
    good="""\
usb_cam:
  ros__parameters:
    frame_id: lidar_link
""",
    line=3,
    formats=("params",),
    options={"affix": "postfix"},
)


def prefix_only(document: YamlText, node: yaml.Node, name: str) -> Finding:
    """The finding about a parameter that cannot express a postfix."""
    return found_at(document, node, PREFIX_ONLY, *prefix_only_message(name))


def prefix_only_message(name: str) -> tuple[str, str]:
    """Message and hint."""
    return f"{name} can only add a prefix, but the fleet uses a postfix", "set affix: prefix"


def _inexpressible(job: ParamsJob, site: Site) -> Iterator[Finding]:
    if not expressible(job.context, site.kind):
        yield found_in(job.document.file, site.slot, PREFIX_ONLY, *prefix_only_message(site.key))


PREFIX_TWICE = declare(
    "MF115",
    "frame-prefix-twice",
    ERROR,
    what="A parameter adds a prefix to frames that have the robot's name already. It is a warning "
    "where all robots use the same frames or a launch file sets the prefix.",
    why="robot_state_publisher sends robot1/robot1/base_link, and all others look for "
    "robot1/base_link: no transform is found.",
    fix='Write "".',
    bad="""\
robot_state_publisher:
  ros__parameters:
    frame_prefix: rover/
""",
    good="""\
robot_state_publisher:
  ros__parameters:
    frame_prefix: ""
""",
    line=3,
    formats=("params",),
)


def _prefix_twice(job: ParamsJob, site: Site) -> Iterator[Finding]:
    if not site.text or is_robot(site.text):
        return  # there is none, or none is filled in
    certain = frames_differ(job.context) and is_plain(site.text)
    message = f"{site.key} {site.text!r} adds a prefix to frames a second time"
    found = found_in(job.document.file, site.slot, PREFIX_TWICE, message, 'write ""')
    yield found if certain else found._replace(level=WARNING)


SAME_FOR_ALL = declare(
    "MF118",
    "same-port-or-file",
    WARNING,
    what="A port, file or other thing that only one node can have is the same for all robots.",
    why="The node of the second robot cannot open the port, or both write into one file and damage it.",
    fix="Set it for each robot, in a parameter file that is loaded after this one.",
    bad="""\
rosbridge_websocket:
  ros__parameters:
    port: 9090
""",
    good="""\
rosbridge_websocket:
  ros__parameters:
    max_message_size: 1000000
""",
    line=3,
    formats=("params",),
)


def _same_for_all(job: ParamsJob, site: Site) -> Iterator[Finding]:
    if site.text and site.text.lower() not in ("false", "no", "off"):
        message = f"{site.key} {site.text} is the same for all robots"
        hint = "set it for each robot, in a parameter file that is loaded after this one"
        yield found_in(job.document.file, site.slot, SAME_FOR_ALL, message, hint)


NOT_REWRITTEN = declare(
    "MF122",
    "pattern-not-rewritten",
    WARNING,
    what="A pattern or expression may hold names, which are not rewritten.",
    why="Topics and frames get the robot's name, but the pattern still has the old ones: it matches "
    "nothing, or the names of all robots.",
    fix="Check that it works for each robot, or write one that matches in any namespace.",
    bad="""\
foxglove_bridge:
  ros__parameters:
    topic_whitelist: ["/scan.*"]
""",
    good="""\
foxglove_bridge:
  ros__parameters:
    topic_whitelist: [".*"]
""",
    line=3,
    formats=("params",),
)


def _not_rewritten(job: ParamsJob, site: Site) -> Iterator[Finding]:
    sure = site.kind == "pattern" or _mentions(job.context, site.text)
    if sure and site.text not in _OPEN_PATTERNS:
        message = f"names in {site.key} {site.text!r} are not rewritten"
        hint = "check that it works for each robot"
        yield found_in(job.document.file, site.slot, NOT_REWRITTEN, message, hint)


def _mentions(context: Context, value: str) -> bool:
    words = "".join(c if c.isalnum() or c in "_-/" else " " for c in value).split()
    return any(is_declared(context.names, kind, it) for it in words for kind in ("link", "joint"))
