# SPDX-License-Identifier: Apache-2.0
"""Displays of RViz that show nothing, whatever robot they are for."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING, Finding, rule
from multibot_rewrite.related_files.named_file import RVIZ, NamedFile
from multibot_rewrite.related_files.rviz.read_config import rviz_data, text_of, value
from multibot_rewrite.related_files.yaml_text import pairs
from multibot_rewrite.rules.declaration import remark_at, robots_rule


@rule("MB872", "rviz-ros1-property", WARNING, formats=(RVIZ,))
def ros1_property(file: NamedFile) -> Iterator[Finding]:
    """Report each property of a display that is of ROS 1."""
    for one in file.shown:
        for key, _ in pairs(one.node):
            if key.value in rviz_data()["legacy"]:
                message = f"{key.value!r} of {one.name!r} is a ROS 1 property, which rviz2 ignores"
                yield remark_at(key, message, "set its Topic in rviz2")


@rule("MB873", "rviz-description-volatile", WARNING, formats=(RVIZ,))
def volatile_description(file: NamedFile) -> Iterator[Finding]:
    """Yield one finding for all volatile description topics: nearly every saved config has one."""
    found = [
        one
        for one in file.shown
        if text_of(value(one.node, "Description Topic"), "Durability Policy") == "Volatile"
    ]
    if found:
        names = ", ".join(repr(one.name) for one in found)
        message = f"display {names} is Volatile: it misses a description sent before rviz2 starts"
        hint = "set Durability Policy: Transient Local below Description Topic"
        yield remark_at(found[0].node, message, hint)


@robots_rule("MB891", "rviz-unknown-display", WARNING, RVIZ)
def unknown_display(file: NamedFile) -> Iterator[Finding]:
    """Report each display of an unknown class."""
    for one in file.shown:
        if not one.known:
            message = f"display class {one.cls!r} is not known; only its Topic is renamed"
            yield remark_at(one.node, message, "check its other topics and frames")
