# SPDX-License-Identifier: Apache-2.0
"""``multibot plan``: what the graph of a fleet should look like, and the rules that make it so."""

from __future__ import annotations

import argparse
import re

from multibot_rewrite.base.editors import PLAN as PLAN_SCHEMA
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import facts_of_release, release_chosen_here
from multibot_rewrite.cli import fleet
from multibot_rewrite.cli.output import deliver, goes_to_file, note, say
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.tables import Grid, deliver_report
from multibot_rewrite.cli.usage import given_options, robots
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.fleet.fleet import NO_STATE_PUBLISHER, Fleet, expected, possible
from multibot_rewrite.planning.bridged_topics import as_yaml, bridged_topics
from multibot_rewrite.planning.enclaves import to_policy
from multibot_rewrite.planning.plan import to_yaml
from multibot_rewrite.planning.table_formats import FORMS, given_to, standing_by_robot
from multibot_rewrite.system.coverage import Coverage, coverage
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.ownership import without_name
from multibot_rewrite.system.records import System, doubts

PLAN, POLICY = "plan", "sros2"
# How a plan calls a robot without a name; its frames are those of its description.
ALONE, LAYOUT_ALONE = "robot1", "tf-per-robot"
# What a plan of a description has, and that of a launch file has not.
_OF_ROBOTS = ("robots", "count", "node_set", "launch", "layout", "affix", "topics", "separator")
NOT_OF_LAUNCH = {it: f"--{it.replace('_', '-')}" for it in (*_OF_ROBOTS, "shared")}
# A launch file is told by its name: no description or fleet file is called so.
_LAUNCH = re.compile(r".*(\.py|[._]launch(\.\w+)?|system_model\.yaml)")
TABLE, BRIDGE = "table", "bridge"


def run(options: argparse.Namespace) -> int:
    """Make the plan and write what is asked for of it; returns the exit code."""
    if any(map(_LAUNCH.fullmatch, [options.input, *options.words[:1]])):
        return _plan_launch(options)
    fleet.check_use(options, "plan", printed=not goes_to_file(options))
    # A robot that is called nothing; a layout, or rules, are for one with a name.
    unnamed = not options.input.endswith(fleet.FLEET_FILES) and not robots(options)
    named = given_options(options, {"layout": "--layout"}) or options.output_kind != PLAN
    alone = unnamed and not named
    if alone:
        options.words, options.layout = [ALONE], LAYOUT_ALONE
    made = fleet.build(options)
    failed = fleet.report_table(options, made)
    if options.output_kind == PLAN:
        plan = expected(made)
        _write(options, without_name(plan) if alone else plan)
        _note_coverage(options, coverage(plan))
    elif options.output_kind == POLICY:
        deliver(options, to_policy(expected(made), possible(made)).encode())
    else:
        deliver_rules(options, made)
    return STOPPED if failed else DONE


def _note_coverage(options: argparse.Namespace, held: Coverage) -> None:
    """Print how much of the robots the plan has, unless it has all."""
    if not held.is_whole:
        note(options, held.in_words)


def _write(options: argparse.Namespace, plan: System) -> None:
    """Write the plan as YAML or JSON."""
    if (options.output or "").endswith(".json"):
        deliver(options, to_json(plan))
    else:
        deliver(options, to_yaml(plan).encode(), PLAN_SCHEMA)


def _plan_launch(options: argparse.Namespace) -> int:
    """Write the plan of what a launch file starts; returns the exit code."""
    from multibot_rewrite.cli.check_launch import plan_beside  # a fleet needs none of it
    from multibot_rewrite.library.systems import launched_by
    from multibot_rewrite.live.diagnose import diagnose
    from multibot_rewrite.live.seen_plan import seen_plan

    given = given_options(options, NOT_OF_LAUNCH)
    if given or options.output_kind != PLAN:
        what = given[0] if given else "--output-kind"
        raise UsageError(f"{options.input}: a launch file says what runs, leave out {what}")
    orders = fleet.orders_of(options, [options.input, *options.words])
    if options.output:
        check_target(options.output, [it.file for it in orders])
        check_folder(options.output)
    made = launched_by(
        orders, release_chosen_here(options.distro), *fleet.own_nodes(options)
    ).system
    seen = diagnose(made, names=plan_beside(orders))
    if not made.nodes:
        raise UsageError(f"{orders[0].file}: it starts no node, so there is no plan")
    for caveat in doubts(made):
        say(f"incomplete: {caveat.message}", PROGRAM)
    _write(options, seen_plan(seen)._replace(release=made.release))
    _note_coverage(options, seen.coverage)
    return DONE


def deliver_rules(options: argparse.Namespace, made: Fleet) -> None:
    """Write the rules in the form that is asked for."""
    table = made.named_table
    known = {node.robot for node in table.runs}
    nothing = [name for name in map(made.name, made.inventories) if name not in known]
    if nothing:
        hint = f"name a node set of its nodes, or leave out {NO_STATE_PUBLISHER}"
        note(options, f"no node of {', '.join(nothing)} is known, so no rule is for it; {hint}")
    if options.output_kind == TABLE:
        rows = [
            (robot, it.node.node, it.node.full_name, text, given_to(it))
            for robot, given in standing_by_robot(table)
            for it in given
            for text in ([f"{source} -> {target}" for source, target in it.rules] or ["no rule"])
        ]
        head = f"layout {table.layout}{facts_of_release(table.release)}"
        grid = Grid(("robot", "node", "runs as", "rule", "given to"), rows)
        deliver_report(options, (head, grid))
    elif options.output_kind == BRIDGE:
        deliver(options, _bridge_text(options, made).encode())
    else:
        deliver(options, FORMS[options.output_kind](table).encode())


def _bridge_text(options: argparse.Namespace, made: Fleet) -> str:
    carried, left = bridged_topics(
        made.inventories, made.naming, made.models, made.table.runs, made.placed
    )
    for item in left:
        message = f"line {item.line}: {item.what} is not bridged: {item.why}"
        note(options, f"{made.name(item.robot)}: warning: {message} ({item.hint})")
    if not any(it.robot for it in carried):
        note(options, "no robot has a topic in Gazebo to bridge")
        return ""
    return as_yaml(carried)
