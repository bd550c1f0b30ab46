"""The questions of ``multibot init``: what no file says, each with a default that Enter takes."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from itertools import pairwise

from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.base.plural import plural
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.cli.output import say
from multibot_rewrite.cli.process import PROGRAM
from multibot_rewrite.fleet.proposal.choosing import Choice, names_of
from multibot_rewrite.fleet.proposal.fleet_text import Proposal
from multibot_rewrite.fleet.proposal.looking import Looked
from multibot_rewrite.fleet.proposal.propose import Seen, Wanted, release_of, with_arguments
from multibot_rewrite.fleet.proposal.trying import in_layout, that_builds

MEANT = "as it was asked for"
SIMULATORS = ("gazebo", "none")
LEFT_OUT = "it was left out"
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def ask_for_fleet(seen: Seen, wanted: Wanted, simulator: str) -> Proposal:
    """The fleet that the user describes; what ``wanted`` or ``simulator`` says is not asked."""
    robots = seen.robots if seen.named else _chosen(seen.robots)
    wanted = _with_names(wanted) if len(robots) == 1 else _with_count(wanted)
    if not wanted.named:
        release = release_of(robots, wanted)
        word = _one_of("ROS release", release.why, RELEASES, release)
        wanted = wanted._replace(release=word, named=True)
    robots = [_with_arguments(it, wanted) for it in robots]
    made = that_builds(robots, seen.found, wanted)
    refused = dict(made.refused) | dict.fromkeys(_left_out(made), LEFT_OUT)
    wanted = wanted._replace(apart=_apart(made))
    made = that_builds(robots, seen.found, wanted, refused)
    if not wanted.layout:
        made = _in_layout(made)
    return made if simulator else _with_simulator(made)


def _chosen(found: Sequence[Looked]) -> Sequence[Looked]:
    """The one that the user takes of several; numbers are easier to type than paths."""
    if len(found) == 1:
        return found
    for at, it in enumerate(found, 1):
        say(f"  {at}: {it.path} ({plural(it.links, 'link')})", PROGRAM)
    numbers = [str(at) for at in range(1, len(found) + 1)]
    return [found[int(_ask("Description", "1", numbers)) - 1]]


def _with_count(wanted: Wanted) -> Wanted:
    if wanted.each:
        return wanted
    return wanted._replace(each=int(_valid("Robots of each description", "2", _is_count)))


def _with_names(wanted: Wanted) -> Wanted:
    """A number is enough: the robots are robot1, robot2 then."""
    if wanted.names:
        return wanted
    given = "2" if not wanted.each else ", ".join(names_of([""], wanted.each)[0])
    text = _valid("Robots: how many, or their names", given, _is_robots)
    if text.strip().isdigit():
        return wanted._replace(each=int(text))
    names = tuple(text.replace(",", " ").split())
    return wanted._replace(each=len(names), names=names)


def _with_arguments(robot: Looked, wanted: Wanted) -> Looked:
    """The arguments of a xacro that name the robot, or that it needs and nobody gave."""
    (it,) = with_arguments([robot], wanted)
    asked = [(name, value) for name, value in it.arguments if name not in wanted.arguments]
    if asked:
        say("  {robot} stands for the name of each robot", PROGRAM)
    values = {name: _ask(f"Argument {name} of the xacro", value) for name, value in asked}
    return it._replace(arguments=tuple({**dict(it.arguments), **values}.items()), needed=())


def _left_out(made: Proposal) -> list[str]:
    """The files beside the descriptions that the user does not want."""
    paths = list(dict.fromkeys(path for it in made.members for path in it.companions.paths))
    if not paths:
        return []
    for at, path in enumerate(paths, 1):
        say(f"  {at}: {path}", PROGRAM)
    numbers = {str(at): path for at, path in enumerate(paths, 1)}

    def fits(text: str) -> bool:
        return text in ("none", "all") or all(it in numbers for it in _words(text))

    text = _valid("Files to leave out: numbers, all, or none", "none", fits)
    if text == "all":
        return paths
    return [numbers[it] for it in _words(text)] if text != "none" else []


def _apart(made: Proposal) -> float:
    """Metres from robot to robot; 0 where they differ already, or there is one robot."""
    places = [it["y"] for it in made.poses.values()]
    steps = {round(after - before, 3) for before, after in pairwise(places)}
    if len(steps) != 1:
        return 0.0
    (default,) = steps
    return float(_valid("Metres from robot to robot", f"{default:g}", _is_length))


def _in_layout(made: Proposal) -> Proposal:
    layout = made.keys["layout"]
    for it in LAYOUTS:
        say(f"  {it.name}: {it.about}", PROGRAM)
    word = _one_of("Layout", layout.why, [it.name for it in LAYOUTS], layout)
    return made if word == layout.value else in_layout(made, Choice(word, MEANT))


def _with_simulator(made: Proposal) -> Proposal:
    simulator = made.keys["simulator"]
    word = _one_of("Simulator", simulator.why, SIMULATORS, simulator)
    chosen = simulator if word == simulator.value else Choice(word, MEANT)
    return made._replace(keys={**made.keys, "simulator": chosen})


def _words(text: str) -> list[str]:
    return text.replace(",", " ").split()


def _is_count(text: str) -> bool:
    return text.isdigit() and int(text) > 0


def _is_robots(text: str) -> bool:
    names = _words(text)
    apart = len(set(names)) == len(names)
    return _is_count(text) or (bool(names) and apart and all(map(_NAME.fullmatch, names)))


def _is_length(text: str) -> bool:
    return re.fullmatch(r"\d{1,4}(\.\d+)?", text) is not None and float(text) > 0


def _one_of(what: str, why: str, words: Sequence[str], default: Choice) -> str:
    return _ask(f"{what} ({why})", str(default.value), words)


def _valid(question: str, default: str, fits: Callable[[str], bool]) -> str:
    """The answer, asked for again until it fits."""
    while not fits(text := _ask(question, default).strip()):
        say(f"  {text!r} does not fit", PROGRAM)
    return text


def _ask(question: str, default: str, words: Sequence[str] | None = None) -> str:
    from rich.console import Console  # only a question needs it
    from rich.prompt import Prompt

    choices = list(words) if words else None
    console = Console(stderr=True)
    return str(Prompt.ask(question, choices=choices, default=default, console=console))
