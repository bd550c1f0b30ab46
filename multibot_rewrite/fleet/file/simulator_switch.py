# SPDX-License-Identifier: Apache-2.0
"""The argument of a xacro that switches between the simulated and the real robot.

Authors call it ``sim_mode``, ``use_sim``, ``use_gazebo``, ``sim_ignition``, ``real_robot``: it chooses
the hardware class of ``<ros2_control>``, and often the plugins of the simulator.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from itertools import islice

from lxml.etree import _Element

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.expand import expand, expand_traced
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.rules.facts.simulators import SIMULATORS

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
    """Return whether it is a simulator's class, or is named as a vendor's own one is."""
    return _SIMULATED.search(hardware.lower()) is not None


def loads_hardware(root: _Element) -> bool:
    """Return whether it has a plugin of a simulator that makes a controller manager."""
    blocks = [root] if root.tag == "sdf" else root.findall("gazebo")
    files = (it.get("filename") or "" for block in blocks for it in block.iter("plugin"))
    return any("ros2_control" in it for it in files)


def suits_simulator(root: _Element) -> bool:
    """Return whether a simulator's controller manager can load its hardware."""
    if _lacks_a_class(root):
        return False
    return not loads_hardware(root) or all(map(may_be_simulated, hardware_classes(root)))


def suits_real(root: _Element) -> bool:
    """Return whether none of its hardware is a simulator's."""
    return not (_lacks_a_class(root) or any(map(of_simulator, hardware_classes(root))))


def _lacks_a_class(root: _Element) -> bool:
    """Return whether another argument names the class of some hardware."""
    return any(it.find("plugin") is None for it in root.iterfind(".//ros2_control/hardware"))


def switch_for(
    path: str, given: Mapping[str, str], suits: Suits, reach: Reach
) -> tuple[str, str] | None:
    """Return the one argument and its other value with which the description suits; None if it
    already does, or no value does."""
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
    """Yield arguments with a value that may switch the simulator: one that is named so and is true
    or false, one that is compared with other words (``mode == 'gazebo'``), a hardware class."""
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
    """Return the words that an argument is compared with, those of simulators first."""
    found = re.findall(rf"""\b{re.escape(name)}\)?["']?\s*==\s*["']([\w-]+)["']""", text)
    return sorted(dict.fromkeys(found), key=lambda it: _SIMULATED.search(it.lower()) is None)
