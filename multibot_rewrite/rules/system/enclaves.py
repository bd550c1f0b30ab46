# SPDX-License-Identifier: Apache-2.0
"""Dangers of enclaves of SROS2: a robot's node in that of another robot, or in none."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.spelling.enclaves import enclave_of
from multibot_rewrite.system.index import Index


@system_rule("MG112", "enclave-of-another-robot", ERROR, drawn="cross-talk")
def enclave_of_another_robot(seen: Index) -> Iterator[Finding]:
    """By the robots' names in the path of the enclave."""
    robots = {*seen.robots}
    for name, enclave in dict.fromkeys((it.name, it.enclave) for it in seen.system.nodes):
        robot = seen.robot(name) if enclave else ""
        if not robot or _is_of(enclave, robot):
            continue
        if other := min((it for it in _parts(enclave) if it in robots), default=""):
            message = f"{name} is in the enclave {enclave}, which is of {other}"
            yield enclave_of_another_robot.finding(message, _start(robot), robot=robot, node=name)


def _parts(enclave: str) -> Iterator[str]:
    """The words of a path one after the other, as many as a robot's name may have."""
    words = enclave.strip("/").split("/")
    for start in range(len(words)):
        yield from ("/".join(words[start:end]) for end in range(start + 1, len(words) + 1))


def _is_of(enclave: str, robot: str) -> bool:
    """A robot's name may have several levels."""
    return f"/{robot}/" in f"{enclave}/"


@system_rule("MG113", "without-enclave", WARNING)
def without_enclave(seen: Index) -> Iterator[Finding]:
    """Of the nodes of robots, of which others are in one; one finding a robot."""
    owned = [it for it in seen.system.nodes if seen.robot(it.name) and not seen.is_tool(it.name)]
    bare: dict[str, list[str]] = defaultdict(list)
    for it in owned if any(it.enclave for it in owned) else ():
        if not it.enclave:
            bare[seen.robot(it.name)].append(it.name)
    for robot, names in bare.items():
        message = f"{shorten(names)}: in no enclave"
        yield without_enclave.finding(message, _start(robot), robot=robot, node=names[0])


def _start(robot: str) -> str:
    return f"start it with --ros-args --enclave {enclave_of(robot)}"
