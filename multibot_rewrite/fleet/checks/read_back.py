"""A built fleet is read back as a machine would that knows nothing of it: the launch file, and what
that names. Then it is compared with the plan that was built, and asked the rules.

Source: what launch does with the file, by the producer of launch files; files are looked for where the
launch file names them.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from tempfile import TemporaryDirectory

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.launch.launch_file import LAUNCH
from multibot_rewrite.fleet.outputs.output_file import PLAN, OutputFile
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.producers.launch.findings import NOT_WHOLE
from multibot_rewrite.producers.launch.read import UnreadableError, read_own
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph
from multibot_rewrite.producers.launch.running import Knowledge
from multibot_rewrite.producers.launch.snapshot import NO_TREE, REFUSED, would_run
from multibot_rewrite.rules.check import ABSENCE, check
from multibot_rewrite.spelling.plan_file import read_plan
from multibot_rewrite.system.records import Place, System

_HINT = "the fleet would not start as planned; please report it, with the fleet file"


def read_back(plan: FleetPlan, files: Sequence[OutputFile], folder: str) -> list[Finding]:
    """What is wrong with the files of a fleet, which will be in ``folder``.

    Raises MultibotError where no temporary file can be written.
    """
    with _temporary_folder() as above:
        home, own = os.path.join(above, "built"), os.path.join(above, "launch")
        os.makedirs(own)
        _write(files, plan.file.installed or folder, home)
        try:
            graph = read_own(os.path.join(home, LAUNCH), own)
        except UnreadableError as error:
            return [_fault(f"{error}", Place(LAUNCH, 1), home)]
        known = Knowledge(
            {it.name: it for one in plan.evidence.values() for it in one.known.values()},
            load_known_nodes(plan.file.nodes, plan.file.distro),
            plan.file.distro,
        )
        seen = would_run(graph, known)
        planned = read_plan(next(it.data for it in files if it.path == PLAN), PLAN)
        return [*_lost(graph, seen, home), *_wrong(planned, seen)]


@contextmanager
def _temporary_folder() -> Iterator[str]:
    try:
        with TemporaryDirectory(prefix="multibot_built_") as folder:
            yield folder
    except OSError as error:
        file = f" {error.filename}" if error.filename else ""
        reason = error.strerror or error
        raise MultibotError(f"a temporary file{file} cannot be written: {reason}") from None


def _write(files: Iterable[OutputFile], planned: str, home: str) -> None:
    """The files in another folder; a description names files of its own by their whole path."""
    for it in files:
        path = os.path.join(home, it.path)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as out:
            out.write(it.data.replace(f"{planned}/".encode(), f"{home}/".encode()))


def _lost(graph: LaunchGraph, seen: System, home: str) -> Iterator[Finding]:
    """What the launch file names and is not there, a node without its description, and what rcl refuses
    to start."""
    for note in graph.notes:
        # A file that a plugin names and that is no file of the fleet is told where it is rewritten.
        if not note.parameters or f"{home}/" in note.message:
            yield _fault(note.message, note.place, home)
    for it in graph.nodes:
        for path in _named(it, home):
            if not os.path.exists(path):
                yield _fault(f"{path} is not there", it.place, home)
    for caveat in seen.environment.caveats:
        if caveat.code in (REFUSED, NO_TREE):
            yield _fault(caveat.message, Place(LAUNCH, 1), home)


def _named(it: LaunchedNode, home: str) -> Iterator[str]:
    """The files of the folder that a node is given: as a word, or as the value of a parameter."""
    values = (one.text for one in it.parameters if not one.file)
    yield from (word for word in it.arguments if word.startswith(f"{home}/"))
    for text in values:
        yield from re.findall(rf"(?m)^ +[\w.]+: '?({re.escape(home)}/[^\n']+)'?$", text)


def _fault(message: str, place: Place, home: str) -> Finding:
    own = {"file": place.file.replace(f"{home}/", ""), "line": place.line, "column": 1}
    text = message.replace(f"{home}/", "")
    return NOT_WHOLE.finding(text, _HINT, **own)._replace(level=ERROR)


def _wrong(planned: System, seen: System) -> Iterator[Finding]:
    """What a check of the running fleet would say: warnings, since parameters can still be set where it
    runs. What is missing may be started by others, as a simulator or a driver is."""
    for it in check(planned, seen):
        if it.level == ERROR and it.code not in ABSENCE:
            yield it._replace(level=WARNING)
