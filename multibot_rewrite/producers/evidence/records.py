# SPDX-License-Identifier: Apache-2.0
"""Records of evidence: what a robot's files say of its nodes, each with its place."""

from __future__ import annotations

from collections.abc import Mapping

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.params.rcl_parameters import Value
from multibot_rewrite.system.records import Place


class Given(NamedTuple):
    """The value of a parameter, with the type that rcl gives it, and where it is set."""

    value: Value
    place: Place


class GivenNode(NamedTuple):
    """What a robot's parameter files set for one node.

    ``name`` is its name without the robot, ``known`` the known node that it is (empty for none),
    ``type`` the plugin type of a controller. ``values`` are its parameters by dotted name, those of
    wildcard sections with them. ``manager`` is the controller manager that has it as a controller.
    ``known`` may be a guess by its parameters: ``unknown_type`` is true if its type is not known,
    ``like`` the known type that may be meant.
    """

    name: str
    known: str
    type: str
    values: Mapping[str, Given]
    place: Place
    manager: str = ""
    unknown_type: bool = False
    like: str = ""
