"""A description that is read, planned and cut: what is left to do is to put a robot's name in."""

from __future__ import annotations

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.plan import Plan


class Template(NamedTuple):
    """A description ready for any number of robots: parsed, planned and cut once."""

    inventory: Inventory
    plan: Plan
    pieces: list[bytes]
    findings: list[Finding]
    naming: Naming
    tree: Tree
    urdf_declarations: Declared
