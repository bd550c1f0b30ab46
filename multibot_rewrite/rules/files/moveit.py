# SPDX-License-Identifier: Apache-2.0
"""Groups and controller managers of a MoveIt file that the robots of a fleet do not have."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.companions.kinds import MOVEIT
from multibot_rewrite.companions.moveit.rewrite import asks_below_root
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.sites import slot_of
from multibot_rewrite.rules.declaration import robots_rule
from multibot_rewrite.rules.places import remark


@rule(
    "MB892",
    "moveit-groups-without-srdf",
    WARNING,
    formats=(MOVEIT,),
    options={"build": True, "groups": "rename"},
)
def groups_without_srdf(file: NamedFile) -> Iterator[Finding]:
    """Each group, at its first place."""
    names = file.context.names
    asked = "group" in names.naming.separators and not names.declared.get("group")
    groups = {it.text: it for it in reversed(file.names) if it.kind == "group"}
    for text, site in groups.items() if asked and file.is_certain else ():
        message = f"groups are renamed, but no SRDF is given, so {text!r} stays unchanged"
        yield remark(site, message, "name the SRDF under srdf:")


@robots_rule(
    "MB893",
    "moveit-one-controller-manager",
    WARNING,
    MOVEIT,
    options={"build": True, "layout": "postfix"},
)
def one_controller_manager(file: NamedFile) -> Iterator[Finding]:
    """Places that select a controller manager which no robot has."""
    if file.document is None or file.context.names.naming.topics == NAMESPACE:
        return
    key = asks_below_root(file.document)
    slots = [slot_of(key)] if key else []
    for slot in (*slots, *(it.slot for it in file.names if it.kind == "namespace")):
        message = "MoveIt looks for /controller_manager, but each robot's has a different name"
        yield remark(
            slot, message, "use moveit_simple_controller_manager or a layout with namespaces"
        )
