"""What a build has made, looked through once more: nothing that made it is trusted.

Robots of the same sources are looked through once: the first in full, the others for being the same
but for their names.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from multibot_rewrite.companions.names.rename_map import spell
from multibot_rewrite.fleets.fleet import Fleet
from multibot_rewrite.fleets.fleet_plan import FleetPlan
from multibot_rewrite.fleets.output_values import OutputText, OutputValue, line_in_source, values_in
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleets.tf_conflicts import tf_conflicts
from multibot_rewrite.graph.expectation import USUAL_FRAMES
from multibot_rewrite.model import ERROR, WARNING, Finding
from multibot_rewrite.naming import Naming

TF = ("/tf", "/tf_static")
# Parameters and properties that put something before frames when the nodes run.
PREFIXES = frozenset({"frame_prefix", "tf_prefix", "TF Prefix"})
ENABLES = "tf_frame_prefix_enable"
# Keys that name one frame.
_FRAME_KEY = re.compile(r"(?:^|_)(?:frame|frame_id|link)$")
_TOKEN = re.compile(r"[A-Za-z0-9_~/.-]*[A-Za-z0-9_]")
_BETWEEN = "/_-."
# What is no name of the graph, whatever stands in it.
_OTHER = re.compile(r"://|\$\(|\$\{|\.(?:yaml|rviz|urdf|xml|stl|dae|obj|world|sdf|pgm|png|so)\b")
NO_PLACE = ("", 0)
# Of the fleet, not of a line in a file.
PLANNED = frozenset({"MF601", "MF607"})


class RobotNames(NamedTuple):
    """What is a robot's own: ``words`` stand for it; ``right`` are its names as they have to be,
    without a slash in front; ``bare`` maps names of its sources to those they may become."""

    robot: RewrittenRobot
    words: tuple[str, ...]
    right: frozenset[str]
    bare: Mapping[str, frozenset[str]]


class ValueInFile(NamedTuple):
    """A value of a robot's file, whose it is, and the words of the other robots."""

    owned: RobotNames
    others: Mapping[str, str]
    naming: Naming
    value: OutputValue


Draft = tuple[str, str, str, str]
Check = Callable[[ValueInFile], Iterator[Draft]]


def consistency(
    plan: FleetPlan, fleet: Fleet, files: Sequence[OutputText], told: Iterable[Finding] = ()
) -> tuple[Finding, ...]:
    """What is wrong with files that were made for a fleet; ``fleet`` is the plan's with all that is
    started. Nothing is said of a line that ``told`` speaks of already."""
    own = _owned(plan, fleet)
    known = {(it.file, it.line) for it in told}
    found = [
        *_shared(plan, fleet),
        *tf_conflicts(plan, fleet, files),
        *_in_files(plan, own, files),
        *_in_common(own, files),
    ]
    fresh = [it for it in found if it.code in PLANNED or (it.file, it.line) not in known]
    return (*(it for it in fresh if it.code in PLANNED), *_counted(fresh))


def _counted(findings: Iterable[Finding]) -> Iterator[Finding]:
    """What is wrong with the names of a file is told at its first place, with the count."""
    groups: dict[tuple[str, str], dict[int, Finding]] = {}
    for it in sorted(findings, key=lambda it: (it.file, it.line, it.message)):
        if it.code not in PLANNED:
            groups.setdefault((it.code, it.file), {}).setdefault(it.line, it)
    for first, *more in (list(group.values()) for group in groups.values()):
        lines = f"; {len(more)} lines more are like it" if more else ""
        yield first._replace(message=f"{first.message}{lines}")


def _owned(plan: FleetPlan, fleet: Fleet) -> list[RobotNames]:
    graph: dict[str, set[str]] = {robot.spec.namespace: set() for robot in plan.robots}
    for node in fleet.table.nodes:
        graph.setdefault(node.robot, set()).add(f"{node.namespace.rstrip('/')}/{node.name}"[1:])
    for name in fleet.table.names:
        graph.setdefault(name.robot, set()).add(name.name[1:])
    return [_own(robot, graph[robot.spec.namespace]) for robot in plan.robots]


def _own(robot: RewrittenRobot, graph: Iterable[str]) -> RobotNames:
    spec = robot.spec
    names = robot.names._replace(robot=spec.tag)
    kinds = {word: names.declared.get(word, ()) for word in ("link", "joint", "frame", "sensor")}
    bare: dict[str, set[str]] = {}
    for word, declared in (*kinds.items(), ("frame", USUAL_FRAMES)):
        for name in declared:
            bare.setdefault(name, set()).add(spell(names, word, name))
    inventory = robot.member.inventory.declared
    right = {name for kind in inventory.values() for name in kind}
    right |= {name for spelled in bare.values() for name in spelled}
    words = tuple(dict.fromkeys((spec.namespace, spec.tag, spec.model)))
    changed = {name: frozenset(it) for name, it in bare.items() if it != {name}}
    return RobotNames(robot, words, frozenset((*right, *graph)), changed)


def _shared(plan: FleetPlan, fleet: Fleet) -> Iterator[Finding]:
    """Names that two robots have and that are not shared."""
    first: dict[tuple[str, str], RewrittenRobot] = {}
    by_space = {robot.spec.namespace: robot for robot in plan.robots}
    for robot, kind, name in (*_declared(plan), *_nodes(fleet, by_space)):
        other = first.setdefault((kind, name), robot)
        if other is not robot:
            message = f"{kind} {name!r} is of two robots: {other.spec.name!r}, {robot.spec.name!r}"
            hint = "give one of them another name, prefix or postfix"
            spec = robot.spec
            yield Finding("MF601", ERROR, message, hint, spec.file, spec.line, 1)


def _declared(plan: FleetPlan) -> Iterator[tuple[RewrittenRobot, str, str]]:
    """What the descriptions that were written declare, where the layout spells it per robot."""
    naming = plan.fleet.naming
    kinds = [
        it for it in ("link", "joint", "frame", "sensor", "hardware") if it in naming.separators
    ]
    for robot in plan.robots:
        for kind in kinds:
            names = robot.member.inventory.declared.get(kind, ())
            yield from ((robot, kind, it) for it in names if it not in naming.shared_frames)


def _nodes(
    fleet: Fleet, robots: Mapping[str, RewrittenRobot]
) -> Iterator[tuple[RewrittenRobot, str, str]]:
    # Whose topics meet is told of already.
    told = {it.node for it in fleet.table.problems}
    for node in fleet.table.nodes:
        full = f"{node.namespace.rstrip('/')}/{node.name}"
        if node.robot and full not in told:
            yield robots[node.robot], "node", full


def _in_files(
    plan: FleetPlan, own: Sequence[RobotNames], files: Sequence[OutputText]
) -> Iterator[Finding]:
    """Every robot's own files; of those that are alike but for the names only the first."""
    by_name = {it.robot.spec.name: it for it in own}
    words: dict[str, str] = {}
    for it in own:
        words.update(dict.fromkeys(it.words, it.robot.spec.name))
    seen: dict[tuple[object, ...], set[str]] = {}
    for file in files:
        owned = by_name.get(file.path.partition("/")[0])
        if owned is None or "/" not in file.path:
            continue
        masked = _masked(file.text, owned.words)
        like = seen.setdefault((file.sources, file.path.partition("/")[2], _pattern(owned)), set())
        if masked in like:
            continue
        like.add(masked)
        others = {word: robot for word, robot in words.items() if word not in owned.words}
        yield from _in_file(file, owned, others, plan.fleet.naming)


def _masked(text: str, words: Iterable[str]) -> str:
    """The text with holes for its robot: robots with one such text have the same but for their names,
    wherever the words stand."""
    for word in sorted(words, key=len, reverse=True):
        text = text.replace(word, "\0")
    return text


def _pattern(owned: RobotNames) -> tuple[object, ...]:
    """Which of a robot's words are the same: robots that differ in it cannot be compared."""
    spec = owned.robot.spec
    return spec.namespace == spec.tag, spec.namespace == spec.model, spec.tag == spec.model


def _in_file(
    file: OutputText, owned: RobotNames, others: Mapping[str, str], naming: Naming
) -> Iterator[Finding]:
    for value in values_in(file):
        if _OTHER.search(value.text):
            continue
        for check in _CHECKS:
            for code, level, message, hint in check(ValueInFile(owned, others, naming, value)):
                yield _placed(file, owned, value, (code, level, message, hint))


def _placed(file: OutputText, owned: RobotNames, value: OutputValue, said: Draft) -> Finding:
    """At the line of the source, where there is one; else at the robot in the fleet file."""
    code, level, message, hint = said
    spec = owned.robot.spec
    source, line = line_in_source(file, value.line) if file.sources else NO_PLACE
    where = f"{file.path}, line {value.line}: {message}"
    if source:
        return Finding(code, level, where, hint, source, line, 1)
    return Finding(code, level, where, hint, spec.file, spec.line, 1)


def _tokens(look: ValueInFile) -> Iterator[str]:
    """Words of a value that may be names, and that are none of the robot's own."""
    for token in _TOKEN.findall(look.value.text):
        if token.strip("/") not in look.owned.right:
            yield token


def _foreign(look: ValueInFile) -> Iterator[Draft]:
    for token in _tokens(look):
        robot = _whose(token.strip("/"), look)
        if robot:
            message = (
                f"{token} is the robot {robot}'s, and this file is {look.owned.robot.spec.name}'s"
            )
            yield (
                "MF602",
                ERROR,
                message,
                "take the robot out of the name: it is put there for each",
            )


def _whose(token: str, look: ValueInFile) -> str:
    """Another robot whose word a name begins or ends with; empty for none."""
    words = token.split("/")
    ends = ["/".join(words[:at]) for at in range(1, len(words))]
    ends += ["/".join(words[at:]) for at in range(1, len(words))]
    ends += [word for before, word in pairwise(words) if before == "model"]
    for separator in ("_", "/"):
        head, found, name = token.partition(separator)
        ends += [head] if found and name in look.owned.bare else []
        name, found, tail = token.rpartition(separator)
        ends += [tail] if found and name in look.owned.bare else []
    return next((look.others[it] for it in ends if it in look.others), "")


def _doubled(look: ValueInFile) -> Iterator[Draft]:
    for token in _tokens(look):
        word = twice(token, look.owned.words)
        if word and not any(word in it.split("/") for it in look.owned.bare):
            message = f"{token} has {word} in it twice"
            yield "MF603", ERROR, message, "take it out of the source: it is put there once anyway"


def twice(token: str, words: Iterable[str]) -> str:
    """The word of a robot that a name has in it two times running; empty for none."""
    for word in words:
        if f"{word}/{word}" in token or f"{word}_{word}" in token:
            twice_ = re.compile(f"(?<![A-Za-z0-9])({re.escape(word)})[/_]\\1(?![A-Za-z0-9])")
            if twice_.search(token):
                return word
    return ""


def _on_top(look: ValueInFile) -> Iterator[Draft]:
    """What doubles a prefix only when the nodes run."""
    key, text = look.value.key, look.value.text.strip()
    if not look.naming.layout.frames or look.value.is_key:
        return
    if (key in PREFIXES and text not in ("", "~", "null", "/")) or (
        key == ENABLES and text.lower() == "true"
    ):
        message = f"{key}: {text} puts a prefix before frames that have the robot's name already"
        yield "MF603", ERROR, message, 'write ""' if key in PREFIXES else "write false"


def _separators(look: ValueInFile) -> Iterator[Draft]:
    word, bare = look.owned.robot.spec.tag, look.owned.bare
    for token in (it for it in _tokens(look) if not it.startswith("/")):
        for rest in _rests(token, word):
            right = bare.get(rest.strip(_BETWEEN), frozenset())
            if right and not _as_a_frame(look, token, rest.strip(_BETWEEN)):
                hint = "take the robot out of it: it is put there"
                yield "MF604", WARNING, f"{token} should be {' or '.join(sorted(right))}", hint
                break


def _rests(token: str, word: str) -> Iterator[str]:
    if token.startswith(word):
        yield token[len(word) :].lstrip(_BETWEEN)
    if token.endswith(word):
        yield token[: -len(word)].rstrip(_BETWEEN)


def _as_a_frame(look: ValueInFile, token: str, name: str) -> bool:
    """Spelled as a frame is, and no frame that is known: somebody else may send it."""
    declared = look.owned.robot.names.declared
    if name in USUAL_FRAMES or any(name in declared.get(kind, ()) for kind in ("link", "frame")):
        return False
    return (
        spell(look.owned.robot.names._replace(robot=look.owned.robot.spec.tag), "frame", name)
        == token
    )


def _mixed(look: ValueInFile) -> Iterator[Draft]:
    text = look.value.text
    if look.value.is_key or not _FRAME_KEY.search(look.value.key.rpartition(".")[2]):
        return
    if text in look.owned.bare and text not in look.owned.right:
        right = " or ".join(sorted(look.owned.bare[text]))
        message = f"{look.value.key} is {text}, and other frames have the robot's name"
        yield "MF605", WARNING, message, f"if it is a frame of the robot, it is {right}"


def _tf(look: ValueInFile) -> Iterator[Draft]:
    value, naming = look.value, look.naming
    if value.is_key or value.key.startswith("gz_"):
        return
    namespace = look.owned.robot.spec.namespace
    own = {f"/{namespace}{it}" for it in TF} | {f"{it}/{namespace}" for it in TF}
    if naming.layout.tf_per_robot and value.text in TF:
        message = f"{value.text} is one for all, and each robot has its own here"
        yield (
            "MF606",
            WARNING,
            message,
            f"write {value.text[1:]}, or choose layout frames-per-robot",
        )
    if not naming.layout.tf_per_robot and value.text in own:
        message = f"{value.text} is for one robot, and all are on one /tf here"
        yield "MF606", WARNING, message, "write /tf, or choose layout both"


def _in_common(own: Sequence[RobotNames], files: Sequence[OutputText]) -> Iterator[Finding]:
    """Files of all robots together: names with a robot in them twice."""
    words = {word: it for it in own for word in it.words}
    either = re.compile(
        r"(?<![A-Za-z0-9])([A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*?)[/_]\1(?![A-Za-z0-9])"
    )
    for file in files:
        if "/" in file.path or not file.sources:
            continue
        # Most lines are the same for every robot.
        lines = "\n".join(dict.fromkeys(file.text.splitlines()))
        for token in dict.fromkeys(_TOKEN.findall(lines)):
            found = either.search(token)
            owned = words.get(found[1]) if found else None
            if found and owned and not any(found[1] in it.split("/") for it in owned.bare):
                line = file.text.count("\n", 0, file.text.index(token)) + 1
                said = (
                    "MF603",
                    ERROR,
                    f"{token} has {found[1]} in it twice",
                    "take it out of the source",
                )
                yield _placed(file, owned, OutputValue(token, "", False, line), said)


_CHECKS: tuple[Check, ...] = (_foreign, _doubled, _on_top, _separators, _mixed, _tf)
