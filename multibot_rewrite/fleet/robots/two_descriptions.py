# SPDX-License-Identifier: Apache-2.0
"""A robot whose simulator gets another file than robot_state_publisher: do the two fit? And an SDF that
robot_state_publisher gets: is it read?"""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.conventions import USUAL_FRAMES
from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.companions.names.rename_map import spell
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot
from multibot_rewrite.spelling.transforms import STATE_PUBLISHER

DIFFERENT = declare("MF711", "model-differs-from-description", WARNING, formats=("fleet",))

SDF_ALONE = declare("MF712", "sdf-for-state-publisher", WARNING, formats=("fleet",))


def of_sdf_alone(plan: FleetPlan) -> Iterator[Finding]:
    """The robots whose robot_state_publisher gets an SDF: robot_state_publisher.cpp reads it by
    urdf::Model, which asks the parsers that are installed."""
    published = {it.name for it in plan.fleet.facts if it.package == STATE_PUBLISHER}
    runs = {it.robot for it in plan.fleet.table.runs if it.node in published}
    for robot in plan.robots:
        if robot.member.described.document.root.tag == "sdf" and robot.spec.namespace in runs:
            links = shorten(robot.member.described.declared.get("link", ()))
            message = (
                f"robot_state_publisher of {robot.spec.name} gets an SDF, which it reads with the "
                f"package sdformat_urdf alone; else no node sends {links}"
            )
            hint = "name its URDF as description and this file as simulated, or install the package"
            yield at_robot(SDF_ALONE, robot, message, hint)


def differences(plan: FleetPlan) -> Iterator[Finding]:
    """What the model of a robot and its description do not have in common."""
    for robot in plan.robots:
        if robot.simulated:
            described, model = _moving(robot.member.described), _moving(robot.member.inventory)
            lacking = [it for it in described if it not in model]
            if lacking:
                what = "has no moving joint" if len(lacking) == 1 else "has no moving joints"
                message = f"what the simulator gets of {robot.spec.name} {what} {shorten(lacking)}"
                hint = "nothing in the simulator sends their states; give both files the same names"
                yield at_robot(DIFFERENT, robot, message, hint)
            yield from _of_frames(robot)


def _moving(inventory: Inventory) -> list[str]:
    """The joints that need states: neither fixed nor following another one."""
    return [
        str(it.get("name", ""))
        for it in inventory.document.root.iter("joint")
        if it.get("type", "fixed") != "fixed"
        if it.find("mimic") is None and it.find("axis/mimic") is None
    ]


def _of_frames(robot: RewrittenRobot) -> Iterator[Finding]:
    names = robot.names._replace(robot=robot.spec.tag)
    usual = (spell(names, "frame", it) for it in USUAL_FRAMES)
    known = {*robot.links, *names.naming.shared_frames, *usual}
    named = {
        claim.value.strip()
        for claim in robot.member.inventory.claims
        if claim.site.kinds == ("frame",) and claim.site.form == "whole"
    }
    unknown = sorted(it for it in named - known if it and "<" not in it and "$" not in it)
    if unknown:
        model = f"what the simulator gets of {robot.spec.name}"
        message = f"{model} names frames that its description has not: {shorten(unknown)}"
        hint = "name links of the description, or send a transform to them"
        yield at_robot(DIFFERENT, robot, message, hint)
