# SPDX-License-Identifier: Apache-2.0
"""``multibot init``: a first fleet file for the robots that are there; what no file says is asked."""

from __future__ import annotations

import argparse
import os
import re
import shlex
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import redirect_stderr
from io import StringIO
from itertools import pairwise
from typing import TypeVar

from multibot_rewrite.base.editors import FLEET
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import LAYOUTS, find_layout
from multibot_rewrite.base.releases import RELEASES, VARIABLE, release_here
from multibot_rewrite.base.rosnames import check_robot_names
from multibot_rewrite.base.wording import plural, shorten
from multibot_rewrite.cli.output import STANDARD, deliver, detail, goes_to_file, note, say, status
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.usage import asked_number, plain_words, xacro_args
from multibot_rewrite.description.sources.expand import kept_expansions
from multibot_rewrite.knowledge.node_library import nodes_of_set
from multibot_rewrite.knowledge.node_sets import every_release
from multibot_rewrite.producers.launch.records import LaunchOrder, launch_order, order_in_words
from multibot_rewrite.proposal.fleet_text import text_of
from multibot_rewrite.proposal.launches import order_text
from multibot_rewrite.proposal.looking import Looked
from multibot_rewrite.proposal.propose import MEANT, Choice, Proposal, names_of, release_of
from multibot_rewrite.proposal.searching import Found, Undecided, is_below
from multibot_rewrite.proposal.seeing import Seen, Wanted, see, with_arguments
from multibot_rewrite.proposal.trying import (
    as_named,
    first_that_builds,
    in_layout,
    that_builds,
    with_faults_of_sources,
)

SIMULATORS = ("gazebo", "none")
# Nodes of launch files that are named on the terminal.
_NAMED = 6
# Descriptions that cannot be read, and are named on the terminal; the fleet file has all.
MOST_BROKEN = 3
LEFT_OUT, NONE = "it was left out", "none"
_T = TypeVar("_T")
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


@kept_expansions()
def run(options: argparse.Namespace) -> int:
    """Look, ask, try, write; returns the exit code."""
    asked_number(options)
    names = options.robots
    if names and options.count:
        raise UsageError("--robots and --count: give one of them")
    check_robot_names(names)
    _check_output(options)
    wanted = _wanted(options)
    seen = _with_progress(wanted, see)
    if wanted.names and seen.named and len(seen.robots) > 1:
        raise UsageError(
            "--robots is for one description; for several leave it out, then name, add or remove"
            " robots in the fleet file"
        )
    if wanted.launch and seen.named and len(seen.robots) > 1:
        raise UsageError(
            "--launch is for one description; name one, or write launch: into the file"
        )
    if not options.yes and sys.stdin.isatty() and sys.stderr.isatty():
        made = ask_for_fleet(seen, wanted)
    else:
        wanted = wanted._replace(each=wanted.each or 2)
        build = as_named if seen.named else first_that_builds
        made = _with_progress(wanted, lambda it: build(seen, it))
    _check_arguments(made, wanted)
    whole = _with_progress(wanted, lambda it: with_faults_of_sources(made, it))
    robots = dict.fromkeys(it.path for it in (*seen.robots, *seen.alike))
    others = tuple(it for it in robots if it in whole.others)
    whole = whole._replace(broken=seen.broken, others=others)
    done = _write_fleet(options, whole, wanted.file)
    for path, fault in [*seen.broken.items()][:MOST_BROKEN]:
        say(f"{path} was not used: {fault}", PROGRAM)
    if others:
        # Which description was taken, and how another one is.
        taken = whole.members[0].looked.path
        which = f"{taken} is one of {len(others) + 1} descriptions"
        note(options, f"{which}; for another: multibot init {shlex.quote(others[0])}")
    return done


def _with_progress(wanted: Wanted, call: Callable[[Wanted], _T]) -> _T:
    """Return the result of a call, with progress on the terminal and without xacro's warnings."""
    # The build reports those of the files that are used.
    show = status()
    try:
        with redirect_stderr(StringIO()):
            return call(wanted._replace(tell=show))
    finally:
        show("")


def _wanted(options: argparse.Namespace) -> Wanted:
    """Return the options as ``Wanted``."""
    if options.launch and os.path.isfile(options.launch[0]):
        # What follows a launch file is its arguments, or a description again.
        options.words += [it for it in options.launch[1:] if ":=" not in it]
        options.launch = [options.launch[0], *(it for it in options.launch[1:] if ":=" in it)]
    wanted = Wanted(
        tuple(plain_words(options)) or (os.curdir,),
        len(options.robots) or options.count or 0,
        xacro_args(options),
        release_here(options.distro),
        bool(options.distro or os.environ.get(VARIABLE)),
        find_layout(options.layout).name if options.layout else "",
        options.trust,
        tuple(options.robots),
        simulator=options.simulator or "",
        launch=_launch_orders(options),
        node_sets=tuple(options.node_set),
    )
    for it in wanted.node_sets:
        nodes_of_set(every_release(), it)
    return wanted._replace(file=options.output) if goes_to_file(options) else wanted


def _launch_orders(options: argparse.Namespace) -> tuple[LaunchOrder, ...] | None:
    """Return the named launch files, none for ``--launch none``; None without the option."""
    words = options.launch
    if not words or words == [NONE]:
        return () if words else None
    text, roots = " ".join(words), [it for it in options.words if os.path.isdir(it)]
    # One word may be a path with blanks, or all that follows ``ros2 launch``.
    whole = bool(words[1:]) or os.path.isfile(text)
    order = order_in_words(words, text, roots) if whole else launch_order(text, roots)
    if not os.path.isfile(order.file):
        raise UsageError(f"{order.file}: there is no such launch file; correct --launch")
    if any(is_below(order.file, it) for it in roots):
        order = order._replace(package="", roots=(), file=os.path.relpath(order.file))
    return (order._replace(trusted=options.trust),)


def _check_arguments(made: Proposal, wanted: Wanted) -> None:
    """Raise UsageError for a value that no xacro of the fleet takes; an SRDF may be one that does."""
    taken = {name for it in made.members for name, _ in it.looked.arguments}
    left = [f"{name}:={value}" for name, value in wanted.arguments.items() if name not in taken]
    if left and not any(it.related_files.srdf.endswith(".xacro") for it in made.members):
        files = ", ".join(it.looked.path for it in made.members)
        raise UsageError(f"{left[0]}: no argument of {files} has this name; leave it out")


def _check_output(options: argparse.Namespace) -> None:
    path = options.output
    if path != STANDARD and os.path.lexists(path) and not options.force:
        raise UsageError(
            f"{path} is there already; name another with -o, or --force writes over it"
        )


def _write_fleet(options: argparse.Namespace, made: Proposal, file: str) -> int:
    text = text_of(made, file)
    if options.verbose and goes_to_file(options):
        sys.stdout.write(text)
    deliver(options, text.encode(), FLEET)
    for line in (*made.notes, *filter(None, (made.chosen,))):
        say(line, PROGRAM)
    for path, at, why in (*made.unread, *made.others_unread):
        detail(options, f"{path}:{at}: {why}")
    robots = sum(len(it.names) for it in made.members)
    files = {os.path.basename(it.looked.path) for it in made.members}
    each = f", {options.count} of each," if options.count and len(made.members) > 1 else ""
    what = f"{plural(robots, 'robot')}{each} of {', '.join(sorted(files))}, {made.keys['layout'].value}"
    if goes_to_file(options):
        note(
            options,
            f"wrote {options.output}: {what}; next: multibot build {options.output} -o out/",
        )
    if started := [who.partition(" ")[0] for _, _, who in made.started]:
        listed = shorten(started, _NAMED)
        note(options, f"started by launch files and not by this fleet: {listed}")
    for it in made.members:
        others = it.bringup.others if it.bringup else ()
        if it.bringup and others:
            paths, other = shlex.join(options.words), order_text(others[0], os.curdir)
            which = f"{it.bringup.name} starts most of {plural(len(others) + 1, 'launch file')}"
            note(options, f"{which}; for another: multibot init {paths} --launch {other}")
    return STOPPED if made.notes else DONE


def ask_for_fleet(seen: Seen, wanted: Wanted) -> Proposal:
    """Return the fleet that the user describes; what ``wanted`` has is not asked."""
    robots = seen.robots if seen.named else _choose_description([seen.robots[0], *seen.rivals])
    wanted = _with_names(wanted) if len(robots) == 1 else _with_count(wanted)
    if not wanted.named:
        release = release_of(robots, seen.found, wanted)
        word = _ask_one_of("ROS release", RELEASES, release)
        wanted = wanted._replace(release=word, named=True)
    named = wanted.launch
    wanted = _with_launch(robots[0], wanted, seen.found) if len(robots) == 1 else wanted
    robots = [_with_arguments(it, wanted, seen.found) for it in robots]
    found, made = _with_files_asked_for(robots, seen.found, wanted, {})
    refused = dict(made.refused) | dict.fromkeys(_unwanted_files(made), LEFT_OUT)
    wanted = wanted._replace(apart=_ask_distance(made))
    made = _with_progress(wanted, lambda it: that_builds(robots, found, it, refused))
    if not wanted.layout:
        made = _ask_layout(made)
    if wanted.simulator:
        return made
    simulator = made.keys["simulator"]
    word = _ask_one_of("Simulator", SIMULATORS, simulator)
    if word == simulator.value:
        return made
    layout = str(made.keys["layout"].value)
    wanted = wanted._replace(simulator=word, layout=layout, launch=named)
    return _with_progress(wanted, lambda it: that_builds(robots, found, it, refused))


def _choose_description(found: Sequence[Looked]) -> Sequence[Looked]:
    """Return the description that the user chooses, in a list."""
    if len(found) == 1:
        return found
    shown = [f"{it.path} ({plural(it.links, 'link')})" for it in found]
    return [found[_ask_which(shown, "Description", "1", or_none=False) or 0]]


def _with_files_asked_for(
    robots: Sequence[Looked], found: Found, wanted: Wanted, refused: Mapping[str, str]
) -> tuple[Found, Proposal]:
    """Return the files with the user's choices, and the fleet that is made of them."""
    try:
        return found, _with_progress(wanted, lambda it: that_builds(robots, found, it, refused))
    except Undecided as question:
        say(f"{question}".partition(": ")[0], PROGRAM)
        files = [*question.files]
        at = _ask_which([*map(question.said, files)], "The one that is meant", NONE)
    meant = () if at is None else (files[at],)
    left = {it: LEFT_OUT for it in files if it not in meant}
    found = found._replace(meant=(*found.meant, *meant))
    return _with_files_asked_for(robots, found, wanted, {**refused, **left})


def _ask_which(
    shown: Sequence[str], question: str, default: str, or_none: bool = True
) -> int | None:
    """Return the index of the chosen item; None for the answer ``none``."""
    for at, it in enumerate(shown, 1):
        say(f"  {at}: {it}", PROGRAM)
    numbers = [str(at) for at in range(1, len(shown) + 1)]
    answer = _ask(question, default, [*numbers, NONE] if or_none else numbers)
    return None if answer == NONE else int(answer) - 1


def _with_count(wanted: Wanted) -> Wanted:
    if wanted.each:
        return wanted
    return wanted._replace(each=int(_ask_until_valid("Robots of each description", "2", _is_count)))


def _with_names(wanted: Wanted) -> Wanted:
    """Return ``wanted`` with names of robots; for a number N they are robot1 to robotN."""
    if wanted.names:
        return wanted
    given = "2" if not wanted.each else ", ".join(names_of([""], wanted.each)[0])
    text = _ask_until_valid("Robots: how many, or their names", given, _is_robots)
    if text.strip().isdigit():
        return wanted._replace(each=int(text))
    names = tuple(_split_list(text))
    return wanted._replace(each=len(names), names=names)


def _with_launch(robot: Looked, wanted: Wanted, found: Found) -> Wanted:
    """Return ``wanted`` with the launch file that starts the robot; the user may choose none."""
    (it,) = _with_progress(wanted, lambda asked: with_arguments([robot], asked, found))
    if wanted.launch is not None or it.bringup is None or not it.bringup.others:
        return wanted
    orders = [it.bringup.order, *it.bringup.others]
    shown = [order_text(one, os.curdir) for one in orders]
    at = _ask_which(shown, "Launch file that starts the robot", "1")
    return wanted._replace(launch=() if at is None else (orders[at],))


def _with_arguments(robot: Looked, wanted: Wanted, found: Found) -> Looked:
    """Return the robot with values for the xacro arguments that name it or have no default."""
    (it,) = _with_progress(wanted, lambda asked: with_arguments([robot], asked, found))
    asked = [(name, value) for name, value in it.arguments if name not in wanted.arguments]
    if asked:
        say("  {robot} stands for the name of each robot", PROGRAM)
    values = {name: _ask(f"Argument {name} of the xacro", value) for name, value in asked}
    return it._replace(arguments=tuple({**dict(it.arguments), **values}.items()), needed=())


def _unwanted_files(made: Proposal) -> list[str]:
    """Return the related files that the user does not want."""
    paths = list(dict.fromkeys(path for it in made.members for path in it.related_files.paths))
    if not paths:
        return []
    for at, path in enumerate(paths, 1):
        say(f"  {at}: {path}", PROGRAM)
    numbers = {str(at): path for at, path in enumerate(paths, 1)}

    def fits(text: str) -> bool:
        return text in ("none", "all") or all(it in numbers for it in _split_list(text))

    text = _ask_until_valid("Files to leave out: numbers, all, or none", "none", fits)
    if text == "all":
        return paths
    return [numbers[it] for it in _split_list(text)] if text != "none" else []


def _ask_distance(made: Proposal) -> float:
    """Return metres from robot to robot; 0 if their poses differ already, or there is one robot."""
    places = [it["y"] for it in made.poses.values()]
    steps = {round(after - before, 3) for before, after in pairwise(places)}
    if len(steps) != 1:
        return 0.0
    (default,) = steps
    return float(_ask_until_valid("Metres from robot to robot", f"{default:g}", _is_length))


def _ask_layout(made: Proposal) -> Proposal:
    layout = made.keys["layout"]
    for it in LAYOUTS:
        say(f"  {it.name}: {it.about}", PROGRAM)
    word = _ask_one_of("Layout", [it.name for it in LAYOUTS], layout)
    return made if word == layout.value else in_layout(made, Choice(word, MEANT))


def _split_list(text: str) -> list[str]:
    return text.replace(",", " ").split()


def _is_count(text: str) -> bool:
    return text.isdigit() and int(text) > 0


def _is_robots(text: str) -> bool:
    names = _split_list(text)
    apart = len(set(names)) == len(names)
    return _is_count(text) or (bool(names) and apart and all(map(_NAME.fullmatch, names)))


def _is_length(text: str) -> bool:
    return re.fullmatch(r"\d{1,4}(\.\d+)?", text) is not None and float(text) > 0


def _ask_one_of(what: str, words: Sequence[str], default: Choice) -> str:
    return _ask(f"{what} ({default.why})", str(default.value), words)


def _ask_until_valid(question: str, default: str, fits: Callable[[str], bool]) -> str:
    """Return the answer to a question, which is repeated until the answer fits."""
    while not fits(text := _ask(question, default).strip()):
        say(f"  {text!r} does not fit", PROGRAM)
    return text


def _ask(question: str, default: str, words: Sequence[str] | None = None) -> str:
    """Ask on the terminal and return the answer."""
    from rich.console import Console  # only a question needs it
    from rich.prompt import Prompt

    choices = list(words) if words else None
    console = Console(stderr=True)
    return str(Prompt.ask(question, choices=choices, default=default, console=console))
