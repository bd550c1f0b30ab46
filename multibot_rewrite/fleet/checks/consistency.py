"""A check of what a build has made, independent of the steps that made it.

Robots of the same sources are checked once: the first in full, the others only for being the same
but for their names.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.conventions import USUAL_FRAMES
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.companions.names.rename_map import spell
from multibot_rewrite.fleet.checks.doubled_names import doubled
from multibot_rewrite.fleet.checks.value_checks import (
    PREFIXES,
    TOKEN,
    RobotNames,
    ValueInFile,
    check_value,
    holds_twice,
)
from multibot_rewrite.fleet.fleet import Fleet
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_values import (
    OutputText,
    line_in_source,
    values_in,
)
from multibot_rewrite.fleet.robots.prefix_parameters import at_run_time, prefix_lines
from multibot_rewrite.fleet.robots.rewritten_robots import SET_PREFIX, RewrittenRobot, at_robot
from multibot_rewrite.fleet.robots.robot_nodes import node_sources
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.system.records import Place

# A word twice in a row, as in robot1/robot1/scan.
_DOUBLED = re.compile(
    r"(?<![A-Za-z0-9])([A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*?)[/_]\1(?![A-Za-z0-9])"
)

NO_LINES: frozenset[Place] = frozenset()


def consistency(
    plan: FleetPlan, fleet: Fleet, files: Sequence[OutputText], known: Iterable[Finding] = ()
) -> tuple[Finding, ...]:
    """What is wrong with the files of a fleet. ``fleet`` is the plan's fleet with all nodes that are
    started; lines that have a finding of the same or a higher level in ``known`` are left out."""
    robots = _robot_names(plan, fleet)
    lines = {(it.file, it.line, level) for it in known for level in {it.level, WARNING}}
    in_files = (*_in_files(plan, robots, files), *_in_common(robots, files))
    return (
        *_of_two_robots(plan),
        *_counted(it for it in in_files if (it.file, it.line, it.level) not in lines),
    )


def _counted(findings: Iterable[Finding]) -> Iterator[Finding]:
    """What is wrong with the names of a file is reported at its first place, with the count."""
    groups: dict[tuple[str, str], dict[int, Finding]] = {}
    for it in sorted(findings, key=lambda it: (it.file, it.line, it.message)):
        groups.setdefault((it.code, it.file), {}).setdefault(it.line, it)
    for first, *more in (list(group.values()) for group in groups.values()):
        lines = "1 more line" if len(more) == 1 else f"{len(more)} more lines"
        also = f"; the same in {lines}" if more else ""
        yield first._replace(message=f"{first.message}{also}")


def _robot_names(plan: FleetPlan, fleet: Fleet) -> list[RobotNames]:
    graph: dict[str, set[str]] = {robot.spec.namespace: set() for robot in plan.robots}
    for node in fleet.table.nodes:
        graph.setdefault(node.robot, set()).add(f"{node.namespace.rstrip('/')}/{node.name}"[1:])
    for name in fleet.table.names:
        graph.setdefault(name.robot, set()).add(name.name[1:])
    return [_names_of(robot, graph[robot.spec.namespace]) for robot in plan.robots]


def _names_of(robot: RewrittenRobot, graph: Iterable[str]) -> RobotNames:
    spec = robot.spec
    names = robot.names._replace(robot=spec.tag)
    words_of = ("link", "joint", "frame", "sensor", "group")
    kinds = {word: names.declared.get(word, ()) for word in words_of}
    bare: dict[str, set[str]] = {}
    for word, declared in (*kinds.items(), ("frame", USUAL_FRAMES)):
        for name in declared:
            bare.setdefault(name, set()).add(spell(names, word, name))
    written = (robot.member.inventory.declared, robot.member.described.declared)
    right = {name for declared in written for kind in declared.values() for name in kind}
    right |= {name for new in bare.values() for name in new}
    words = tuple(dict.fromkeys((spec.namespace, spec.tag, spec.model)))
    changed = {name: frozenset(it) for name, it in bare.items() if it != {name}}
    return RobotNames(robot, words, frozenset((*right, *graph)), changed)


SAME_NAME = declare(
    "MF601",
    "robots-declare-same-name",
    ERROR,
    what="Two robots have the same link, joint, frame, sensor or hardware component, though robots of "
    "the layout differ in it.",
    why="Messages with this name belong to both robots: joint states of one move the model of the "
    "other.",
    fix="Give one of the two robots another name, prefix or postfix, or choose another separator.",
    bad="""\
# rover.urdf has a joint left_wheel, cart.urdf a joint wheel
robots:
  - {name: rover, description: rover.urdf}
  - {name: rover_left, description: cart.urdf}
""",
    good="""\
# rover.urdf has a joint left_wheel, cart.urdf a joint wheel
robots:
  - {name: rover, description: rover.urdf}
  - {name: cart, description: cart.urdf}
""",
    line=4,
    formats=("fleet",),
    beside={
        "rover.urdf": """\
<robot name="rover">
  <link name="base_link"/>
  <link name="tire"/>
  <joint name="left_wheel" type="fixed"><parent link="base_link"/><child link="tire"/></joint>
</robot>
""",
        "cart.urdf": """\
<robot name="cart">
  <link name="base_link"/>
  <link name="tire"/>
  <joint name="wheel" type="fixed"><parent link="base_link"/><child link="tire"/></joint>
</robot>
""",
    },
)


def _of_two_robots(plan: FleetPlan) -> Iterator[Finding]:
    """What two robots declare though it is not shared; of nodes and topics the remap table says it."""
    first: dict[tuple[str, str], RewrittenRobot] = {}
    for robot, kind, name in _declared(plan):
        other = first.setdefault((kind, name), robot)
        if other is not robot:
            both = f"{other.spec.name!r} and {robot.spec.name!r}"
            message = f"two robots have the same {kind} {name!r}: {both}"
            hint = "give one of them another name, prefix or postfix"
            hint = SET_PREFIX if kind == "sensor" and robot.needs_prefix else hint
            yield at_robot(SAME_NAME, robot, message, hint)


def _declared(plan: FleetPlan) -> Iterator[tuple[RewrittenRobot, str, str]]:
    """What the rewritten descriptions declare, of the kinds that differ from robot to robot."""
    naming = plan.fleet.naming
    kinds = [
        it for it in ("link", "joint", "frame", "sensor", "hardware") if it in naming.separators
    ]
    for robot in plan.robots:
        for kind in kinds:
            names = robot.member.inventory.declared.get(kind, ())
            yield from ((robot, kind, it) for it in names if it not in naming.shared_frames)


def _in_files(
    plan: FleetPlan, robots: Sequence[RobotNames], files: Sequence[OutputText]
) -> Iterator[Finding]:
    """Every robot's own files; of files that differ only in names the first."""
    by_name = {it.robot.spec.name: it for it in robots}
    known = load_known_nodes(plan.file.nodes, plan.file.distro)
    words: dict[str, str] = {}
    for it in robots:
        words.update(dict.fromkeys(it.words, it.robot.spec.name))
    seen: dict[tuple[object, ...], set[str]] = {}
    for file in files:
        own = by_name.get(file.path.partition("/")[0])
        if own is None or "/" not in file.path:
            continue
        masked = _masked(file.text, own.words)
        like = seen.setdefault((file.sources, file.path.partition("/")[2], _pattern(own)), set())
        if masked in like:
            continue
        like.add(masked)
        others = {word: robot for word, robot in words.items() if word not in own.words}
        mine = [it for it in files if it.path.startswith(f"{own.robot.spec.name}/")]
        given = plan.evidence[node_sources(own.robot.spec)].given
        bare = at_run_time(plan.fleet.naming, given, known)
        looked = bare or any(it in file.text for it in PREFIXES)
        lines = prefix_lines(mine, known, bare) if looked else NO_LINES
        yield from _in_file(file, own, others, plan.fleet.naming, lines)


def _masked(text: str, words: Iterable[str]) -> str:
    """The text without its robot's words: equal for robots whose files differ only in these."""
    for word in sorted(words, key=len, reverse=True):
        text = text.replace(word, "\0")
    return text


def _pattern(own: RobotNames) -> tuple[object, ...]:
    """Which of a robot's words are equal: robots that differ in this cannot be compared."""
    spec = own.robot.spec
    return spec.namespace == spec.tag, spec.namespace == spec.model, spec.tag == spec.model


def _in_file(
    file: OutputText,
    own: RobotNames,
    others: Mapping[str, str],
    naming: Naming,
    prefixes: frozenset[Place],
) -> Iterator[Finding]:
    """What is wrong with its values; ``prefixes`` are the lines of prefixes that have to be there."""
    for value in values_in(file):
        before = Place(file.path, value.line) in prefixes
        for found in check_value(ValueInFile(own, others, naming, value, before)):
            yield _placed(file, own, value.line, found)


def _placed(file: OutputText, own: RobotNames, line: int, finding: Finding) -> Finding:
    """The finding at the line of the source if there is one, else at the robot in the fleet file."""
    entry = own.robot.spec.file, own.robot.spec.line
    source = line_in_source(file, line) if file.sources else entry
    where = f"{file.path}, line {line}: {finding.message}"
    return finding._replace(message=where, file=source[0], line=source[1], column=1)


def _in_common(robots: Sequence[RobotNames], files: Sequence[OutputText]) -> Iterator[Finding]:
    """Files of all robots together: names that hold a robot twice."""
    words = {word: it for it in robots for word in it.words}
    for file in files:
        if "/" in file.path or not file.sources:
            continue
        # Most lines are the same for every robot.
        lines = "\n".join(dict.fromkeys(file.text.splitlines()))
        for token in dict.fromkeys(TOKEN.findall(lines)):
            found = _DOUBLED.search(token)
            own = words.get(found[1]) if found else None
            if found and own and doubled(token, own.words, own.right, own.bare):
                line = file.text.count("\n", 0, file.text.index(token)) + 1
                yield _placed(file, own, line, holds_twice(token, found[1]))
