# SPDX-License-Identifier: Apache-2.0
"""Dangers of states, which nodes were asked for: life cycle, controllers, clocks by parameter."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.rules.places import see, where
from multibot_rewrite.rules.system.clocks import mixed_clocks
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.records import (
    CLAIMS,
    COMMAND,
    SERVICE,
    SIM_TIME,
    Controller,
    Interface,
    clocks,
)
from multibot_rewrite.system.tool_nodes import is_tool, is_viewer, last_word

ACTIVE = "active"


@system_rule(
    "MG511",
    "not-active",
    ERROR,
    what="A managed (lifecycle) node is not active. For one that no lifecycle manager has it is a"
    " warning. Asked for by `--state`.",
    why="It is in the graph and does nothing: it publishes nothing and refuses goals.",
    fix="See the log of its lifecycle manager, which stops at the first node that fails; `ros2"
    " lifecycle set NODE configure`, then `activate`.",
    bad="""\
running: /robot1/manager calls /robot1/amcl/change_state lifecycle_msgs/srv/ChangeState
running: /robot1/amcl serves /robot1/amcl/change_state lifecycle_msgs/srv/ChangeState
running: /robot1/amcl is inactive
""",
    good="""\
running: /robot1/manager calls /robot1/amcl/change_state lifecycle_msgs/srv/ChangeState
running: /robot1/amcl serves /robot1/amcl/change_state lifecycle_msgs/srv/ChangeState
running: /robot1/amcl is active
""",
    line=3,
)
def not_active(seen: Index) -> Iterator[Finding]:
    """One finding for the nodes of a robot that are in one state and have one manager."""
    found: dict[tuple[str, str, str], list[str]] = defaultdict(list)
    for it in seen.system.nodes:
        if it.lifecycle not in ("", ACTIVE):
            found[seen.robot(it.name), it.lifecycle, _manager(seen, it.name)].append(it.name)
    for (robot, state, manager), nodes in found.items():
        verb = "is" if len(nodes) == 1 else "are"
        message = f"{shorten(sorted(nodes), SEVERAL)} {verb} {state}, not active"
        cause = f"see the log of {manager}" if manager else "no node activates it: is that meant?"
        yield not_active.finding(
            message,
            f"{cause}; ros2 lifecycle get {nodes[0]}",
            level=ERROR if manager else WARNING,
            robot=robot,
            node=nodes[0],
        )


def _manager(seen: Index, node: str) -> str:
    """The node that changes the state of another one; empty for none."""
    ends = seen.by_name.get((SERVICE, f"{node}/change_state"))
    clients = (end.node for end in ends.clients) if ends else ()
    return min((it for it in clients if not is_viewer(it) and not is_tool(it)), default="")


@system_rule(
    "MG512",
    "interface-commanded-twice",
    ERROR,
    what="Active controllers of two controller managers of one robot command the same interface "
    "(asked for by `--state`). Or launch files start two controllers of one manager that do.",
    why="Both drive the joint: it jerks between two set points. One manager refuses the second.",
    fix="Run one controller manager for each hardware; a simulator starts its own. Spawn the "
    "second controller with --inactive.",
    bad="""\
running: /robot1/controller_manager controls joint1/position by arm_controller
running: /robot1/gz/controller_manager controls joint1/position by arm_controller
""",
    good="""\
running: /robot1/controller_manager controls joint1/position by arm_controller
running: /robot1/gripper/controller_manager controls finger/position by gripper_controller
""",
)
def interface_commanded_twice(seen: Index) -> Iterator[Finding]:
    """A running manager refuses the second of its own controllers."""
    claims: dict[tuple[str, str], list[Controller]] = defaultdict(list)
    for it in (one for one in seen.system.controllers if one.state == ACTIVE):
        for interface in it.claims:
            claims[seen.robot(it.manager), interface].append(it)
    reported = set()
    for (robot, interface), found in claims.items():
        names = tuple((it.manager, it.name) for it in found)
        if len(set(names)) > 1 and (robot, names) not in reported:
            reported.add((robot, names))
            who = " and ".join(f"{name} of {node}" for node, name in names)
            message = f"{interface} is commanded by {who}"
            cause = "two controller managers for one robot: stop one, or unload its controller"
            if len({it.manager for it in found}) == 1:
                cause = "spawn one of them with --inactive"
            places = [it for it in seen.system.interfaces if _is_of(it, interface, found)]
            yield interface_commanded_twice.finding(
                message, cause + see(places),
                robot=robot, node=found[0].manager, names=(interface,), **where(places),
            )  # fmt: skip


def _is_of(claim: Interface, name: str, controllers: Iterable[Controller]) -> bool:
    """Is it the claim of an interface by one of these controllers?"""
    if (claim.role, claim.kind, claim.name) != (CLAIMS, COMMAND, name):
        return False
    return any(last_word(claim.node) == it.name for it in controllers)


@system_rule(
    "MG513",
    "no-controller-active",
    WARNING,
    what="A controller manager has controllers, and none of them is active. Asked for by `--state`.",
    why="The robot has no joint states and obeys no command.",
    fix="Start the spawners (`ros2 run controller_manager spawner NAME -c MANAGER`); see their log.",
    bad="running: /robot1/controller_manager keeps arm_controller inactive\n",
    good="running: /robot1/controller_manager controls joint1/position by arm_controller\n",
)
def no_controller_active(seen: Index) -> Iterator[Finding]:
    """Some inactive ones beside active ones are usual."""
    kept: dict[str, list[Controller]] = defaultdict(list)
    for it in seen.system.controllers:
        kept[it.manager].append(it)
    for manager, own in kept.items():
        if all(it.state != ACTIVE for it in own):
            listed = shorten((f"{it.name} ({it.state})" for it in own), SEVERAL)
            message = f"none of its controllers is active: {listed}"
            cause = f"ros2 control list_controllers -c {manager}; see the log of the spawners"
            yield no_controller_active.finding(
                message, cause, robot=seen.robot(manager), node=manager
            )


@system_rule(
    "MG514",
    "use-sim-time-differs",
    WARNING,
    what="Nodes of one robot have different values of `use_sim_time`: of a launch file by "
    "`check-launch`, of running nodes by `--state`.",
    why="Their messages are decades apart: tf refuses lookups between them.",
    fix="Set `use_sim_time` alike for all nodes of a robot (`SetParameter` in the launch file).",
    bad="""\
running: /robot1/amcl has use_sim_time true
running: /robot1/driver has use_sim_time false
""",
    good="""\
running: /robot1/amcl has use_sim_time true
running: /robot1/driver has use_sim_time true
""",
)
def use_sim_time_differs(seen: Index) -> Iterator[Finding]:
    """Tools and bridges have the machine's time beside any robot. MG503 says it of a whole robot."""
    told = {it.robot for it in mixed_clocks(seen)}
    by_robot: dict[str, dict[bool, list[str]]] = defaultdict(lambda: defaultdict(list))
    for node, simulated in clocks(seen.system).items():
        if not is_tool(node):
            by_robot[seen.robot(node)][simulated].append(node)
    for robot, found in by_robot.items():
        if len(found) < 2 or robot in told:
            continue
        odd = min((True, False), key=lambda it: len(found[it]))
        message = (
            f"{SIM_TIME} is {str(odd).lower()} for {shorten(sorted(found[odd]))}, and not for"
            f" {shorten(sorted(found[not odd]))}"
        )
        cause = "use_sim_time has to be the same for all nodes of a robot"
        yield use_sim_time_differs.finding(message, cause, robot=robot, node=min(found[odd]))
