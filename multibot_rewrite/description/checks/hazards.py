# SPDX-License-Identifier: Apache-2.0
"""What breaks when several robots are made from one description: one function per problem."""

from __future__ import annotations

from collections.abc import Container, Iterator
from functools import partial
from typing import TYPE_CHECKING

from lxml.etree import _Element

from multibot_rewrite.base.conventions import SHARED_TOPICS
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.naming import (
    FRAME_KINDS,
    NAMESPACE,
    POSTFIX,
    PREFIX,
    TF_TOPICS,
    TOPIC_KINDS,
    Naming,
)
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.base.rosnames import split_remap
from multibot_rewrite.base.wording import plural
from multibot_rewrite.description.checks.problem import Problem, about
from multibot_rewrite.description.rewriters.forms import IN_FRONT
from multibot_rewrite.description.rewriters.model_namespaces import INCLUDE, MODEL, namespace_of
from multibot_rewrite.description.rewriters.plugin_definitions import PluginDefinition
from multibot_rewrite.description.rewriters.remap_rules import named, relative
from multibot_rewrite.description.rewriters.text import text_at, text_of
from multibot_rewrite.description.rewriters.tree import Tree, library_key
from multibot_rewrite.description.steps.collect import SRDF, Host, Inventory
from multibot_rewrite.knowledge.controller_ways import controller_way

if TYPE_CHECKING:
    from multibot_rewrite.description.steps.renames import RenameMap


# Of a plugin that opens what is the world's.
WORLD = "world"
# Says which of them no robot loads any more.
LEFT = "MF847"
# What a plugin reads the description from: names that no other robot's plugin may read.
DESCRIPTION_NODE = "robot_param_node"
DESCRIPTIONS = ("robot_param", "robotParam", DESCRIPTION_NODE)
# Sensors of base_link that PX4 looks for: PX4-Autopilot src/modules/simulation/gz_bridge/GZBridge.cpp.
OF_PX4 = ("imu_sensor", "air_pressure_sensor")
# What no robot has to itself, whoever shares it.
OF_EVERYBODY = frozenset(it.strip("/") for it in (*SHARED_TOPICS, *TF_TOPICS))
# What is left where a name has to stay, and is looked up in the whole world.
ALONE = "run each robot in a Gazebo of its own, by GZ_PARTITION, in Classic by GAZEBO_MASTER_URI"


def hazards(inventory: Inventory, renames: RenameMap) -> Iterator[Problem]:
    """Yield all hazards; they do not depend on the robots' names."""
    for of_naming in (prefix_only, leading_slashes, moved_tf, shared_below, process_wide):
        yield from of_naming(inventory, renames.naming)
    spelt = zip(inventory.claims, renames.values, strict=True)
    # The elements with a name that is below another one, which is renamed.
    moved = {it.element for it, names in spelt if it.site.form == "below" and names}
    yield from one_description(inventory, renames.naming, moved)
    yield from world_systems(inventory)
    for of_names in (hardwired, of_px4, outside_frames, reordered):
        yield from of_names(inventory, renames)


def prefix_only(inventory: Inventory, naming: Naming) -> Iterator[Problem]:
    """Yield parameters that plugins put in front of names, which cannot hold a postfix."""
    if naming.affix == PREFIX or "sensor" not in naming.separators:
        return
    hint = "use --affix prefix"
    for claim, names in zip(inventory.claims, inventory.names, strict=True):
        own = any((it.kind, it.text) in naming.own for it in names)
        if claim.site.form in IN_FRONT and not own:
            yield about(claim, "MB422", _message_about_prefix(claim.site.path, claim.value), hint)
    for section, host in _known_plugins(inventory):
        for site in (it for it in section.sites if it.form in IN_FRONT and it.default):
            if host.element.find(site.path) is None:
                message = _message_about_prefix(site.path, site.default)
                yield _at_host(host, "MB422", message, hint)


def _message_about_prefix(path: str, value: str) -> str:
    return f"{path} {value!r} is put in front of names by the plugin, so a postfix cannot be added"


def leading_slashes(inventory: Inventory, naming: Naming) -> Iterator[Problem]:
    """Yield frames with a leading slash: kept, but tf2 look-ups reject them (buffer_core.cpp)."""
    for claim in inventory.claims:
        kinds = claim.site.kinds
        if claim.site.form != "whole" or kinds[0] not in FRAME_KINDS:
            continue
        if claim.value[:1] == "/" and claim.value[1:] not in naming.shared_frames:
            message = f"frame {claim.value!r} starts with a slash, which tf2 refuses"
            yield about(claim, "MB301", message, "drop the slash")


def moved_tf(inventory: Inventory, naming: Naming) -> Iterator[Problem]:
    """Yield rules of the file that remap a plugin's /tf, although the layout has one /tf."""
    for claim in inventory.claims if not naming.layout.tf_per_robot else ():
        rule = split_remap(claim.value) if claim.site.form == "remap" else None
        if rule and rule.source.strip("/") in TF_TOPICS and rule.target != rule.source:
            message = f"{claim.value!r} moves this plugin away from the shared {rule.source}"
            hint = "drop the rule, or use --layout both"
            yield about(claim, "MB423", message, hint)


def shared_below(inventory: Inventory, naming: Naming) -> Iterator[Problem]:
    """Yield relative names that should be shared, but are below each robot's namespace."""
    shared = naming.shared_topics - OF_EVERYBODY
    if not shared or naming.topics != NAMESPACE:
        return
    says = "is below the namespace of each robot, so it is not shared"
    for claim, names in zip(inventory.claims, inventory.names, strict=True):
        for it in names if claim.site.namespaced else ():
            if it.kind in TOPIC_KINDS and it.text in shared:
                yield about(claim, "MB430", f"{it.text!r} {says}", f"write /{it.text}")
    for section, host in _known_plugins(inventory):
        rules = (split_remap(text_of(it)) for it in host.element.iter("remapping", "argument"))
        ruled = {it.source.strip("/") for it in rules if it}
        left = (it.name for it in section.wired if not it.is_moved)
        for name in (it for it in left if it in shared and it not in ruled):
            hint = f"write the rule {name}:=/{name}"
            yield _at_host(host, "MB430", f"{name!r} of {section.names[0]} {says}", hint)


def bare_lookups(inventory: Inventory, naming: Naming) -> Iterator[Problem]:
    """Yield consumers that find things by name in the whole world, where no robot's name is added."""
    declared = {claim.site.kinds[0] for claim in inventory.claims if claim.site.role == "declares"}
    for section, host in _known_plugins(inventory):
        kind = section.unique
        # Hardware looks for the sensors that it is given, not for all that the robot has.
        element = host.element
        without = kind != "" and element.tag == "ros2_control" and element.find(kind) is None
        if kind in declared and kind not in naming.separators and not without:
            message = (
                f"{section.names[0]} looks up {kind}s in the whole world without the robot's name: "
                "it may find that of another robot"
            )
            hint = f"use --layout both, which renames {kind}s for each robot"
            yield _at_host(host, "MB425", message, hint)


def process_wide(inventory: Inventory, naming: Naming) -> Iterator[Problem]:
    """Yield plugins with remap rules for the whole process, where only namespaces help."""
    # Both gazebo_ros2_control_plugin.cpp and ign_ros2_control_plugin.cpp set the global arguments;
    # since Jazzy each manager has its own (gz_ros2_control_plugin.cpp, ``options.arguments``).
    if not controller_way(inventory.release).process_wide:
        return
    wide = [(section, host) for section, host in _known_plugins(inventory) if section.process_wide]
    if naming.topics != NAMESPACE:
        for section, host in wide:
            plugin = section.names[0]
            message = f"remap rules of {plugin} apply to the whole process, also to other robots"
            hint = "with several robots in one Gazebo use --topics namespace"
            yield _at_host(host, "MB426", message, hint)
        return
    inside = {host.element: (named(host.element, section)[1], section) for section, host in wide}
    for claim in inventory.claims if inside else ():
        rule = split_remap(claim.value) if claim.site.form in ("remap", "argument") else None
        plugin_element = next((it for it in claim.element.iterancestors() if it in inside), None)
        if rule is None or plugin_element is None:
            continue
        if relative(rule, *inside[plugin_element], naming):
            continue
        if rule.target.startswith("/"):
            message = f"{claim.value!r} applies to the whole process, also to nodes of other robots"
            hint = "use a relative target, which ends up in each robot's own namespace"
            yield about(claim, "MB426", message, hint)


def one_description(
    inventory: Inventory, naming: Naming, moved: Container[_Element] = ()
) -> Iterator[Problem]:
    """Yield absolute names of descriptions and of nodes with them, where these keep their names."""
    plugins = (it.element for it in inventory.hosts if it.element.tag == "plugin")
    for it in (child for plugin in plugins for child in plugin.iterchildren(*DESCRIPTIONS)):
        name = text_of(it)
        renamed = it.tag == DESCRIPTION_NODE and naming.topics != NAMESPACE
        if name.startswith("/") and not renamed and it not in moved:
            message = f"<{it.tag}> {name!r} is the same for all robots"
            yield Problem(it, message, "", "use the part after the last slash", (), "MB410")


def world_systems(inventory: Inventory) -> Iterator[Problem]:
    """Yield systems of the whole world that each robot loads again; in a world they are right."""
    for section, host in _known_plugins(inventory):
        above = host.element.getparent()
        if WORLD not in section.opens or (above is not None and above.tag in (WORLD, "gui")):
            continue
        key = system_key(host.element)
        why = section.about or "what it opens is the world's"
        message = f"{key} is loaded again with every robot: {why}"
        hint = "write its <plugin> into the <world>, once, and use --world-systems leave"
        yield Problem(host.element, message, "filename", hint, (), "MB416")


def system_key(plugin: _Element) -> str:
    """Return the name of a system as messages have it."""
    return library_key(plugin.get("filename", "").rpartition("/")[2]) or plugin.get("name", "")


def hardwired(inventory: Inventory, renames: RenameMap) -> Iterator[Problem]:
    """Yield plugins whose code looks for a literal name: under another one they find nothing."""
    for section, host in _known_plugins(inventory):
        for entry in section.hardwired:
            kind, _, name = entry.partition(":")
            path, _, name = name.removeprefix("{").rpartition("}")
            # A prefix that is given is renamed itself, or said by MB422.
            if path and host.element.find(path) is not None:
                continue
            if name in inventory.declared[kind] and renames.changes(kind, name):
                message = f"{section.names[0]} looks for a {kind} called {name!r}, which is renamed"
                bare = "the name is fixed in its code: use --layout tf-per-robot or frame-prefix"
                alone = kind in (section.unique, "light")  # renamed in every layout
                given = f"write an empty <{path}> for it and use --affix prefix"
                yield _at_host(host, "MB428", message, given if path else ALONE if alone else bare)


def of_px4(inventory: Inventory, renames: RenameMap) -> Iterator[Problem]:
    """Yield a problem for airframes of PX4, whose topics contain names of model, link and sensor."""
    links, sensors = (inventory.declared[kind] for kind in ("link", "sensor"))
    if "base_link" not in links or not all(it in sensors for it in OF_PX4):
        return
    for it in OF_PX4:
        if renames.changes("sensor", it):
            message = f"PX4 looks for a sensor called {it!r} in 'base_link', which is renamed"
            hint = "the names are fixed in its code: use --layout frame-prefix"
            yield about(sensors[it], "MB428", message, hint)


def _at_host(host: Host, code: str, message: str, hint: str) -> Problem:
    return Problem(host.element, message, None, hint, (), code)


def _known_plugins(inventory: Inventory) -> Iterator[tuple[PluginDefinition, Host]]:
    for host in inventory.hosts:
        if host.node.section is not None:
            yield host.node.section, host


def outside_frames(inventory: Inventory, renames: RenameMap) -> Iterator[Problem]:
    """Yield renamed frames to which an SRDF fixes the robot."""
    for claim, spelling in zip(inventory.claims, renames.values, strict=True):
        if claim.site.path != "virtual_joint@parent_frame" or claim.element.get("type") != "fixed":
            continue
        for name in spelling:
            if name.kind == "frame":
                new = name.affix.spell(claim.value, "ROBOT")
                message = (
                    f"the robot is fixed to {claim.value!r}, which becomes {new!r} for each ROBOT"
                )
                hint = f"--shared world,map,{claim.value} keeps it"
                yield about(claim, "MB427", message, hint)


def reordered(inventory: Inventory, renames: RenameMap) -> Iterator[Problem]:
    """Yield joints that urdfdom sorts by name: pinocchio's configuration vector has that order."""
    if renames.naming.affix != POSTFIX or "joint" not in renames.naming.separators:
        return
    # Those of an SRDF are in its URDF.
    declared = inventory.declared["joint"] if inventory.format != SRDF else {}
    parents = ((name, claim.element.find("parent")) for name, claim in declared.items())
    siblings = lists_by_key((it.get("link", ""), name) for name, it in parents if it is not None)
    for link, names in siblings.items():
        old = sorted(names)
        if not any(map(str.startswith, old[1:], old)) and not renames.naming.own:
            continue  # what is behind both names does not matter
        # The order may depend on the robot's name: try one that sorts first and one that sorts last.
        orders = [sorted(names, key=partial(renames.spelled, robot, "joint")) for robot in "\0~"]
        new = next((order for order in orders if order != old), None)
        if new is not None:
            order = f"the order of the joints below link {link!r} to {', '.join(new)}"
            hint = "urdfdom sorts joints by name; use --affix prefix to keep the order"
            yield about(declared[new[0]], "MB405", f"the postfix changes {order}", hint)


IGNORED, IN_USE = "MB419", "MB429"
# The Gazebo of each release's packages. Source: gazebosim/ros_gz README.md, branch ros2.
GAZEBO = {"humble": "Fortress", "jazzy": "Harmonic", "kilted": "Ionic", "lyrical": "Jetty"}


def ignored_namespaces(inventory: Inventory, tree: Tree) -> Iterator[Problem]:
    """Yield namespaces of models that the release's Gazebo does not read."""
    release = tree.definitions.release
    for model in [] if _reads_model_namespaces(tree) else _with_namespace(inventory):
        who = f"Gazebo {GAZEBO.get(release, 'of main')} ({release})"
        message = f"{who} does not read the namespace {namespace_of(model)!r} of {_name_of(model)}"
        yield Problem(model, message, None, "set the topics of its plugins", (), IGNORED)


def used_namespaces(inventory: Inventory, tree: Tree) -> Iterator[Problem]:
    """Yield namespaces of models that plugins of theirs put in front of their relative topics."""
    models = _with_namespace(inventory) if _reads_model_namespaces(tree) else []
    release = tree.definitions.release
    below = [
        host.element
        for section, host in (_known_plugins(inventory) if models else ())
        if section.model_namespace and has_release(section.model_namespace, release)
    ]
    for model in models:
        if count := sum(model in plugin.iterancestors() for plugin in below):
            puts = f"{plural(count, 'plugin')} {'puts' if count == 1 else 'put'}"
            what = f"the namespace {namespace_of(model)!r} of {_name_of(model)}"
            message = f"{puts} {what} in front of relative topics, if Gazebo was built with that"
            yield Problem(model, message, None, "absolute topics hold everywhere", (), IN_USE)


def _reads_model_namespaces(tree: Tree) -> bool:
    sections = tree.definitions.find("element", "sdf.model")
    return any(has_release(it.model_namespace, tree.definitions.release) for it in sections)


def _with_namespace(inventory: Inventory) -> list[_Element]:
    """Return the models, own and included, that have a namespace."""
    if b"namespace" not in inventory.document.source:
        return []
    models = inventory.document.root.iter(MODEL, INCLUDE)
    return [model for model in models if namespace_of(model)]


def _name_of(model: _Element) -> str:
    name = text_at(model, "name") if model.tag == INCLUDE else model.get("name")
    return f"model {name!r}" if name else f"this <{model.tag}>"
