# SPDX-License-Identifier: Apache-2.0
"""What is known of programs in launch files (``programs.yaml``), and which run once for all robots."""

from collections.abc import Collection, Mapping
from fnmatch import fnmatchcase
from functools import cache
from typing import NamedTuple

from multibot_rewrite.base.bounded import load_own_yaml
from multibot_rewrite.base.conventions import only_looks
from multibot_rewrite.producers.launch.records import LaunchedNode
from multibot_rewrite.producers.launch.spawners import is_spawner


class Programs(NamedTuple):
    """Executables whose node is called otherwise than its entry, and those that are no node of a robot.

    ``spawners`` put a description into a simulator, ``simulators`` are packages that only a simulated
    robot needs; ``once`` has patterns of what runs once for all robots, by the reason."""

    names: Mapping[str, str]
    passing: Collection[str]
    spawners: Collection[str]
    simulators: Collection[str]
    once: Mapping[str, Collection[str]]


@cache
def programs() -> Programs:
    """Return the programs of ``programs.yaml``."""
    data = load_own_yaml(__file__, "programs.yaml")
    sets = {it: frozenset(data[it]) for it in ("passing", "spawners", "simulators")}
    return Programs(**{**data, **sets})


_OWN = ("robot_state_publisher", "ros2_control_node", "rviz2", "static_transform_publisher")
_EXTRA = "it spawns something in addition to the robots, in the one simulator"
_LOOKS = "it only shows data or forwards an operator's commands"


def once_for_all(node: LaunchedNode) -> str:
    """Return why a process runs once for all robots; empty if each robot has its own."""
    if node.container:
        return ""
    if node.process.is_extra:
        return _EXTRA
    program = node.executable.rpartition("/")[2]
    command = f"{node.package}/{program}"
    told = (command, f"{command} {node.arguments[0]}" if node.arguments else command)
    rows = ((why, it) for why, every in programs().once.items() for it in every)
    found = (why for why, it in rows if any(fnmatchcase(one, it) for one in told))
    # A program that is called so belongs to a package that is: rviz_check.py of a robot is no window.
    looks = only_looks(program) and (not node.package or only_looks(node.package))
    return next(found, _LOOKS if looks else "")


def passes(it: LaunchedNode) -> bool:
    """Return whether a process is no robot's node: a program that ends, a simulator, a launch file."""
    is_none = not it.package or it.process.is_include
    return is_none or is_spawner(it) or program_of(it) in programs().passing


def may_be_off(it: LaunchedNode) -> bool:
    """Return whether an argument may turn a node on: no container, none that a fleet starts itself."""
    own = is_spawner(it) or it.executable in _OWN or it.package in programs().simulators
    return not (own or it.executable.startswith("component_container"))


def program_of(it: LaunchedNode) -> str:
    """Return a node's ``package/executable``, as the tables have it."""
    return f"{it.package}/{it.executable}"
