"""``multibot init``: a first fleet file for the robots that are there."""

from __future__ import annotations

import argparse
import os
import sys

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import find_layout
from multibot_rewrite.base.plural import plural
from multibot_rewrite.base.releases import VARIABLE, release_here
from multibot_rewrite.base.rosnames import check_robot_name
from multibot_rewrite.cli.output import STANDARD, deliver, goes_to_file, note, say
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.questions import MEANT, ask_for_fleet
from multibot_rewrite.cli.usage import plain_words, xacro_args
from multibot_rewrite.fleet.proposal.choosing import Choice
from multibot_rewrite.fleet.proposal.fleet_text import Proposal, text_of
from multibot_rewrite.fleet.proposal.propose import Wanted, see
from multibot_rewrite.fleet.proposal.trying import first_that_builds, that_builds


def run(options: argparse.Namespace) -> int:
    """Look, ask, try, write; returns the exit code."""
    if options.count == 0:
        raise UsageError("--count 0: a fleet has at least one robot")
    _check_names(options)
    _check_output(options)
    wanted = _wanted(options)
    seen = see(wanted)
    if wanted.names and seen.named and len(seen.robots) > 1:
        raise UsageError("--robots is for one description; give --count for several")
    if not options.yes and sys.stdin.isatty() and sys.stderr.isatty():
        made = ask_for_fleet(seen, wanted, options.simulator)
    else:
        build = that_builds if seen.named else first_that_builds
        made = build(seen.robots, seen.found, wanted._replace(each=wanted.each or 2))
    if options.simulator:
        simulator = Choice(options.simulator, MEANT)
        made = made._replace(keys={**made.keys, "simulator": simulator})
    return _deliver(options, made)


def _wanted(options: argparse.Namespace) -> Wanted:
    """What the options say."""
    return Wanted(
        tuple(plain_words(options)) or (os.curdir,),
        len(options.robots) or options.count or 0,
        xacro_args(options),
        release_here(options.distro),
        bool(options.distro or os.environ.get(VARIABLE)),
        find_layout(options.layout).name if options.layout else "",
        options.trust,
        tuple(options.robots),
    )


def _check_names(options: argparse.Namespace) -> None:
    names = options.robots
    if names and options.count:
        raise UsageError("--robots and --count: give one of them")
    for name in names:
        check_robot_name(name)
        if names.count(name) > 1:
            raise UsageError(f"--robots: {name} is there twice; every robot needs its own name")


def _check_output(options: argparse.Namespace) -> None:
    path = options.output
    if path != STANDARD and os.path.lexists(path) and not options.force:
        raise UsageError(
            f"{path} is there already; name another with -o, or --force writes over it"
        )


def _deliver(options: argparse.Namespace, made: Proposal) -> int:
    folder = os.path.dirname(options.output) if goes_to_file(options) else ""
    name = os.path.basename(options.output) if goes_to_file(options) else "fleet.yaml"
    text = text_of(made, folder or os.curdir, name)
    if options.verbose and goes_to_file(options):
        sys.stdout.write(text)
    deliver(options, text.encode())
    for line in made.notes:
        say(line, PROGRAM)
    robots = sum(len(it.names) for it in made.members)
    files = {os.path.basename(it.looked.path) for it in made.members}
    what = f"{plural(robots, 'robot')} of {', '.join(sorted(files))}, {made.keys['layout'].value}"
    if goes_to_file(options):
        note(
            options,
            f"wrote {options.output}: {what}; next: multibot build {options.output} -o out/",
        )
    return STOPPED if made.notes else DONE
