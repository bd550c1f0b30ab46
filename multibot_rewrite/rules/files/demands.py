# SPDX-License-Identifier: Apache-2.0
"""What nodes demand of a parameter by others: an order, a condition, another text; and its class.

``knowledge/demanded.schema`` has the demands, ``knowledge/plugin_classes.schema`` the classes.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.kinds import PARAMS
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.params.rcl_parameters import Value
from multibot_rewrite.knowledge.declared import DEMANDED, stands_for
from multibot_rewrite.rules.files.declared import Given, Section, sections
from multibot_rewrite.rules.files.examples import a_section
from multibot_rewrite.rules.files.parameter_facts import of_release
from multibot_rewrite.rules.files.records import Remark, remark_at

_OWN = re.compile(r"nav2_\w+_bt_node")


class Demand(NamedTuple):
    """One check of a given parameter with the words of its arguments; ``source`` says where it is."""

    section: Section
    given: Given
    check: str
    words: tuple[str, ...]
    source: str


def demands(file: NamedFile, *checks: str) -> Iterator[Demand]:
    """The demands of these kinds on the parameters of a file."""
    for section in sections(file):
        for it, known in section.known:
            facts = [fact for fact in known if fact.how == DEMANDED] if it.value is not None else []
            exact = [fact for fact in facts if fact.path == it.name]
            for fact in of_release(exact or facts, file.context.distro):
                put = stands_for(fact.path, it.name)
                for check, text in fact.checks if put or fact.path == it.name else ():
                    if check in checks:
                        words = tuple(put.get(word, word) for word in text.split())
                        yield Demand(section, it, check, words, fact.source)


def above_others(file: NamedFile) -> Iterator[Remark]:
    """Values above another parameter that is the upper end of the same range."""
    for it in demands(file, "at_most"):
        value, other = it.given.value, value_of(it.section, it.words[0])
        # A negative one stands for no limit, or for that of the sensor.
        if _is_size(value) and _is_size(other) and float(str(value)) > float(str(other)):
            message = (
                f"{it.section.title}: {it.given.name} is {value}, above {it.words[0]} ({other})"
            )
            yield remark_at(it.given.node, message, f"swap the two, or correct one; {it.source}")


def _is_size(value: Value | None) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and value >= 0


def value_of(section: Section, name: str) -> Value | None:
    """The value of another parameter of the same node or plugin."""
    found = section.whole.get(section.at + name)
    return found.value if found else None


@rule(
    "MB894",
    "parameters-contradict",
    WARNING,
    what="A parameter has no effect, or fails, with the value of another one of its node: an initial "
    "pose without set_initial_pose, the config of an input that is not there, frames of an EKF that "
    "have to differ, a world_frame that is neither map_frame nor odom_frame.",
    why="The node says little or nothing: amcl waits for a pose, an EKF fuses nothing or sends no "
    "transform.",
    fix="Set the other parameter as the message says, or leave this one out. The hint has the place in "
    "the node's source.",
    bad=a_section("ekf_filter_node", "world_frame: world"),
    good=a_section("ekf_filter_node", "world_frame: odom"),
    line=3,
    formats=(PARAMS,),
)
def contradictions(file: NamedFile) -> Iterator[Remark]:
    """Every demand of one parameter on another that is no order."""
    for it in demands(file, *_PAIRS):
        said = _PAIRS[it.check](it)
        if said:
            message = f"{it.section.title}: {it.given.name} {said}"
            # What is 0 is mostly the default that was written down.
            level = "" if it.given.value != 0 or it.check != "with" else NOTE
            yield remark_at(it.given.node, message, f"see {it.source}", level)


def _with(it: Demand) -> str:
    other, *wanted = it.words
    value = value_of(it.section, other)
    if not wanted:
        there = other in {name.removeprefix(it.section.at) for name in it.section.whole}
        return "" if there else f"has no effect without {other}"
    # What is 0 is the default all the same; where nothing is said a launch file may say it.
    if value is None or _text(value) == wanted[0]:
        return ""
    return f"has no effect with {other}: {_text(value)}"


def _without(it: Demand) -> str:
    other, unwanted = it.words
    value = value_of(it.section, other)
    both = it.given.value is True and value is not None and _text(value) == unwanted
    return f"cannot be true with {other}: {unwanted}" if both else ""


def _unlike(it: Demand) -> str:
    other, default = it.words
    value = value_of(it.section, other)
    same = it.given.value == (default if value is None else value)
    return f"is {it.given.value!r}, as {other} is; they have to differ" if same else ""


def _among(it: Demand) -> str:
    names, defaults = it.words[::2], it.words[1::2]
    pairs = zip(names, defaults, strict=True)
    found = {name: value_of(it.section, name) or default for name, default in pairs}
    if it.given.value in found.values():
        return ""
    known = " nor ".join(f"{name} ({value})" for name, value in found.items())
    return f"is {it.given.value!r}, neither {known}"


def _foreign(it: Demand) -> str:
    """The libraries of Nav2's own nodes are loaded anyway, and a second registration throws."""
    value = it.given.value
    own = (
        [str(word) for word in value if _OWN.fullmatch(str(word))]
        if isinstance(value, list)
        else []
    )
    return f"lists {own[0]}, which is loaded without it, so it is registered twice" if own else ""


def _text(value: Value) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


_PAIRS: dict[str, Callable[[Demand], str]] = {
    "with": _with,
    "without": _without,
    "unlike": _unlike,
    "among": _among,
    "foreign": _foreign,
}
