"""``multibot view``: the rewritten robots in 3D, as one HTML file."""

from __future__ import annotations

import argparse
import os

from multibot_rewrite.cli.output import deliver, note, say
from multibot_rewrite.cli.process import DONE, PROGRAM
from multibot_rewrite.cli.usage import check_xacro, plain_words, policy, xacro_args
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.fleets.fleet_file import input_files, read_fleet
from multibot_rewrite.fleets.fleet_plan import FleetPlan, plan_fleet
from multibot_rewrite.graph.snapshot_file import read_snapshots
from multibot_rewrite.model import UsageError
from multibot_rewrite.plural import plural
from multibot_rewrite.view.models import ViewUnusable
from multibot_rewrite.view.page import title_of, to_html
from multibot_rewrite.view.scene import scene_of

NO_VIEW = 4


def run(options: argparse.Namespace) -> int:
    """Rewrite, load, write the page; returns the exit code."""
    plan = _plan(options)
    check_target(options.output, [*input_files(plan.file), *options.snapshot])
    graph = read_snapshots(options.snapshot) if options.snapshot else None
    try:
        robots = scene_of(plan, graph)
        page = to_html(robots, title_of(robots, plan.fleet.naming.layout.name))
    except ViewUnusable as error:
        say(str(error), PROGRAM)
        return NO_VIEW
    missing = {
        it.missing for one in robots for its in one.model.links.values() for it in its if it.missing
    }
    for it in sorted(missing):
        note(options, f"note: {it}, it is shown as a box")
    deliver(options, page)
    size = f"{len(page) / 1e6:.1f} MB"
    note(
        options,
        f"wrote {options.output}: {plural(len(robots), 'robot')}, {size}; open it in a browser",
    )
    return DONE


def _plan(options: argparse.Namespace) -> FleetPlan:
    """The fleet of a fleet file, or of a description and names of robots."""
    first, *_ = words = [options.input, *plain_words(options)]
    if first.endswith((".yaml", ".yml")):
        if words[1:] or xacro_args(options):
            raise UsageError(f"{first}: a fleet file has its own robots, leave out {words[-1]}")
        return plan_fleet(read_fleet(first, options.distro or "", os.environ), trust=options.trust)
    check_xacro(options, [first])
    names = words[1:] or ["robot1"]
    data = {
        **policy(options),
        "description": first,
        "arguments": xacro_args(options),
        "robots": [{"name": name, "pose": {"y": 1.5 * at}} for at, name in enumerate(names)],
    }
    given = {key: value for key, value in data.items() if value}
    return plan_fleet(read_fleet(given, options.distro or "", os.environ), trust=options.trust)
