# SPDX-License-Identifier: Apache-2.0
"""Reads a built fleet back by its launch file, compares it with the plan and asks the rules.

Source: what launch does with the file, by the producer of launch files; files are looked for
where the launch file names them."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Set
from contextlib import contextmanager
from tempfile import TemporaryDirectory

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.lazy import gc_paused
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.checks.as_planned import not_as_planned, open_names
from multibot_rewrite.checks.as_printed import not_as_commanded, not_as_printed
from multibot_rewrite.checks.build import Outputs
from multibot_rewrite.checks.lacking import LACKING
from multibot_rewrite.checks.of_bringup import as_the_vendor_has_it
from multibot_rewrite.checks.two_of_each import names_one_of, two_of_each
from multibot_rewrite.description.readback.meeting import COMMAND, DATA
from multibot_rewrite.description.sources.access import BOUNDED
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.file.simulator_switch import loads_hardware, switch_for
from multibot_rewrite.fleet.fleet import known_nodes
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.launch.launch_file import LAUNCH
from multibot_rewrite.fleet.launch.launched_robot import launch_of
from multibot_rewrite.fleet.outputs.commands_file import COMMANDS
from multibot_rewrite.knowledge.nodl.lookup import declared
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.producers.launch.findings import NOT_WHOLE
from multibot_rewrite.producers.launch.launched import Launched
from multibot_rewrite.producers.launch.read import UnreadableError, read_own
from multibot_rewrite.producers.launch.records import LaunchGraph
from multibot_rewrite.producers.launch.running import Knowledge
from multibot_rewrite.producers.launch.snapshot import NO_TREE, REFUSED, launched
from multibot_rewrite.producers.launch.spawners import NO_MANAGER
from multibot_rewrite.rules.check import inconclusive_where_in_doubt, judge
from multibot_rewrite.rules.files.bridges import no_gz_topic
from multibot_rewrite.rules.launch.judge import as_sure, judge_launch, placed
from multibot_rewrite.rules.launch.started import no_joints, no_type
from multibot_rewrite.rules.system.unsent import nothing_known_sends
from multibot_rewrite.system.index import index
from multibot_rewrite.system.ownership import Whose, whose_by_plan
from multibot_rewrite.system.records import PUBLISHES, SERVES, Place, System

_GIVES = (PUBLISHES, SERVES)
_HINT = "the fleet would not start as planned; please report it, with the fleet file"


def read_back(plan: FleetPlan, made: Outputs, folder: str) -> list[Finding]:
    """Return what is wrong with the files of a fleet, which will be in ``folder``.

    Every value of the launch file is compared. Of the files two robots of each sort are read: what a
    robot has is true of its sort. All are read where they do something to each other, or name other
    ones. Nothing is read where a node cannot start: the rest would follow from that.

    Raises MultibotError where no temporary file can be written.
    """
    if any((it.code, it.level) == (LACKING.code, ERROR) for it in made.findings):
        return []
    with _temporary_folder() as home, gc_paused():
        launch = next(it.data for it in made.files if it.path == LAUNCH)
        printed = not_as_printed(made.starts, launch, home)
        wrong = [_not_whole(it.message, it.place, os.path.realpath(home)) for it in printed]
        commands = next(it.text for it in made.files if it.path == COMMANDS)
        told = not_as_commanded(made.starts, commands)
        wrong += [_not_whole(it, Place(COMMANDS, 1), home) for it in told]
    return [*dict.fromkeys((*wrong, *_findings_of_sample(plan, made, folder)))]


def _findings_of_sample(plan: FleetPlan, made: Outputs, folder: str) -> list[Finding]:
    """Return what is wrong with the files of some robots, or of all where these are not enough."""
    sample = two_of_each(made, [it.spec for it in plan.robots])
    found, graph = _read_launch(plan, sample.made, folder)
    alone = all(it.robots or it.robot in sample.alike for it in found)
    if sample.left and (not alone or names_one_of(graph, sample.left)):
        return _read_launch(plan, made, folder)[0]
    return [it._replace(robots=it.robots or sample.alike.get(it.robot, ())) for it in found]


def _read_launch(plan: FleetPlan, made: Outputs, folder: str) -> tuple[list[Finding], LaunchGraph]:
    """Return what is wrong with the files, and the graph that their launch file starts."""
    with _temporary_folder() as above, gc_paused():
        home, own = os.path.join(above, "built"), os.path.join(above, "launch")
        os.makedirs(own)
        planned = plan.file.installed or folder
        # A description names files of its own by their whole path.
        for it in made.files:
            path = os.path.join(home, it.path)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "wb") as out:
                out.write(it.data.replace(f"{planned}/".encode(), f"{home}/".encode()))
        try:
            graph = read_own(os.path.join(home, LAUNCH), own)
        except UnreadableError as error:
            return [_not_whole(f"{error}", Place(LAUNCH, 1), home)], LaunchGraph()
        # What is not here is started as the sources have it.
        packages = {it.package for it in made.starts.every if it.process.is_include}
        notes = (it for it in graph.notes if it.missing not in packages)
        graph = graph._replace(notes=tuple(notes))
        wrong, seen = _judged(plan, made, graph)
        lost = [*_missing_parts(graph, seen, home)]
        for found in wrong:
            texts = (found.file, found.message, found.hint)
            file, message, hint = (text.replace(f"{home}/", "") for text in texts)
            lost.append(found._replace(file=file, message=message, hint=hint))
        return lost, graph


def _judged(plan: FleetPlan, made: Outputs, graph: LaunchGraph) -> tuple[list[Finding], System]:
    """Return what is wrong in the system that the printed launch file starts, and that system."""
    known = _fleet_knowledge(plan)
    start = launched(graph, known)
    seen = start.system
    real = frozenset(it.spec.name for it in plan.robots if it.spec.simulator == REAL)
    whole, started = start.with_bridged, made.starts.nodes
    wrong = [*not_as_planned(made.planned, whole, started, made.findings, real)]
    told = (*wrong, *made.findings, *plan.fleet.table.problems)
    # Rows of bridges were compared with the sources: what these have is a warning.
    codes = {it.code for it in told if it.level == ERROR or it.code == no_gz_topic.code}
    # What a parameter file that is not here sets is in no written file.
    graphs = (launch_of(it.spec.launch, it.spec.words[0]) for it in plan.robots)
    if any(one.parameters for it in graphs for one in it.notes):
        codes |= {no_type.code, no_joints.code}
    by_plan = whose_by_plan(made.planned)
    # What planned nodes give that another launch file starts.
    elsewhere = {it.child for it in made.planned.edges if not {*it.publishers} <= started}
    gives = (it for it in made.planned.ends if it.node not in started and it.role in _GIVES)
    elsewhere |= {it.name for it in gives}
    shared = {*made.planned.shared_topics}
    alone = [
        it
        for it in _launch_errors(start, by_plan, codes, elsewhere)
        # Robots may share a topic which the fleet file shares.
        if it.code not in (COMMAND, DATA) or not {*it.names} <= shared
    ]
    alone = _not_open(alone, made)
    # What is an error without the plan is one line, of that level.
    errors = {(it.code, it.robot) for it in alone if it.robot}
    wrong = [it for it in wrong if (it.code, it.robot) not in errors] + alone
    # What two robots both have by their descriptions is one line, with what to do.
    both = {it.names for it in plan.fleet.table.problems if it.level == ERROR and it.names}
    wrong = [it for it in wrong if it.names not in both]
    if any(it.code == NO_MANAGER.code for it in wrong):
        remedy = _manager_hint(plan)
        wrong = [it._replace(hint=remedy) if it.code == NO_MANAGER.code else it for it in wrong]
    return [*as_the_vendor_has_it(plan, index(seen, by_plan), wrong, known)], seen


def _launch_errors(
    found: Launched, whose: Whose, told: Set[str], elsewhere: Set[str]
) -> Iterator[Finding]:
    """Yield the errors of ``multibot check-launch`` that the build has not ``told``."""
    # Descriptions and parameters were checked in the sources, names ``elsewhere`` are known.
    # ``whose`` is by the plan: a robot may have other names in frames than in topics.
    from multibot_rewrite.lint.launched import bridge_findings

    seen = index(found.system, whose)
    judged = inconclusive_where_in_doubt(judge(seen), found.system)
    between = placed((as_sure(it, found, seen) for it in judged), found, seen)
    every = (*judge_launch(found), *bridge_findings(found), *between)
    asked = (it for it in every if not elsewhere & {*it.names})
    yield from (it for it in asked if it.level == ERROR and it.code not in told)


def _not_open(found: list[Finding], made: Outputs) -> list[Finding]:
    """Return the findings, except missing senders that the plan does not have either."""
    code = nothing_known_sends.code
    if all(it.code != code for it in found):
        return found
    known = open_names(index(made.planned, whose_by_plan(made.planned)), made.findings)
    return [
        it for it in found if it.code != code or not {(code, name) for name in it.names} <= known
    ]


def _manager_hint(plan: FleetPlan) -> str:
    """Return what to write if nothing starts a controller manager: an argument, or a node set."""
    for it in (it.spec for it in plan.robots):
        given = filled(it.arguments, it.name)
        if found := switch_for(it.simulated or it.description, given, loads_hardware, BOUNDED):
            name, value = found
            first = f"write arguments: {{{name}: {value!r}}} for the description"
            return f"{first}, whose plugin starts it; or add ros2_control to `node_sets:`"
    return "add ros2_control to `node_sets:`, which starts it; or load gz_ros2_control in it"


def _fleet_knowledge(plan: FleetPlan) -> Knowledge:
    """Return what is known of nodes in the fleet's release, by its file and NoDL documents too."""
    file = plan.file
    facts = known_nodes(file.nodes, file.distro, file.nodl)
    nodes = dict(facts.library.nodes)
    named = {it.kind for one in plan.evidence.values() for it in one.nodes}
    nodes |= {name: it for one in plan.evidence.values() for name, it in one.known.items()}
    nodes |= {name: declared(facts, nodes[name]) for name in sorted(named & nodes.keys())}
    return Knowledge(nodes, load_known_nodes(file.nodes, file.distro), file.distro)


@contextmanager
def _temporary_folder() -> Iterator[str]:
    try:
        with TemporaryDirectory(prefix="multibot_built_") as folder:
            yield folder
    except OSError as error:
        file = f" {error.filename}" if error.filename else ""
        reason = f"{error.strerror or error}; free some space, or set TMPDIR"
        raise MultibotError(f"a temporary file{file} cannot be written: {reason}") from None


def _missing_parts(graph: LaunchGraph, seen: System, home: str) -> Iterator[Finding]:
    """Yield missing files of the launch file, nodes without description, and what rcl refuses."""
    for note in graph.notes:
        # A file that a plugin names and that is no file of the fleet is told where it is rewritten.
        if not note.parameters or note.file.startswith(f"{home}/"):
            yield _not_whole(note.message, note.place, home)
    for it in graph.nodes:
        # The files of the folder that it is given: as a word, or as the value of a parameter.
        paths = [word for word in it.arguments if word.startswith(f"{home}/")]
        for text in (one.text for one in it.parameters if not one.file):
            paths += re.findall(rf"(?m)^ +[\w.]+: '?({re.escape(home)}/[^\n']+)'?$", text)
        for path in paths:
            if not os.path.exists(path):
                yield _not_whole(f"{path} is not there", it.place, home)
    for caveat in seen.environment.caveats:
        if caveat.code in (REFUSED, NO_TREE):
            yield _not_whole(caveat.message, Place(LAUNCH, 1), home)


def _not_whole(message: str, place: Place, home: str) -> Finding:
    file, text = (it.replace(f"{home}/", "") for it in (place.file, message))
    return NOT_WHOLE.finding(text, _HINT, level=ERROR, file=file, line=place.line)
