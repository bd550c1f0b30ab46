# SPDX-License-Identifier: Apache-2.0
"""Plugins of Nav2 and filters of a chain in a section of parameters, and what each has below its name.

Sources: pluginlib loads the class that ``NAME.plugin`` says; dwb_local_planner.cpp
(resolveCriticClassName) and critic_manager.cpp of nav2_mppi_controller make the classes of critics of
their names;
nav2_rotation_shim_controller.cpp gives its controller its own name, from Lyrical on
``primary_controller`` below it; collision_monitor_node.cpp (configurePolygons, configureSources).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from multibot_rewrite.knowledge.declared import Declared, declared_by, is_known
from multibot_rewrite.system.parameters import Value

DWB = "dwb_core::DWBLocalPlanner"
MPPI = "nav2_mppi_controller::MPPIController"
SHIM = "nav2_rotation_shim_controller::RotationShimController"
# Lists of the collision monitor -> the class of what they name.
LISTED = {
    "polygons": "nav2_collision_monitor::Polygon",
    "observation_sources": "nav2_collision_monitor::Source",
}
# Older names that no supported release reads (obstacle_layer.cpp of Foxy and of Galactic), and those
# that robot_localization and Gazebo's drive have for what diff_drive_controller calls otherwise.
RENAMED = {
    "obstacle_range": "obstacle_max_range",
    "raytrace_range": "raytrace_max_range",
    "publish_tf": "enable_odom_tf",
    "publish_odom_tf": "enable_odom_tf",
}
# A part of a filter of filter_chain.hpp (ros/filters), by its number.
FILTER = re.compile(
    r"(?P<filter>(?P<chain>(?:\w+\.)*)filter(?P<number>\d{0,9}))\.(?P<word>\w+).*", re.DOTALL
)
_PLUGIN, _PRIMARY = ".plugin", ".primary_controller"
_CRITICS, _NAMESPACES = ".critics", ".default_critic_namespaces"

Values = Mapping[str, Value | None]


def plugins_in(values: Values) -> dict[str, tuple[str, tuple[Declared, ...]]]:
    """Return by plugin's name (class, parameters of the class); none for an unknown class."""
    found: dict[str, tuple[str, tuple[Declared, ...]]] = {}
    for name, class_ in (*_listed(values), *_named_classes(values), *_chain_filters(values)):
        facts = declared_by(class_)
        if class_ == SHIM:
            facts = _with_primary(facts, values, name)
        found[name] = (class_, facts)
    return found


def _listed(values: Values) -> Iterator[tuple[str, str]]:
    """Yield (name, class) of the polygons and sources of a collision monitor, which has both lists."""
    if all(it in values for it in LISTED):
        for path, class_ in LISTED.items():
            yield from ((it, class_) for it in _words_at(values, path))


def _named_classes(values: Values) -> Iterator[tuple[str, str]]:
    """Yield (name, class) of each plugin, and of each critic of a controller."""
    for path, value in values.items():
        name = path.removesuffix(_PLUGIN)
        if name == path or not isinstance(value, str):
            continue
        class_ = value.replace("/", "::")
        yield name, class_
        own = class_
        if class_ == SHIM and isinstance(values.get(name + _PRIMARY), str):
            own = _class_at(values, name + _PRIMARY)
        for critic in _words_at(values, name + _CRITICS):
            yield f"{name}.{critic}", _critic(own, critic, name, values)


def _chain_filters(values: Values) -> Iterator[tuple[str, str]]:
    """Yield the parameters of each filter of a chain, whose class is in ``filterN.type``."""
    for path, value in values.items():
        if isinstance(value, str) and (found := FILTER.fullmatch(path)) and found["word"] == "type":
            yield f"{found['filter']}.params", value.replace("/", "::")


def _with_primary(facts: tuple[Declared, ...], values: Values, name: str) -> tuple[Declared, ...]:
    """Return the parameters of a controller and of the one that it wraps under the same name."""
    class_ = _class_at(values, name + _PRIMARY)
    if not class_:  # it has a name of its own, or the file does not say it
        return facts if name + _PRIMARY + _PLUGIN in values else ()
    inner = declared_by(class_)
    return (*facts, *inner) if inner else ()


def _critic(controller: str, critic: str, name: str, values: Values) -> str:
    """Return the class of a controller's critic; empty for a controller that is not known."""
    if controller == MPPI:
        return f"mppi::critics::{critic}"
    if controller != DWB or name + _NAMESPACES in values:
        return ""
    class_ = _class_at(values, f"{name}.{critic}.class") or critic
    class_ = class_ if "::" in class_ else f"dwb_critics::{class_}"
    return class_ if is_known(class_) else f"{class_}Critic"


def _class_at(values: Values, path: str) -> str:
    value = values.get(path)
    return value.replace("/", "::") if isinstance(value, str) else ""


def _words_at(values: Values, path: str) -> list[str]:
    value = values.get(path)
    return [str(it) for it in value] if isinstance(value, list) else []
