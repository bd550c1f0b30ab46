# SPDX-License-Identifier: Apache-2.0
"""The ends of a remap table as rows."""

from typing import NamedTuple

from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.planning.records import Table


class NamedEnd(NamedTuple):
    """An end, the full name of its node, and its full name."""

    robot: str
    node: str
    endpoint: Endpoint
    name: str


def named_ends(table: Table) -> list[NamedEnd]:
    """Every end of the table."""
    return [NamedEnd(run.robot, run.full_name, end, name) for run, end, name in table.ends]
