# SPDX-License-Identifier: Apache-2.0
"""What launch files can import of launch and launch_ros, or have in XML and YAML: ``launch.yaml``."""

from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

from multibot_rewrite.base.bounded import load_own_yaml


class Names(NamedTuple):
    """The names in each module, and those of which only the name is known (``not_read``).

    ``inside`` are modules of packages; ``parameters`` packages that make parameters alone;
    ``executed`` and ``passed`` actions; ``elements`` have words, with ``groups`` of them;
    ``substitutions`` classes."""

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
