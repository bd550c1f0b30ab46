# SPDX-License-Identifier: Apache-2.0
"""Controllers of which only one can be active: they command the same joint, sensor or gpio.

Source: ros2_control controller_manager.cpp and resource_manager.cpp (a command interface is claimed by
one active controller), and the hardware, which moves a joint in one mode at a time.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.knowledge.records import Claim, NodeFacts
from multibot_rewrite.producers.evidence.claims import claims_of
from multibot_rewrite.producers.evidence.hardware import COMMAND, STATE
from multibot_rewrite.spelling.records import Run

_JOINTS = "<joints|joint|joint_names|joint_name|dof_names>"
_INTERFACES = "<command_interfaces|command_interface|interface_name|interface_names>"
# What the parameters of controllers are usually called.
GUESSED = (
    Claim(COMMAND, f"{_JOINTS}/{_INTERFACES}"),
    Claim(STATE, f"{_JOINTS}/<state_interfaces>"),
)


def alternatives(given: Iterable[Run], known: Mapping[str, NodeFacts]) -> dict[str, str]:
    """Controllers that command what another one commands -> the condition under which they run."""
    by_owner: dict[tuple[str, str], list[str]] = defaultdict(list)
    for controller in (it for it in given if it.host_name):
        for owner in dict.fromkeys(_commanded(controller, known)):
            by_owner[controller.host_name, owner].append(controller.node)
    found: dict[str, str] = {}
    for names in (it for it in by_owner.values() if len(it) > 1):
        for name in names:
            other = next(it for it in names if it != name)
            found.setdefault(name, f"{other} does not command the same joints")
    return found


def _commanded(controller: Run, known: Mapping[str, NodeFacts]) -> Iterator[str]:
    """The joints, sensors and gpios that it commands."""
    node = known.get(controller.fact.known)
    for it in claims_of(node.claims if node else GUESSED, controller):
        if it.kind == COMMAND:
            yield it.name.rpartition("/")[0]
