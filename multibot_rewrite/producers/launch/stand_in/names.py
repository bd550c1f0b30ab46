# SPDX-License-Identifier: Apache-2.0
"""What can be imported of launch and launch_ros, and what launch files in XML and YAML are made of:
``launch.yaml``."""

from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

from multibot_rewrite.base.bounded import load_own_yaml


class Names(NamedTuple):
    """The names in each module, those of which only the name is known, and modules inside of packages;
    packages that make parameters alone;
    actions that are executed and those that are passed; the words of each element, with ``groups`` of
    them; the class of each substitution."""

    read: Mapping[str, str]
    not_read: Mapping[str, str]
    inside: Mapping[str, str]
    parameters: str
    executed: str
    passed: str
    groups: Mapping[str, str]
    elements: Mapping[str, str]
    substitutions: Mapping[str, str]


@cache
def names() -> Names:
    """Return the names of ``launch.yaml``."""
    return Names(**load_own_yaml(__file__, "launch.yaml"))
