# SPDX-License-Identifier: Apache-2.0
"""The programs of known nodes: what ``ros2 run`` and launch start.

Sources: the launch files and CMakeLists.txt of each package on its jazzy branch; nav2_bringup
launch/*.py of humble (1.1.20), jazzy (1.3.13), kilted (1.4.2), lyrical (1.5.1) and rolling (a3a97043e);
slam_toolbox launch/online_sync_launch.py.
"""

from typing import NamedTuple

from multibot_rewrite.base.releases import has_release
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.records import NodeFacts

LIFECYCLE_MANAGER, CONTAINER = "lifecycle_manager", "component_container"
# What the launch files of Nav2 start; the manager last, so that what it manages is there.
NAV2 = (
    *("map_server", "amcl", "controller_server", "smoother_server", "planner_server"),
    *("route_server", "behavior_server", "bt_navigator", "waypoint_follower", "velocity_smoother"),
    *("collision_monitor", "docking_server", "following_server", "costmap_filter_info_server"),
    *("map_saver", "slam_toolbox", LIFECYCLE_MANAGER),
)


class Program(NamedTuple):
    """A node's program, its class as a component if it can be one, and further words for it."""

    package: str
    executable: str
    plugin: str = ""
    words: tuple[str, ...] = ()


def program_of(node: NodeFacts, release: str) -> Program | None:
    """Return a node's program in a release; None for an unknown package or a pure component."""
    known = node.kind
    if known == CONTAINER:
        return container_of(release)
    if not node.package or (known[:1].isupper() and not node.programs):
        return None
    return Program(node.package, next(iter(node.programs), known), node.component)


def started_as(node: NodeFacts, release: str) -> Program | None:
    """Return the program, or the class of what is only a component, with an empty executable."""
    alone = program_of(node, release)
    if alone is None and node.package and node.component:
        return Program(node.package, "", node.component)
    return alone


def known_program(name: str, release: str) -> Program:
    """Return the program of a node of ``NAV2`` that the release has."""
    program = program_of(built_in(release).nodes[name], release)
    assert program is not None
    return program


def runs(node: NodeFacts, program: str) -> bool:
    """Return whether the node is what ``package/executable`` or ``package/class`` runs."""
    own = (*node.programs, node.component) if node.component else node.programs
    if not own:
        return False
    return any(program == (it if "/" in it else f"{node.package}/{it}") for it in own)


def container_of(release: str) -> Program:
    """Return the program of a container in a release."""
    if has_release("lyrical+", release):
        words = ("--isolated", "--executor-type", "single-threaded")
        return Program("rclcpp_components", CONTAINER, words=words)
    return Program("rclcpp_components", f"{CONTAINER}_isolated")


def is_unmanaged(node: NodeFacts, release: str) -> bool:
    """Return whether a node has a life cycle that no lifecycle manager of Nav2 takes care of."""
    return bool(node.unmanaged) and has_release(node.unmanaged, release)
