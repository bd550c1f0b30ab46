# SPDX-License-Identifier: Apache-2.0
"""The mass of links, with and without what is fixed to them."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.releases import OF_OLD
from multibot_rewrite.description.checks.links_and_joints import WORLD, Link, Robot, reached, weighs
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.rules.description.physics.shared import inertials, moves
from multibot_rewrite.rules.facts.simulators import simulator_plugins
from multibot_rewrite.rules.subject import Subject

TINY_MASS = 1e-6


@rule("MB603", "link-without-mass", WARNING)
def link_without_mass(subject: Subject) -> Iterator[Problem]:
    """The uppermost bodies without mass, if the robot has several bodies and some mass: an error of a
    robot that runs in Gazebo, where what it relies on goes with them."""
    robot = subject.robot
    mass = _masses(robot)
    if len(mass) < 2 or not any(it > 0 for it in mass.values()):
        return
    lost: set[str] = set()
    for name, sum_ in mass.items():
        link = robot.link.get(name)
        if link is None or sum_ > 0 or name in lost or name == WORLD or _negative(link):
            continue
        if name not in robot.above and name not in robot.below:
            continue  # no joint has it: MB501
        gone = reached(robot, [name], lost)
        used = relied_on(subject, frozenset(gone))
        tail = f", with {len(gone) - 1} links below it" if gone[1:] else ""
        tail += f"; {', '.join(used)} {'goes' if len(used) == 1 else 'go'} with it" if used else ""
        level = ERROR if subject.settings.simulated and (used or name not in robot.above) else ""
        message = (
            f"link {name!r} and the links fixed to it have no mass: Gazebo leaves it out{tail}"
        )
        yield Problem(link.element, message, "name", level=level)


@rule("MB609", "root-inertia", NOTE)
def root_inertia(subject: Subject) -> Iterator[Problem]:
    """A root with <inertial>."""
    robot = subject.robot
    for link, inertial in inertials(robot):
        if link.name not in robot.above:
            yield Problem(inertial.element, f"root link {link.name!r} has an inertia: KDL drops it")


@rule("MB610", "no-inertia", NOTE)
def no_inertia(subject: Subject) -> Iterator[Problem]:
    """A robot without mass: with joints that move, or one that runs in Gazebo."""
    robot, chosen = subject.robot, subject.settings.simulated
    massless = bool(robot.links) and not weighs(robot)
    unweighed = not any(it.inertial for it in robot.links)
    moving = any(it.type != "fixed" for it in robot.joints)
    if not (massless and chosen) and not (unweighed and moving):
        return
    # Hardware of ros2_control has sensors, too.
    every = subject.elements.every("sensor")
    sensors = any(next(it.iterancestors("ros2_control"), None) is None for it in every)
    simulated = chosen or sensors or simulator_plugins(subject)
    what = "no link has an <inertial>" if unweighed else "no link has a mass"
    message = f"{what}: the robot cannot be simulated"
    yield Problem(subject.document.root, message, level=ERROR if simulated else "")


@rule("MB612", "mass-tiny", NOTE)
def mass_tiny(subject: Subject) -> Iterator[Problem]:
    """Bodies of nearly no mass."""
    robot = subject.robot
    if not any(it.mass is not None and 0 < it.mass <= TINY_MASS for _, it in inertials(robot)):
        return
    for name, mass in _masses(robot).items():
        inertial = robot.link[name].inertial if name in robot.link else None
        if 0 < mass <= TINY_MASS and moves(robot, name) and inertial is not None:
            message = f"link {name!r} moves and weighs {mass:g} kg"
            level = WARNING if subject.settings.distro == OF_OLD else ""
            yield Problem(inertial.element, message, level=level)


def _negative(link: Link) -> bool:
    return link.inertial is not None and (link.inertial.mass or 0) < 0


def _masses(robot: Robot) -> dict[str, float]:
    """Body -> its mass with all that is fixed to it; what is not a number counts as 1 kg."""
    mass = dict.fromkeys(robot.body.values(), 0.0)
    for link, inertial in inertials(robot):
        body = robot.body.get(link.name)
        if body is not None:
            mass[body] += 1.0 if inertial.mass is None else max(inertial.mass, 0.0)
    return mass


def relied_on(subject: Subject, gone: frozenset[str]) -> tuple[str, ...]:
    """What goes with these links, in the words of a message."""
    joints = {it.name for it in subject.robot.joints if it.child in gone or it.parent in gone}
    found = [*_sensors(subject, gone | joints), *_driven(subject, joints)]
    return tuple(dict.fromkeys(found))


def _sensors(subject: Subject, gone: frozenset[str]) -> Iterator[str]:
    for block in subject.elements.tops("gazebo"):
        if block.get("reference") in gone:
            yield from (f"sensor {it.get('name')!r}" for it in block.iterchildren("sensor"))


def _driven(subject: Subject, joints: set[str]) -> Iterator[str]:
    """Joints of which a plugin of the model, or ros2_control, knows the name."""
    for block in subject.elements.tops("gazebo"):
        for plugin in () if block.get("reference") else block.iterchildren("plugin"):
            named = (text_of(it) for it in plugin.iterdescendants("*"))
            yield from (f"joint {it!r} of a plugin" for it in named if it in joints)
    for system in subject.elements.tops("ros2_control"):
        named = (it.get("name", "") for it in system.iterchildren("joint"))
        yield from (f"joint {it!r} of ros2_control" for it in named if it in joints)
