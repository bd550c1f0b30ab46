# SPDX-License-Identifier: Apache-2.0
"""What a behavior tree or Lua file takes from elsewhere: other files, names made when it runs."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.companions.kinds import LUA, TREE
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.names.by_kind import frames_differ
from multibot_rewrite.rules.files.records import Remark, of_robots, remark


def _options(line: str) -> str:
    return f"options = {{\n  {line},\n}}\n"


@rule(
    "MB887",
    "included-file",
    WARNING,
    what="A behavior tree includes another one, or a Lua file one that is not of Cartographer itself.",
    why="The included file is not rewritten with this one. The names in it are then the same for all "
    "robots.",
    fix="List that file in the fleet file as well, if it has names.",
    bad='include "my_frames.lua"\n' + _options('tracking_frame = "base_link"'),
    good='include "map_builder.lua"\n' + _options('tracking_frame = "base_link"'),
    formats=(LUA, TREE),
    options={"robots": ("robot1", "robot2")},
)
@of_robots
def included_file(file: NamedFile) -> Iterator[Remark]:
    """Each file that is included."""
    key = "behavior_trees" if file.kind == TREE else "lua"
    for site in file.included:
        message = f"the included file {site.text!r} is not rewritten with this one"
        yield remark(site, message, f"if it has names, list it under {key} as well")


@rule(
    "MB888",
    "lua-frame-not-plain",
    WARNING,
    what="A frame of Cartographer is not a plain string, so it stays unchanged.",
    why="Its value is known only when Lua runs the file. If it is the same for each robot, all "
    "robots publish the same frame.",
    fix="Write the name in quotes, as for a single robot.",
    bad=_options('tracking_frame = "base" .. "_link"'),
    good=_options('tracking_frame = "base_link"'),
    line=2,
    formats=(LUA,),
    options={"robots": ("robot1", "robot2")},
)
@of_robots
def computed_frame(file: NamedFile) -> Iterator[Remark]:
    """Each such frame, where robots have frames of their own."""
    for site in file.computed if frames_differ(file.context) else ():
        message = f"{site.key} is not a plain string, so it stays unchanged"
        yield remark(site, message, "each robot needs its own frame here; write the name in quotes")
