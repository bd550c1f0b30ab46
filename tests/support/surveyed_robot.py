# SPDX-License-Identifier: Apache-2.0
"""A small robot, and what is collected and counted of it."""

from __future__ import annotations

from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.steps.collect import Inventory, collect
from multibot_rewrite.description.steps.document import read_document
from tools.survey import Survey, survey


def inventory(text: str, file: str = "a.urdf") -> Inventory:
    return collect(read_document(text.encode(), file), builtin_tree((), NEWEST_LTS))


def surveyed(body: str, file: str = "a.urdf") -> Survey:
    """Return a survey of a robot with the links base and arm, the joint hip and ``body``."""
    joint = '<joint name="hip" type="fixed"><parent link="base"/><child link="arm"/></joint>'
    text = f'<robot name="r"><link name="base"/><link name="arm"/>{joint}{body}</robot>'
    return survey(inventory(text, file), builtin_tree((), NEWEST_LTS))
