# SPDX-License-Identifier: Apache-2.0
"""Fills a xacro's arguments: the switch between simulated and real, and those for names.

Authors call the switch ``sim_mode``, ``use_sim``, ``use_gazebo``, ``sim_ignition``,
``real_robot``: it chooses the hardware class of ``<ros2_control>``, and often the simulator's
plugins. Arguments for names are filled if the names become what the layout makes of them; the
rewrite leaves these."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cache
from itertools import islice
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import NOTE, Finding, declare
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import NAMESPACE, POSTFIX, ROS_KINDS, SEPARATORS, Naming
from multibot_rewrite.base.releases import ROS_2
from multibot_rewrite.description.reports.xacro_arguments import (
    WHOLE,
    Argument,
    Use,
    find_arguments,
    names_robots,
)
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.expand import expand, expand_traced
from multibot_rewrite.description.sources.own_names import ROBOT, filled, name_robot
from multibot_rewrite.description.sources.read import is_xacro, read_file
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.fleet.file.fleet_file import FleetFile
from multibot_rewrite.fleet.file.robot_spec import RobotSpec
from multibot_rewrite.knowledge.worlds import SIMULATORS

_NAME = lazy_compile(r"sim|gazebo|ignition|(?:^|_)(?:gz|ign|real|hardware|hw|fake|mock)(?:_|$)")
_OTHER = {"true": "false", "True": "False", "1": "0"}
_OTHERS = {**_OTHER, **{off: on for on, off in _OTHER.items()}}
# What classes of simulators and those of vendors for them are called like.
_SIMULATED = lazy_compile(r"gazebo|gz|ign|sim|mujoco|isaac")
# A hardware class, such as an argument has for its value, and those of simulators.
_CLASS = lazy_compile(r"\w+(?:/|::)\w*(?:System|Hardware|Interface)\w*")
_CLASSES = tuple(it for simulator in SIMULATORS for it in simulator.hardware)
# Arguments that are tried.
MOST = 8
# Does a description, expanded with some arguments, suit?
Suits = Callable[[_Element], bool]


def is_called_as_switch(argument: str) -> bool:
    """Return whether an argument is named as a switch between the simulated and the real robot."""
    return _NAME.search(argument.lower()) is not None


def other_values(value: str) -> list[str]:
    """Return the opposite of a value that is true or false."""
    return [_OTHERS[value]] if value in _OTHERS else []


def hardware_classes(root: _Element) -> list[str]:
    """Return the hardware classes of a description's ``<ros2_control>``."""
    found = (it.text or "" for it in root.iterfind(".//ros2_control/hardware/plugin"))
    return [it.strip() for it in found if it.strip()]


def of_simulator(hardware: str) -> bool:
    """Return whether a hardware class is surely one of a simulator."""
    return any(hardware in it.hardware for it in SIMULATORS)


def may_be_simulated(hardware: str) -> bool:
    """Return whether a hardware class is a simulator's, or named as a vendor's own one is."""
    return _SIMULATED.search(hardware.lower()) is not None


def loads_hardware(root: _Element) -> bool:
    """Return whether a description has a simulator's plugin that makes a controller manager."""
    blocks = [root] if root.tag == "sdf" else root.findall("gazebo")
    files = (it.get("filename") or "" for block in blocks for it in block.iter("plugin"))
    return any("ros2_control" in it for it in files)


def suits_simulator(root: _Element) -> bool:
    """Return whether a simulator can load all hardware of a description; also true without hardware."""
    if _lacks_a_class(root):
        return False
    return not loads_hardware(root) or all(map(may_be_simulated, hardware_classes(root)))


def suits_real(root: _Element) -> bool:
    """Return whether none of a description's hardware is a simulator's."""
    return not (_lacks_a_class(root) or any(map(of_simulator, hardware_classes(root))))


def _lacks_a_class(root: _Element) -> bool:
    """Return whether some hardware has no class, which another argument may give it."""
    return any(it.find("plugin") is None for it in root.iterfind(".//ros2_control/hardware"))


def switch_for(
    path: str, given: Mapping[str, str], suits: Suits, reach: Reach
) -> tuple[str, str] | None:
    """Return (argument, value) with which a description ``suits``; None if not needed, or none."""
    if not path.endswith(".xacro"):
        return None
    with suppress(InputError):
        read = expand_traced(path, read_file(path), given, None, reach)
        if suits(read_document(read.data, path).root):
            return None
        for name, value in _switches(read.sources, given):
            with suppress(InputError):
                data = expand(path, {**given, name: value}, reach=reach)
                if suits(read_document(data, path).root):
                    return name, value
    return None


def _switches(sources: Mapping[str, bytes], given: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Yield (argument, other value) that may switch between simulated and real."""
    # That is one with such a name and a value of true or false, one that is compared with other
    # words (``mode == 'gazebo'``), or one for a hardware class.
    declared: dict[str, str] = {}
    for file, data in sources.items():
        for it in read_document(data, file).root.iter("{*}arg"):
            declared.setdefault(it.get("name", ""), it.get("default", ""))
    every = {**declared, **given}
    named = [it for it in every if is_called_as_switch(it) and every[it] in _OTHERS]
    yield from ((it, _OTHERS[every[it]]) for it in named[:MOST])
    text = b"\n".join(sources.values()).decode("utf-8", "replace")
    # Those of a package whose plugin is there come first.
    classes = sorted(_CLASSES, key=lambda it: it.partition("/")[0] not in text)
    words = (
        (name, word)
        for name, value in every.items()
        if value and value not in _OTHERS
        for word in (*_compared(name, text), *(classes if _CLASS.fullmatch(value) else ()))
        if word != value
    )
    yield from islice(words, MOST)


def _compared(name: str, text: str) -> list[str]:
    """Return the values that an argument is compared with, those of simulators first."""
    found = re.findall(rf"""\b{re.escape(name)}\)?["']?\s*==\s*["']([\w-]+)["']""", text)
    return sorted(dict.fromkeys(found), key=lambda it: _SIMULATED.search(it.lower()) is None)


# Kinds that other files and nodes know by the name that the layout makes.
_KNOWN = ("link", "joint", "frame")
OWN_ARGUMENT = declare("MF840", "own-argument", NOTE, formats=("fleet",))


class _Choice(NamedTuple):
    """The value of an argument, or why it has none although it could."""

    name: str
    value: str = ""
    reason: str = ""


def with_own_arguments(
    file: FleetFile, naming: Naming, trust: bool
) -> tuple[FleetFile, Mapping[str, Sequence[Finding]]]:
    """Return the fleet with values for arguments that name robots, and findings by robot."""
    # A file that cannot be expanded is left to whoever reads it.

    @cache
    def found(path: str, given: frozenset[tuple[str, str]]) -> tuple[Argument, ...]:
        """Return a xacro's arguments named as those for robots; none if it cannot be read."""
        tree, reach = builtin_tree(file.definitions, file.distro, ROS_2), Reach(trust=trust)
        with suppress(InputError):
            return find_arguments(
                path, dict(given), tree, reach=reach, wanted=names_robots
            ).arguments
        return ()

    robots: list[RobotSpec] = []
    notes: dict[str, list[Finding]] = {}
    # What the first robot with these values finds holds for all: a name is as good as another.
    first: dict[tuple[tuple[str, str], ...], frozenset[tuple[str, str]]] = {}
    for it in file.robots:
        own = frozenset(filled(it.arguments, it.name).items())
        own = first.setdefault(tuple(it.arguments.items()), own)
        paths = [path for path in (it.description, it.simulated) if it.fills and path]
        every = (one for path in paths if is_xacro(path) for one in found(path, own))
        free = [one for one in every if one.name not in it.arguments]
        choices = [_choice(one, naming, it) for one in free]
        told = ((name, text) for name, text in it.arguments.items() if ROBOT not in text)
        if named := next((name for name, text in told if name_robot({name: text}, it.words)), ""):
            # A given value is the robot's name: a name would have it twice.
            reason = f"{named} names the robot already"
            choices = [_Choice(one.name, reason=reason) if one.value else one for one in choices]
        values = {one.name: one.value for one in choices if one.value}
        robots.append(it._replace(arguments={**it.arguments, **values}))
        notes[it.name] = said = []
        for one in (one for one in choices if one.value or one.reason):
            what = f"is filled, it is {one.value.replace(ROBOT, it.name)}"
            hint = "give another value under arguments, or '' for none"
            if one.reason:
                what = f"is not filled: {one.reason}"
                hint = "give its value under arguments, or set separators"
            message = f"robot {it.name!r}: the argument {one.name} of its xacro {what}"
            said.append(OWN_ARGUMENT.finding(message, hint, file=it.file, line=it.line))
    return file._replace(robots=tuple(robots)), notes


def _choice(it: Argument, naming: Naming, robot: RobotSpec) -> _Choice:
    """Return the robot's name as the value of an argument; no value if it does not fit all its uses."""
    uses = [use for use in it.uses if use.kind in ROS_KINDS or use.how != WHOLE]
    if not (it.word and (it.is_empty or it.is_space) and uses) or any(
        _makes_other_names(use, naming) for use in uses
    ):
        return _Choice(it.name)
    if it.missed:
        return _Choice(
            it.name, reason=f"{it.missed} would be renamed, and something still uses the old name"
        )
    words = {robot.namespace if use.kind in ROS_KINDS else robot.tag for use in uses}
    if len(words) > 1 or "/" in min(words):
        return _Choice(it.name, reason="its namespace is not what its frames get")
    bare = any(use.separator or use.how == WHOLE for use in uses)
    known = {
        naming.separators[use.kind] for use in uses if use.kind in _KNOWN and not use.separator
    }
    between = known or {
        SEPARATORS[use.kind] for use in uses if use.how != WHOLE and not use.separator
    }
    if len(between) + bare > 1:
        both = " and ".join(f"{use.example} of a {use.kind}" for use in uses[:2])
        return _Choice(it.name, reason=f"it makes {both}, and these get different separators")
    word, separator = min(words), "".join(between)
    word = ROBOT if word == robot.name else word
    behind = any(use.how == POSTFIX for use in uses)
    return _Choice(it.name, f"{separator}{word}" if behind else f"{word}{separator}")


def _makes_other_names(use: Use, naming: Naming) -> bool:
    """Return whether names with the argument differ from the layout's."""
    if use.kind in ROS_KINDS:
        return naming.topics != NAMESPACE or use.how == POSTFIX
    if use.kind not in _KNOWN:
        return False
    separator = naming.separators.get(use.kind)
    return use.how != naming.affix or use.separator not in ("", separator) or separator is None
