# SPDX-License-Identifier: Apache-2.0
"""ros2_control: managers, the description that each gets, controllers that are spawned in them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import gazebo
import programs
import yaml
from nodes import Node, rules_in, sections_of

# Which parameters name joints, and which interfaces they take (the .yaml files of ros2_controllers).
CLAIMS = {
    "diff_drive_controller": (("left_wheel_names", "right_wheel_names"), "velocity"),
    "joint_trajectory_controller": (("joints",), ""),
    "forward_command_controller": (("joints",), ""),
    **{
        f"joint_group_{it}_controller": (("joints",), it)
        for it in ("position", "velocity", "effort")
    },
}


class Manager(NamedTuple):
    """A controller manager: whose, its full name, parameter files, rules and kind."""

    robot: str
    namespace: str
    name: str
    sections: list[Mapping[str, Any]]
    rules: tuple[tuple[str, str], ...]
    inside: bool
    gone: str = ""
    # Those of one controller alone, which its spawner hands over.
    own: tuple[tuple[str, str], ...] = ()


class Found(NamedTuple):
    """The controllers' nodes, and what does not come up."""

    nodes: list[Any]
    faults: list[tuple[str, str]]


def read(
    given: Any, roots: Mapping[str, Any], nodes: list[Any], joints: Mapping[str, tuple[str, ...]]
) -> Found:
    """Return the controllers of every spawner; ``joints`` are those that the simulator keeps."""
    managers = [*outside(given, nodes), *in_simulator(roots, given)]
    found = Found([], [])
    for who, start in given.of("spawner"):
        wanted = manager_of(start)
        fits = [it for it in managers if f"{it.namespace.rstrip('/')}/{it.name}" == wanted]
        if not fits:
            found.faults.append((who, f"a spawner waits for {wanted}, which is not there"))
        bare = [it for it in fits if it.inside and roots[it.robot].find("ros2_control") is None]
        if bare:
            # component_parser.cpp throws, and the plugin of the simulator catches it.
            found.faults.append((who, f"{wanted}: no ros2_control is in its description"))
        for name in names_of(start["arguments"]) if fits and not bare else ():
            robot, inside = fits[0].robot, fits[0].inside
            has = exported(roots.get(robot), joints.get(robot) if inside else None)
            manager = with_files(fits[0], name, files_of(start["arguments"]))
            manager = manager._replace(own=tuple(rules_of(start["arguments"])))
            controller(found, who, manager, name, has, given.release)
    return found


def outside(given: Any, nodes: list[Any]) -> Iterator[Manager]:
    starts = [it for _, it in given.of("ros2_control_node")]
    own = [it for it in nodes if it.what == "controller_manager"]
    for node, start in zip(own, starts, strict=True):
        yield Manager(node.robot, node.namespace, node.name, sections_of(start), node.rules, False)


def in_simulator(roots: Mapping[str, Any], given: Any) -> Iterator[Manager]:
    """gz_ros2_control/src/gz_ros2_control_plugin.cpp."""
    for who, root in roots.items():
        for it in root.iter("plugin"):
            if any(name in it.get("filename", "") for name in gazebo.CONTROL):
                space = "/" + gazebo.text(it, "ros/namespace").strip("/")
                files = [Path(gazebo.text(each, ".")) for each in it.findall("parameters")]
                sections = [yaml.safe_load(f.read_text()) if f.is_file() else {} for f in files]
                ros = it.find("ros")
                rules = () if ros is None else tuple(gazebo.rules_of(ros))
                name = gazebo.text(it, "controller_manager_name") or "controller_manager"
                # A rule of rcl for this node alone moves it.
                space = dict(rules).get(f"{name}:__ns", space)
                gone = ", ".join(f.name for f in files if not f.is_file())
                yield Manager(who, space, name, sections, rules, True, gone)


def manager_of(start: Mapping[str, Any]) -> str:
    """Return the manager that a spawner asks, as its namespace resolves it."""
    words, space = start["arguments"], "/" + start["namespace"].strip("/")
    given = next(
        (words[at + 1] for at, it in enumerate(words) if it in ("-c", "--controller-manager")), ""
    )
    name = given or "controller_manager"
    return name if name.startswith("/") else f"{space.rstrip('/')}/{name}"


def names_of(words: list[str]) -> list[str]:
    """Return the controllers among a spawner's arguments: the words before its options."""
    at = next((at for at, it in enumerate(words) if it.startswith("-")), len(words))
    return words[:at]


def files_of(words: list[str]) -> list[Mapping[str, Any]]:
    """Return what the parameter files of a spawner hold."""
    names = (words[at + 1] for at, it in enumerate(words[:-1]) if it in ("-p", "--param-file"))
    files = [Path(it) for it in names]
    return [yaml.safe_load(it.read_text()) or {} for it in files if it.is_file()]


def rules_of(words: list[str]) -> list[tuple[str, str]]:
    """Return the rules that a spawner gives its controllers (spawner.py: node_options_args)."""
    given = (words[at + 1] for at, it in enumerate(words[:-1]) if it == "--controller-ros-args")
    return rules_in([it for text in given for it in text.split()])


def with_files(manager: Manager, name: str, files: list[Mapping[str, Any]]) -> Manager:
    """Return the manager with what a spawner tells it of a controller: its files, and the type
    that the controller's own section in them has (controller_manager_services.py,
    set_controller_parameters_from_param_files)."""
    fqn = f"{manager.namespace.rstrip('/')}/{name}"
    kind = programs.parameters_of(fqn, files).get("type")
    told = {manager.name: {"ros__parameters": {f"{name}.type": kind}}} if kind else {}
    below = manager.namespace.strip("/")
    section = {f"/{below}": told} if below else told
    return manager._replace(sections=[*manager.sections, *files, section])


def controller(
    found: Found, who: str, manager: Manager, name: str, has: set[str], release: str
) -> None:
    """Add one controller, or why it does not come up."""
    fqn = f"{manager.namespace.rstrip('/')}/{manager.name}"
    kind = programs.parameters_of(fqn, manager.sections).get(f"{name}.type")
    if not kind:
        gone = f": {manager.gone} is not there" if manager.gone else ""
        found.faults.append((who, f"{fqn} has no type for {name}{gone}"))
        return
    what = str(kind).split("/")[0]
    what = what if programs.is_known(what, release) else snake(str(kind).rpartition("/")[2])
    own = f"{manager.namespace.rstrip('/')}/{name}"
    values = {**programs.defaults(what, release), **programs.parameters_of(own, manager.sections)}
    found.faults.extend((who, it) for it in unclaimed(own, what, values, has))
    rules = manager.rules if not manager.inside or release not in ("lyrical", "rolling") else ()
    rules = (*manager.own, *rules)
    ends = tuple(programs.opened(what, values, release))
    # What nobody has read is called as its file calls it.
    what = what if programs.is_known(what, release) else str(kind)
    found.nodes.append(Node(who, what, name, manager.namespace, rules, values, ends))


def snake(name: str) -> str:
    return "".join(f"_{it.lower()}" if it.isupper() else it for it in name).strip("_")


def exported(root: Any, kept: tuple[str, ...] | None) -> set[str]:
    """Return a description's command interfaces; in the simulator those of joints that it keeps."""
    joints = [] if root is None else root.iterfind("ros2_control/joint")
    return {
        f"{joint.get('name')}/{it.get('name')}"
        for joint in joints
        if kept is None or joint.get("name") in kept
        for it in joint.iterfind("command_interface")
    }


def unclaimed(fqn: str, what: str, values: Mapping[str, Any], has: set[str]) -> Iterator[str]:
    """Interfaces that a controller claims and the description does not export."""
    keys, kind = CLAIMS.get(what, ((), ""))
    kinds = (
        [kind] if kind else values.get("command_interfaces") or [values.get("interface_name", "")]
    )
    if keys and not any(values.get(key) for key in keys):
        yield f"{fqn} has no {' or '.join(keys)}: no section of the parameter files is its own"
    for key in keys:
        for joint in values.get(key) or ():
            for it in kinds:
                if f"{joint}/{it}" not in has:
                    yield f"{fqn} claims {joint}/{it}, which the description does not export"
