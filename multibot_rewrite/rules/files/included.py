# SPDX-License-Identifier: Apache-2.0
"""What a behavior tree or Lua file takes from elsewhere: other files, names made when it runs."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.companions.kinds import LUA, TREE
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.names.by_kind import frames_differ
from multibot_rewrite.rules.declaration import of_robots
from multibot_rewrite.rules.places import remark


@rule(
    "MB887", "included-file", WARNING, formats=(LUA, TREE), options={"robots": ("robot1", "robot2")}
)
@of_robots
def included_file(file: NamedFile) -> Iterator[Finding]:
    """Each file that is included."""
    key = "behavior_trees" if file.kind == TREE else "lua"
    for site in file.included:
        message = f"the included file {site.text!r} is not rewritten with this one"
        yield remark(site, message, f"if it has names, list it under {key} as well")


@rule(
    "MB888",
    "lua-frame-not-plain",
    WARNING,
    formats=(LUA,),
    options={"robots": ("robot1", "robot2")},
)
@of_robots
def computed_frame(file: NamedFile) -> Iterator[Finding]:
    """Each such frame, where robots have frames of their own."""
    for site in file.computed if frames_differ(file.context) else ():
        message = f"{site.key} is not a plain string, so it stays unchanged"
        yield remark(site, message, "each robot needs its own frame here; write the name in quotes")
