# SPDX-License-Identifier: Apache-2.0
"""Rules about enclaves of SROS2: is every node of a robot in the robot's own?"""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.rules.declaration import pair_rule
from multibot_rewrite.spelling.enclaves import enclave_of
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.records import Node


@pair_rule("MG112", "enclave-of-another-robot", ERROR, drawn="cross-talk")
def enclave_of_another_robot(plan: Index, seen: Index) -> Iterator[Finding]:
    """By the robots' names in the path of the enclave."""
    for name, enclave in dict.fromkeys((it.name, it.enclave) for it in seen.system.nodes):
        robot = plan.robot_of.get(name, "") if enclave else ""
        if not robot or _is_of(enclave, robot):
            continue
        other = min((it for it in _parts(enclave) if it in plan.declared), default="")
        if other:
            message = f"{name} is in the enclave {enclave}, which is of {other}"
            yield enclave_of_another_robot.finding(message, _start(robot), robot=robot, node=name)


def _parts(enclave: str) -> Iterator[str]:
    """The words of a path one after the other, as many as a robot's name may have."""
    words = enclave.strip("/").split("/")
    for start in range(len(words)):
        yield from ("/".join(words[start:end]) for end in range(start + 1, len(words) + 1))


def _is_of(enclave: str, robot: str) -> bool:
    """A robot's name may have several levels."""
    return bool(robot) and f"/{robot}/" in f"{enclave}/"


@pair_rule("MG113", "without-enclave", WARNING)
def without_enclave(plan: Index, seen: Index) -> Iterator[Finding]:
    """One finding a robot."""
    of = plan.robot_of
    planned = [it for it in seen.system.nodes if it.name in of]
    if not any(it.enclave for it in planned):
        return
    bare: dict[str, list[Node]] = {robot: [] for robot in plan.declared}
    for it in planned:
        if not it.enclave:
            bare[of[it.name]].append(it)
    yield from (_bare(robot, nodes) for robot, nodes in bare.items() if nodes)


def _bare(robot: str, nodes: list[Node]) -> Finding:
    names = [it.name for it in nodes]
    return without_enclave.finding(
        f"{shorten(names)}: in no enclave", _start(robot), robot=robot, node=names[0]
    )


def _start(robot: str) -> str:
    return f"start it with --ros-args --enclave {enclave_of(robot)}"
