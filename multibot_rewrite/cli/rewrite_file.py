# SPDX-License-Identifier: Apache-2.0
"""``urdf-postfix`` for a related file: parameters, RViz, MoveIt, a bridge, a tree, Lua."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import Any

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import facts_of_release, release_here, why_here
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli.process import DONE, STOPPED
from multibot_rewrite.cli.rewrite_use import (
    CHANGES,
    check_shared,
    check_unread,
    deliver,
    input_name,
    is_stopped,
    tell,
)
from multibot_rewrite.cli.usage import rewriting
from multibot_rewrite.description.sources.job import read_whole
from multibot_rewrite.description.sources.read import Source
from multibot_rewrite.library.one_file import RewrittenFile, rewrite_files
from multibot_rewrite.related_files.named_file import BRIDGE, LUA, MOVEIT, PARAMS, RVIZ, TREE

WORDS = {
    PARAMS: "a parameter file",
    RVIZ: "a config of RViz",
    MOVEIT: "a file of MoveIt",
    BRIDGE: "a file of ros_gz_bridge",
    TREE: "a behavior tree",
    LUA: "a Lua file",
}


def run(options: argparse.Namespace, source: Source, names: list[str]) -> int:
    """Rewrite a related file for each robot; returns the exit code."""
    if options.undo or options.output_kind == CHANGES:
        what = "--undo" if options.undo else "--output-kind changes"
        raise UsageError(f"{what} is for descriptions, {input_name(options)} is none; leave it out")
    before = read_whole(source, {}, options.trust)

    def made(naming: Mapping[str, Any]) -> list[RewrittenFile]:
        how = {**rewriting(options), **naming}
        return list(rewrite_files(before.data, names, file=input_name(options), **how))

    every = made({})
    check_shared(options, every, made, {})
    check_unread(options, names, before.read)
    release = release_here(options.distro or "")
    if is_stopped(options, (finding for it in every for finding in it.findings), names, release):
        return STOPPED
    results = ((it.robot, before.data, it.data) for it in every)
    deliver(options, results, len(names))
    tell(options, summary(every, names, release, why_here(options.distro)))
    return DONE


def summary(made: list[RewrittenFile], robots: list[str], release: str, of_release: str) -> str:
    """Return one line: the kind of the file, and whether the result is verified."""
    who = robots[0] if len(robots) == 1 else plural(len(robots), "robot")
    why = dict.fromkeys(it for one in made for it in one.not_verified)
    end = f"Not verified: {', '.join(why)}" if why else "Verified"
    return f"{who}: rewrote {WORDS[made[0].kind]}. {end}{facts_of_release(release, of_release)}"
