# SPDX-License-Identifier: Apache-2.0
"""A plugin -> the ROS node it starts, with its endpoints, rules, frames; topics of other plugins.

Sources: gazebo_ros_pkgs ros2 gazebo_ros/src/node.cpp (a <ros> hides the plugin's own settings, the
plugin's name is the node's, an empty namespace is the root), gz_ros2_control_plugin.cpp.
"""

from collections.abc import Iterable, Iterator
from itertools import islice
from math import pi
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.model import SiteRow, UsageError
from multibot_rewrite.base.naming import TOPIC_KINDS
from multibot_rewrite.base.rosnames import (
    BoundNode,
    RemapRule,
    bind,
    expand,
    parse_remap,
    resolve_bound,
)
from multibot_rewrite.description.checks.numbers import value_of
from multibot_rewrite.description.readback.parameters import (
    sends_odometry,
    switched_off,
    values_of,
    wired_of,
)
from multibot_rewrite.description.readback.xml import child_text, text_of
from multibot_rewrite.description.rewriters.plugin_definitions import PluginDefinition
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import SENT
from multibot_rewrite.knowledge.controller_ways import controller_way

TOPIC, SERVICE, ACTION = "topic", "service", "action"
# A word that topics are made of, which is none itself.
BELOW = "topics below"
TF_TOPICS = ("/tf", "/tf_static")
REMAP_FLAGS = ("-r", "--remap")
PUBLISHES, SERVES = "publishes", "serves"
# Joints of arms turn twice at most from end to end; wheels are without limits, or with those of 1e16.
_SOME_TURNS = 10 * pi


class RuntimeName(NamedTuple):
    """A name in the running system and where it is from: the ``number``-th element with ``tag``.

    ``kind`` is topic, service, node, frame, or what a plugin looks up in the whole world;
    ``path`` is the parameter. ``type`` is empty if unknown. An end of a ROS node has ``role``
    and ``code_name``, its name in the code or in the ``parameter``; ``off`` are parameters that
    would turn it on. ``of_controllers``: of controllers to which the rules of their node do not
    apply."""

    kind: str
    name: str
    tag: str
    number: int
    path: str
    of_controllers: bool = False
    type: str = ""
    role: str = ""
    code_name: str = ""
    parameter: str = ""
    off: str = ""

    def element_in(self, root: _Element) -> _Element:
        """Return the name's element in a text with the same elements, or else the root."""
        return next(islice(root.iter(self.tag), self.number, None), root)


class ReadRule(NamedTuple):
    """A remap rule of a plugin, its line in the description that was read, and the tag it is in."""

    rule: RemapRule
    line: int
    tag: str


class ReadNode(NamedTuple):
    """The node of a plugin, which is the ``number``-th of the file.

    ``name`` and ``namespace`` are those that its rules ``__node`` and ``__ns`` make, ``rules`` the
    other ones; ``stems`` are parameters with what further topics are below; ``frames`` are
    parameters with the frames they hold, ``sends`` the parameters of parent and child of a
    transform it publishes. ``helper`` is a node that it starts in addition to its own, ``manager``
    the full name of the controller manager that it makes, if any."""

    section: PluginDefinition
    number: int
    name: str
    namespace: str
    rules: tuple[ReadRule, ...]
    endpoints: tuple[RuntimeName, ...]
    stems: tuple[tuple[str, str], ...]
    frames: tuple[tuple[str, str], ...]
    sends: tuple[tuple[str, str], ...]
    helper: str = ""
    manager: str = ""

    @property
    def full_name(self) -> str:
        """Namespace and name."""
        return f"{self.namespace.rstrip('/')}/{self.name}"


def node_of(
    plugin: _Element, number: int, section: PluginDefinition, release: str
) -> ReadNode | None:
    """Return the ROS 2 node that a plugin starts; None where it starts none."""
    paths = {site.path for site in section.sites}
    if "ros/namespace" not in paths:
        return None
    home = plugin.find("ros")
    if home is None and "namespace" in paths:
        home = plugin
    name = _node_name(plugin, section)
    namespace = "/" + ("" if home is None else child_text(home, "namespace") or "").strip("/")
    rules = tuple(() if home is None else _rules(home))
    bound = _bound(name, namespace, [it.rule for it in rules])
    # The namespace is the helper's; the node is where its own rules place it.
    helper = f"{namespace.rstrip('/')}/{section.helper}" if section.helper else ""
    name, namespace = bound.node, bound.namespace
    rules = tuple(it for it in rules if not it.rule.source.startswith("__"))
    frames = tuple(frames_of(plugin, section))
    # The parent and the child of the transform of odometry that it sends are its first two frames.
    of_odometry = "/tf" in section.publishes and len(frames) >= 2
    sends = of_odometry and sends_odometry(plugin, section)
    return ReadNode(
        section,
        number,
        name,
        namespace,
        rules,
        tuple(_endpoints(plugin, number, section, bound, rules, release)),
        tuple(
            (site.path, full_name(value, TOPIC, bound))
            for site in section.sites
            if site.form == "whole" and site.kinds[:1] == ("stem",)
            for value in values_of(plugin, site)
        ),
        frames,
        ((frames[0][0], frames[1][0]),) if sends else (),
        helper,
        _manager(plugin, section, name, namespace),
    )


def _manager(plugin: _Element, section: PluginDefinition, name: str, namespace: str) -> str:
    """Return the full name of a plugin's controller manager; empty without one."""
    site = next((it for it in section.sites if it.path == "controller_manager_name"), None)
    if site is None:
        return ""
    called = next(iter(values_of(plugin, site)), "") if _has_own_name(section) else name
    return f"{namespace.rstrip('/')}/{called}"


def wheels_in(element: _Element) -> bool:
    """Return whether a controller of this description may send odometry, and so /tf."""
    # Those that do command velocities of joints that turn (command_interface_configuration of
    # ros2_controllers: diff_drive_controller, tricycle_controller, mecanum_drive_controller,
    # omni_wheel_drive_controller and steering_controllers_library).
    root = element.getroottree().getroot()
    joints = {it.get("name"): it for it in root.iter("joint") if it.get("type")}
    systems = list(root.iter("ros2_control"))
    commanded = (
        joint
        for system in systems
        for joint in system.iterchildren("joint")
        if any(it.get("name") == "velocity" for it in joint.iterchildren("command_interface"))
    )
    return not systems or any(_turns_on(joints.get(it.get("name"))) for it in commanded)


def _turns_on(joint: _Element | None) -> bool:
    """Return whether a joint may be a wheel's: its limits are missing or wide."""
    if joint is None:
        return True
    limit = joint.find("limit") if joint.get("type") == "revolute" else None
    if limit is None:
        return joint.get("type") not in ("prismatic", "fixed")
    lower, upper = (value_of(limit, it, 0.0) for it in ("lower", "upper"))
    return lower is None or upper is None or upper - lower > _SOME_TURNS


def itself(node: ReadNode) -> BoundNode:
    """Return a plugin's node under its final name and namespace, without rules for topics."""
    rules = (it.rule for it in node.rules if it.rule.source.startswith("__"))
    return _bound(node.name, node.namespace, rules)


def _node_name(plugin: _Element, section: PluginDefinition) -> str:
    """Return a Gazebo Classic plugin's own name, or that of the controller manager it loads."""
    if _has_own_name(section):
        return plugin.get("name", "").strip()
    sites = (site for site in section.sites if site.kinds[:1] == ("node",) and site.default)
    named = (value for site in sites for value in values_of(plugin, site))
    return next(named, "") or section.names[0].replace("-", "_")


def _has_own_name(section: PluginDefinition) -> bool:
    return any(site.path == "@name" for site in section.sites if site.role == "declares")


def rules_of(plugin: _Element) -> Iterator[RemapRule]:
    """Yield the remap rules in the ``<ros>`` of a plugin."""
    yield from (it.rule for home in plugin.iterchildren("ros") for it in _rules(home))


def _rules(home: _Element) -> Iterator[ReadRule]:
    """Yield the rules in <argument>, which come first, and those in <remapping>."""
    for element in (*_remap_arguments(home), *home.iterfind("remapping")):
        rule = parse_remap(text_of(element))
        if rule is not None:
            line: int = element.sourceline or 0  # type: ignore[assignment]
            yield ReadRule(rule, line, str(element.tag))


def _remap_arguments(home: _Element) -> Iterator[_Element]:
    """Yield the <argument>s that may be remap rules."""
    # After -r or --remap between --ros-args and --, and all outside, where rcl takes rules, too
    # (rcl arguments.c: "This syntax is deprecated").
    ros, flag = False, ""
    for element in home.iterfind("argument"):
        text = text_of(element)
        if not ros or flag in REMAP_FLAGS:
            yield element
        if ros and flag in REMAP_FLAGS:
            text = ""
        ros = text == "--ros-args" or (ros and text != "--")
        flag = text


def _bound(name: str, namespace: str, rules: Iterable[RemapRule]) -> BoundNode:
    """Return the node after its rules, or without them if rcl refuses to start it."""
    try:
        return bind(name, namespace, rules)
    except UsageError:
        return BoundNode(name, namespace, {}, {})


def full_name(name: str, kind: str, bound: BoundNode) -> str:
    """Return the full name, also if rcl refuses it: a placeholder may be filled before it runs."""
    try:
        return resolve_bound(name, kind, bound)
    except UsageError:
        return expand(name, bound.namespace, bound.node)


def _endpoints(
    plugin: _Element,
    number: int,
    section: PluginDefinition,
    bound: BoundNode,
    rules: tuple[ReadRule, ...],
    release: str,
) -> Iterator[RuntimeName]:
    """Yield the ends of the node and of the controllers that it loads."""
    # A controller's own names take no rule for the manager's node; in some releases they take none.
    wide = section.process_wide
    alone = wide and not controller_way(release).of_manager
    taken = (it.rule for it in rules if not (alone or it.rule.node))
    of_others = _bound(bound.node, bound.namespace, taken) if wide else bound
    for kind, role, name, parameter, type_, off in _asked_for(plugin, section, rules):
        if wide and name in TF_TOPICS and not wheels_in(plugin):
            continue
        is_other = role == PUBLISHES
        full = full_name(name, kind, of_others if is_other else bound)
        own = (alone and is_other, type_, role, name, parameter, off)
        yield RuntimeName(kind, full, "plugin", number, parameter or name, *own)


def _asked_for(
    plugin: _Element, section: PluginDefinition, rules: tuple[ReadRule, ...]
) -> Iterator[tuple[str, str, str, str, str, str]]:
    """Yield (kind, role, name, parameter, type, what would enable it) of what a node asks for."""
    off = switched_off(plugin, section)
    wired = list(wired_of(plugin, section))
    named = {it.name for it, _ in wired}
    for it, path in wired:
        kind = SERVICE if it.role == SERVES else TOPIC
        yield kind, it.role, it.name, path, it.type, off.get(it.name, "")
    for site in filter(holds_topic, section.sites):
        kind = SERVICE if site.kinds[0] == SERVICE else TOPIC
        for name in (it for it in values_of(plugin, site) if site.does or it not in named):
            yield kind, site.does, name, site.path, site.type, ""
    # Other topics below the plugin's own name are in its remap rules, not in its definition.
    for source in (it.rule.source for it in rules):
        if source.startswith("~") and source not in named:
            yield TOPIC, "", source, "", "", ""


def holds_topic(site: SiteRow) -> bool:
    """Return whether a site's value is a topic or service, or topics are below it."""
    whole = site.form == "whole" and site.role != "keep" and site.when != SENT
    return whole and site.kinds[0] in TOPIC_KINDS and "qos" not in site.path


def is_of_others(site: SiteRow) -> bool:
    """Return whether a site's value is a topic that is not the robot's: the world's, or one kept."""
    return site.when == SENT or (site.role == "keep" and "topic" in site.path.lower())


def frames_of(plugin: _Element, section: PluginDefinition) -> Iterator[tuple[str, str]]:
    """Yield (frame, parameter) for the frames in the parameters of a plugin."""
    for site in section.sites:
        if site.form == "whole" and site.kinds[:1] == ("frame",):
            for value in values_of(plugin, site):
                yield site.path, value
