# SPDX-License-Identifier: Apache-2.0
"""The nodes that a robot runs, by node sets and its own files, under rules of what starts them.

A file and a node set that disagree: the file wins, and the disagreement is a note.

Of controllers that command the same joint, sensor or gpio only one can be active. Source: ros2_control
controller_manager.cpp and resource_manager.cpp (a command interface is claimed by one active
controller), and the hardware, which moves a joint in one mode at a time."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding, declare
from multibot_rewrite.base.rosnames import RemapRule, expand
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.knowledge.controller_ways import controller_way
from multibot_rewrite.knowledge.declared import NODE, plugin_bases
from multibot_rewrite.knowledge.records import UNKNOWN, Claim, NodeFacts
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.evidence.filling import filled
from multibot_rewrite.producers.evidence.hardware import claims_of
from multibot_rewrite.system.records import COMMAND, STATE, Origin

MANAGER = "controller_manager"
NOT_DECLARED = declare(
    "MF801",
    "controller-not-declared",
    NOTE,
    formats=("params",),
    options={"node_sets": "ros2_control"},
)
UNKNOWN_TYPE = declare("MF802", "controller-type-not-known", WARNING, formats=("params",))


NO_TYPE = declare("MF825", "spawned-controller-without-type", NOTE, formats=("fleet",))
NOBODY = declare("MF858", "section-of-an-unknown-node", NOTE, formats=("params",))
ALWAYS: Mapping[str, str] = {}
_DESCRIBE = "describe it in a file of nodes (docs/node-sets.md)"


class RobotNodes(NamedTuple):
    """The nodes that a robot runs, each with its origin, and where files and node sets disagree."""

    nodes: tuple[NodeFacts, ...]
    findings: tuple[Finding, ...]


def nodes_of(
    node_set: Sequence[NodeFacts],
    given: Sequence[Run],
    known: Mapping[str, NodeFacts],
    spawned: Mapping[str, str] = ALWAYS,
) -> RobotNodes:
    """Return the nodes of a robot: those of its node sets as its files have them, and its files' own.

    ``spawned`` are the conditions of controllers of which launch files say whether they run."""
    # No supported release has a node that is called as before: nothing reads its section.
    given = [it for it in given if it.node.rpartition("/")[2] not in plugin_bases()[NODE].older]
    sections = {it.name: _section_of(it, given) for it in node_set}
    left, kept = _left_out(node_set, given, sections, known)
    either = {**alternatives(given, known), **spawned}
    nodes = [_filled_node_of_set(it, sections[it.name], known, either, spawned) for it in kept]
    names = {it.node for it in filter(None, sections.values())}
    of_set = {it.place.file for it in given if it.node in names}
    sent = {child for node in kept for child in children_of(node)}
    # Controllers that files declare, and known nodes with a process of their own.
    others = ((it, known.get(it.fact.known)) for it in given if it.node not in names)
    more = [it for it, entry in others if it.host_name or (entry is not None and not entry.host)]
    meant: dict[str, NodeFacts] = {}
    for node in (it for it in node_set if it not in kept):
        alike = [it.node for it in more if not it.host_name and _stands_for(it, node, known)]
        # Of several, as two filters with rules of their own, it is not known which stands for it.
        meant |= {alike[0]: node} if len(alike) == 1 else {}
    for it in more:
        if it.node in meant:
            entry = known[it.fact.known]
            nodes.append(filled(entry, it)._replace(when=meant[it.node].when, known=entry.kind))
            continue
        node = _node_of_file(it, known, either.get(it.node, ""))
        doubtful = not it.host_name and (it.place.file in of_set or sent & {*children_of(node)})
        nodes.append(node._replace(sends=()) if doubtful else node)
    nobody = _unstarted_sections(
        it for it in given if it.node not in names and not (it.host_name or it.fact.known)
    )
    doubtful_types = (*_unknown_types(given), *_of_another_release(given, known))
    findings = sorted((*left, *nobody, *doubtful_types), key=lambda it: (it.file, it.line))
    return RobotNodes(tuple(nodes), tuple(findings))


def _section_of(node: NodeFacts, given: Sequence[Run]) -> Run | None:
    """Return what the files set for a node of a node set, maybe below a namespace; None without."""
    exact = (it for it in given if it.node == node.name)
    below = (it for it in given if it.node.endswith(f"/{node.name}"))
    return next(exact, None) or next(below, None)


def _left_out(
    node_set: Sequence[NodeFacts],
    given: Sequence[Run],
    sections: Mapping[str, Run | None],
    known: Mapping[str, NodeFacts],
) -> tuple[list[Finding], list[NodeFacts]]:
    """Return notes about nodes that the files contradict, and the other nodes of the node sets."""
    controllers = [it for it in given if it.host_name]
    findings: list[Finding] = []
    kept = []
    for node in node_set:
        if sections[node.name] is None and node.host == MANAGER and controllers:
            beside = controllers[0]
            file, line, _ = beside.place
            message = f"{node.name} of the node set is declared in no file; it is left out"
            hint = f"declare it together with {beside.node}, or name a node set without it"
            found = NOT_DECLARED.finding(message, hint, file=file, line=line)
            findings += [] if node.when else [found]
        elif sections[node.name] or not any(_stands_for(it, node, known) for it in given):
            kept.append(node)
    return findings, kept


def _stands_for(given: Run, node: NodeFacts, known: Mapping[str, NodeFacts]) -> bool:
    """Return whether a file has a node of a node set by another name, or one that sends the same."""
    if given.fact.known == node.name:
        return True
    entry = known.get(given.fact.known)
    same = entry is not None and entry.package == node.package and entry.sends == node.sends
    return same and bool(node.sends)


def children_of(node: NodeFacts) -> Iterator[str]:
    """Yield the frames that a node sends."""
    frames = {it.parameter: it.default for it in node.frames}
    yield from (frames[it.child] for it in node.sends)


def _filled_node_of_set(
    node: NodeFacts,
    section: Run | None,
    known: Mapping[str, NodeFacts],
    either: Mapping[str, str],
    spawned: Mapping[str, str],
) -> NodeFacts:
    """Return a node of a node set as files have it; a declared controller needs no condition."""
    if section is None:
        return node
    made = filled(node, section, known.get(node.known))
    asked = "" if section.host_name else node.when
    when = spawned.get(section.node, asked or either.get(section.node, ""))
    return made._replace(name=node.name, when=when)


def _node_of_file(given: Run, known: Mapping[str, NodeFacts], either: str) -> NodeFacts:
    """Return a node of a file alone: a controller runs unless ``either``, another node may run."""
    node = known.get(given.fact.known)
    if node is None:
        package = given.program.partition("/")[0]
        return UNKNOWN._replace(
            name=given.node,
            package=package,
            host=MANAGER,
            when=either,
            origin=Origin(place=given.place),
        )
    runs = given.host_name or node.name == MANAGER
    when = either or node.when if runs else f"its parameters are in {given.place.file}"
    return filled(node, given)._replace(when=when)


def _unstarted_sections(given: Iterable[Run]) -> Iterator[Finding]:
    """Report sections of nodes that are unknown and not started, once for each file."""
    for file, nodes in groupby(given, lambda it: it.place.file):
        first, *rest = nodes
        own = shorten([it.node for it in (first, *rest)])
        message = f"no launch file and no node set starts {own}; the plan has no such node"
        hint = f"name its launch file under launch:, or {_DESCRIBE}"
        yield NOBODY.finding(message, hint, file=file, line=first.place.line, column=1)


def _unknown_types(given: Sequence[Run]) -> Iterator[Finding]:
    """Report controllers without a type, or of an unknown one."""
    for it in given:
        place = it.place
        if it.host_name and not (it.program or it.fact.known):
            message = f"controller {it.node} is spawned, and no file says its type"
            hint = "name the file with its type under params, or as --param-file of the spawner"
            yield NO_TYPE.finding(message, hint, file=place.file, line=place.line, column=1)
        if it.host_name and it.unknown_type:
            message = f"controller {it.node} is of type {it.program}, which is not known"
            meant = it.fact.known
            taken = f"the plan takes it for a {meant}" if meant else "the plan has its name alone"
            # What it claims, if its parameters have their usual names.
            names = list(dict.fromkeys(one.name for one in claims_of(GUESSED, it)))
            claims = f"; by its parameters it seems to claim {shorten(names)}" if names else ""
            hint = f"{_DESCRIBE}; {taken}{claims}"
            hint = f"did you mean {it.like}?" if it.like else hint
            yield UNKNOWN_TYPE.finding(message, hint, file=place.file, line=place.line, column=1)


def _of_another_release(given: Sequence[Run], known: Mapping[str, NodeFacts]) -> Iterator[Finding]:
    """Report controllers whose types the release lacks."""
    for it in given:
        if it.host_name and it.fact.known and not it.unknown_type and it.fact.known not in known:
            message = f"controller {it.node} is of type {it.program}, which this release lacks"
            hint = "the manager cannot load it; use a type of the release, or name the right distro"
            yield UNKNOWN_TYPE.finding(
                message, hint, file=it.place.file, line=it.place.line, column=1
            )


_JOINTS = "<joints|joint|joint_names|joint_name|dof_names>"
_INTERFACES = "<command_interfaces|command_interface|interface_name|interface_names>"
# What the parameters of controllers are usually called.
GUESSED = (
    Claim(COMMAND, f"{_JOINTS}/{_INTERFACES}"),
    Claim(STATE, f"{_JOINTS}/<state_interfaces>"),
)


def alternatives(given: Iterable[Run], known: Mapping[str, NodeFacts]) -> dict[str, str]:
    """Return the condition under which each controller runs that commands what another one commands."""
    by_owner: dict[tuple[str, str], list[str]] = defaultdict(list)
    for controller in (it for it in given if it.host_name):
        # The joints, sensors and gpios that it commands.
        node = known.get(controller.fact.known)
        claims = claims_of(node.claims if node else GUESSED, controller)
        owners = (it.name.rpartition("/")[0] for it in claims if it.kind == COMMAND)
        for owner in dict.fromkeys(owners):
            by_owner[controller.host_name, owner].append(controller.node)
    found: dict[str, str] = {}
    for names in (it for it in by_owner.values() if len(it) > 1):
        for name in names:
            other = next(it for it in names if it != name)
            found.setdefault(name, f"{other} does not command the same joints")
    return found


def remapped(node: NodeFacts, rules: Iterable[tuple[str, str]], namespace: str) -> NodeFacts:
    """Return the node with its launch file's remap rules and namespace; tf rules are the layout's."""
    above = namespace.rstrip("/")
    below, _, name = node.name.rpartition("/")
    home = above.removesuffix(f"/{below}") if below else above
    targets = {
        expand(old, above, name): _resolved_target(new, above, home)
        for old, new in reversed([it for it in rules if it[0] not in ("/tf", "/tf_static")])
    }
    ends = []
    for it in node.endpoints:
        target = targets.get(expand(it.name, above, name), it.name)
        ends.append(it._replace(remapped=target) if target != it.name else it)
    return node._replace(endpoints=tuple(ends))


def under_plugin(
    node: NodeFacts, rules: Iterable[RemapRule], release: str, alone: bool
) -> NodeFacts:
    """Return a controller under its plugin's rules, if these reach it; ``alone``: not usual ones."""
    if not (node.is_controller and controller_way(release).of_manager):
        return node
    above, _, own = node.name.rpartition("/")
    mine = ((it.source, it.target) for it in rules if it.node in ("", own))
    ends = (it._replace(remapped="") if alone else it for it in node.endpoints)
    return remapped(node._replace(endpoints=tuple(ends)), mine, f"/{above}")


def _resolved_target(new: str, above: str, home: str) -> str:
    """Return a rule's target for a robot in ``home``, for a node in the namespace ``above``."""
    inner = above != home and not new.startswith(("/", "~"))
    full = f"{above}/{new}" if inner else new
    mine = full.removeprefix(f"{home}/") if home else full
    # From a namespace in that of the robot, only this leads to the robot's.
    return f"/{mine}" if above != home and mine[0] not in "/~" else mine
