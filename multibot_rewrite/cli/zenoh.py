"""``multibot zenoh``: configurations of Zenoh's router and sessions, with access control per robot."""

from __future__ import annotations

import argparse
import os

from multibot_rewrite.cli import live
from multibot_rewrite.cli.check import plan_of
from multibot_rewrite.cli.output import note, write_files
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.graph.environment import settings
from multibot_rewrite.graph.zenoh.configuration import Setup, configurations, file_names
from multibot_rewrite.model import UsageError
from multibot_rewrite.plural import plural
from multibot_rewrite.system.records import System


def run(options: argparse.Namespace) -> int:
    """Write one file for the router, one a robot, one an operator; returns the exit code."""
    domain = settings(live.environ(options.domain)).domain
    operators = tuple(dict.fromkeys(options.operator)) if options.keystore else ()
    if options.operator and not options.keystore:
        raise UsageError("--operator is known by a certificate: give --keystore as well")
    keystore = (options.keystore or "").rstrip("/")
    setup = Setup(options.router, domain, keystore, operators, options.own_routers)
    plan = plan_of(options)
    _check_names(plan, setup)
    files = [
        (os.path.join(options.output, name), data) for name, data in configurations(plan, setup)
    ]
    for path, _ in files:
        check_folder(path)
        check_target(path, [options.plan])
    write_files(options, files)
    note(options, _summary(plan, options, setup))
    return DONE


def _check_names(plan: System, setup: Setup) -> None:
    """Raises UsageError where two would have one file, and so one certificate."""
    names = file_names(plan, setup)
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        word = twice[0].removesuffix(".json5")
        hint = "choose another name for the robot or --operator"
        raise UsageError(f"{twice[0]}: two of robots, operators and router are {word}; {hint}")


def _summary(plan: System, options: argparse.Namespace, setup: Setup) -> str:
    told = "certificate" if setup.keystore else "its own file alone"
    robots = plural(len(plan.robots), "robot")
    return f"{robots} in {options.output}, each kept to its names by {told}; domain {setup.domain}"
