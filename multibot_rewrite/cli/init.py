"""``multibot init``: a first fleet file for the robots that are there."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence

from multibot_rewrite.cli.output import STANDARD, deliver, goes_to_file, note, say
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.usage import plain_words, xacro_args
from multibot_rewrite.model import UsageError
from multibot_rewrite.naming import LAYOUTS, find_layout
from multibot_rewrite.plural import plural
from multibot_rewrite.proposal.choosing import Choice
from multibot_rewrite.proposal.fleet_text import Proposal, text_of
from multibot_rewrite.proposal.looking import Looked
from multibot_rewrite.proposal.propose import Wanted, propose
from multibot_rewrite.proposal.trying import in_a_layout_that_builds, in_layout
from multibot_rewrite.releases import release_here

_MEANT = "as it was asked for"
_SIMULATORS = ("gazebo", "none")


def run(options: argparse.Namespace) -> int:
    """Look, ask, try, write; returns the exit code."""
    if options.count == 0:
        raise UsageError("--count 0: a fleet has at least one robot")
    _check_output(options)
    asks = not options.yes and sys.stdin.isatty() and sys.stderr.isatty()
    wanted = Wanted(
        tuple(plain_words(options)) or (os.curdir,),
        options.count or (_count() if asks else 2),
        xacro_args(options),
        release_here(options.distro),
        find_layout(options.layout).name if options.layout else "",
        options.trust,
    )
    made = propose(wanted, _choose if asks else lambda found: found[:1])
    made = _answered(options, made, asks)
    tried = in_a_layout_that_builds(made, wanted.release, wanted.trust)
    return _deliver(options, tried)


def _check_output(options: argparse.Namespace) -> None:
    path = options.output
    if path != STANDARD and os.path.lexists(path) and not options.force:
        raise UsageError(
            f"{path} is there already; name another with -o, or --force writes over it"
        )


def _answered(options: argparse.Namespace, made: Proposal, asks: bool) -> Proposal:
    """The proposal with what the user says of layout and simulator."""
    layout, simulator = made.keys["layout"], made.keys["simulator"]
    if asks and not options.layout:
        names = [it.name for it in LAYOUTS]
        for it in LAYOUTS:
            say(f"  {it.name}: {it.about}", PROGRAM)
        layout = _chosen(f"Layout ({layout.why})", names, layout)
    if options.simulator:
        simulator = Choice(options.simulator, _MEANT)
    elif asks:
        simulator = _chosen(f"Simulator ({simulator.why})", _SIMULATORS, simulator)
    made = made._replace(keys={**made.keys, "simulator": simulator})
    return made if layout == made.keys["layout"] else in_layout(made, layout)


def _chosen(question: str, words: Sequence[str], default: Choice) -> Choice:
    word = _ask(question, words, default.value)
    return default if word == default.value else Choice(word, _MEANT)


def _ask(question: str, words: Sequence[str], default: str) -> str:
    from rich.console import Console  # only a question needs it
    from rich.prompt import Prompt

    console = Console(stderr=True)
    return str(Prompt.ask(question, choices=list(words), default=default, console=console))


def _count() -> int:
    from rich.console import Console
    from rich.prompt import IntPrompt

    return IntPrompt.ask("Robots of each description", default=2, console=Console(stderr=True))


def _choose(found: Sequence[Looked]) -> Sequence[Looked]:
    """The one that the user takes of several; numbers are easier to type than paths."""
    if len(found) == 1:
        return found
    for at, it in enumerate(found, 1):
        say(f"  {at}: {it.path} ({plural(it.links, 'link')})", PROGRAM)
    numbers = [str(at) for at in range(1, len(found) + 1)]
    return [found[int(_ask("Description", numbers, "1")) - 1]]


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
