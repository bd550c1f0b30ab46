"""Trees that a behavior tree includes."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.companions.behavior_tree.ports import ports_of
from multibot_rewrite.companions.sites import found_in
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


def included_files(document: Document) -> Iterator[Finding]:
    """The files that are included, in their order."""
    for element, site in ports_of(document):
        if element.tag == "include":
            message = f"includes another tree, {site.text!r}"
            hint = "list that file under behavior_trees as well"
            yield found_in(document.file, site.slot, INCLUDE, message, hint)
