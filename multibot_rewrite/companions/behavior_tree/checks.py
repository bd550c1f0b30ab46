"""Trees that a behavior tree includes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.companions.behavior_tree.ports import Port, place_of
from multibot_rewrite.description.steps.document import Document

INCLUDE = declare(
    "MF403",
    "tree-includes-file",
    WARNING,
    what="A behavior tree includes another file.",
    why="The included file is not rewritten with this one. The names in it are then the same for "
    "all robots.",
    fix="List that file under behavior_trees as well.",
    bad="""\
<root BTCPP_format="4">
  <include path="recovery.xml"/>
</root>
""",
    good="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Recovery"><Spin spin_dist="1.57"/></BehaviorTree>
</root>
""",
    line=2,
    formats=("tree",),
)


def included_files(document: Document, ports: Iterable[Port]) -> Iterator[Finding]:
    """The files that are included, in their order."""
    for port in (it for it in ports if it.element.tag == "include"):
        line, column = place_of(document, port)
        message = f"includes another tree, {port.value!r}"
        hint = "list that file under behavior_trees as well"
        yield INCLUDE.finding(message, hint, file=document.file, line=line, column=column)
