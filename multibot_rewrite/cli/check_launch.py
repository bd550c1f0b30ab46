# SPDX-License-Identifier: Apache-2.0
"""``multibot check-launch``: report what is wrong with the robots that a launch file starts."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from itertools import islice

from multibot_rewrite.base.bounded import MAX_FLEET_BYTES
from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.model import InputError, MultibotError
from multibot_rewrite.base.releases import release_chosen_here
from multibot_rewrite.cli import check, pictures, unplanned
from multibot_rewrite.cli.fleet import orders_of, own_nodes
from multibot_rewrite.cli.output import note
from multibot_rewrite.cli.report import check_report, chosen
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.sources.release_said import release_of_build
from multibot_rewrite.fleet.file.simulator_switch import MOST, is_called_as_switch
from multibot_rewrite.fleet.outputs.output_file import PLAN
from multibot_rewrite.library.systems import launched_by
from multibot_rewrite.lint.launched import named_findings
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.planning.plan import read_plan
from multibot_rewrite.producers.launch.findings import not_read
from multibot_rewrite.producers.launch.includes import arguments_declared
from multibot_rewrite.producers.launch.kept_paths import read_text
from multibot_rewrite.producers.launch.launched import Launched
from multibot_rewrite.producers.launch.records import LaunchOrder
from multibot_rewrite.rules.check import check_view, side_by_side
from multibot_rewrite.rules.launch.judge import as_one_of_several, as_sure, judge_launch, placed
from multibot_rewrite.rules.launch.started import no_manager
from multibot_rewrite.system.records import System

_Read = Callable[[Sequence[LaunchOrder]], Launched]


def run(options: argparse.Namespace) -> int:
    """Read the launch file, make the graph that it would start, report; returns the exit code."""
    orders = orders_of(options, options.words)
    check_report(options, printed=False)
    pictures.check(options)
    if options.output:
        check_target(options.output, [*filter(None, [options.plan]), *(it.file for it in orders)])
    plan, own = check.plan_of(options) if options.plan else None, own_nodes(options)
    told = release_chosen_here(options.distro) or (plan.release if plan else "")
    read = partial(launched_by, told=told, nodes=own[0], nodl=own[1])
    made = read(orders)
    for it in made.system.environment.caveats:
        if not it.incomplete:
            note(options, it.message)
    found = [*_with_remedies(judge_launch(made), orders, read), *named_findings(made)]
    if options.format != "text":
        found += not_read(made.graph)
    if plan is not None:
        whose = side_by_side(plan, made.system)[1]
        sure = (as_sure(it, made, whose) for it in check_view(plan, made.with_bridged))
        judged = [*as_one_of_several(sure, plan, made.system)]
        return check.conclude(options, plan, made.system, judged, chosen(options, found))
    # What a check is told besides: there is no snapshot, and nothing to begin.
    whole = argparse.Namespace(**vars(options), snapshot=[], suggest=None)
    seen = diagnose(made.system, names=plan_beside(orders))
    sure = (as_sure(it, made, seen.whose) for it in seen.findings)
    every = (*found, *placed(sure, made, seen.whose))
    return unplanned.report_on(whole, seen._replace(findings=every))


def plan_beside(orders: Sequence[LaunchOrder]) -> System | None:
    """Return the plan that a build wrote next to the launch file; None without one."""
    path = os.path.join(os.path.dirname(orders[0].file), PLAN)
    if len(orders) > 1 or not (release_of_build(orders[0].file) and os.path.isfile(path)):
        return None
    with suppress(InputError):
        return read_plan(read_file(path, MAX_FLEET_BYTES), path)
    return None


def _with_remedies(
    found: Sequence[Finding], orders: Sequence[LaunchOrder], read: _Read
) -> list[Finding]:
    """Return the findings; a missing controller manager's hint is the argument for one."""
    # The argument is tried out: ``read`` reads launch files with other ones.
    remedy = _manager_argument(orders, read) if any(map(_is_open, found)) else ""
    return [it._replace(hint=remedy) if remedy and _is_open(it) else it for it in found]


def _is_open(it: Finding) -> bool:
    """Return whether no controller manager exists at all."""
    return it.code == no_manager.code and it.level == ERROR and len(it.names) == 1


def _manager_argument(orders: Sequence[LaunchOrder], read: _Read) -> str:
    """Return the argument of a launch file with which no manager is missing; empty for none."""
    for name, value in islice(_argument_choices(orders), MOST):
        given = ((it, [one for one in it.arguments if one[0] != name]) for it in orders)
        changed = [it._replace(arguments=(*others, (name, value))) for it, others in given]
        with suppress(MultibotError):
            other = read(changed)
            missed = any(it.code == no_manager.code for it in judge_launch(other))
            if other.models.found and not missed:
                return f"add {name}:={value}, with which a manager is started"
    return ""


def _argument_choices(orders: Sequence[LaunchOrder]) -> Iterator[tuple[str, str]]:
    """Yield the arguments that may switch to another manager, with both values."""
    declared: dict[str, None] = {}
    for it in orders:
        declared |= dict.fromkeys(sorted(arguments_declared(read_text(it.file))))
    given = {it for order in orders for it in order.arguments}
    for name in filter(is_called_as_switch, declared):
        yield from ((name, it) for it in ("true", "false") if (name, it) not in given)
