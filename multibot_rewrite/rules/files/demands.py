# SPDX-License-Identifier: Apache-2.0
"""What nodes demand of a parameter by others: an order, a condition, another text; and its class.

``knowledge/demanded.schema`` has the demands, ``knowledge/plugin_classes.schema`` the classes.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.nearest import differ_in_numbers, slip_of
from multibot_rewrite.knowledge.conditions import holds, word_of
from multibot_rewrite.knowledge.declared import DEMANDED
from multibot_rewrite.knowledge.node_sets import load_nodes
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.related_files.named_file import MOVEIT, PARAMS, NamedFile
from multibot_rewrite.rules.declaration import remark_at
from multibot_rewrite.rules.files.parameter_files import is_number, of_release
from multibot_rewrite.rules.files.section_facts import Section, Setting, filled, sections
from multibot_rewrite.system.parameters import Value

# What keeps a node from coming up in each release.
_STOPS = ("instead", "period", "as_many")
_OWN = lazy_compile(r"nav2_\w+_bt_node")


class Demand(NamedTuple):
    """One check of a given parameter with its arguments; ``source`` says where it is.

    ``releases`` are those that have it, if not all do."""

    section: Section
    given: Setting
    check: str
    words: tuple[str, ...]
    source: str
    releases: str = ""


def demands(file: NamedFile, *checks: str) -> Iterator[Demand]:
    """Yield the demands of these kinds on the parameters of a file."""
    if Demand not in file.memo:
        file.memo[Demand] = tuple(_demands(file))
    return (it for it in file.memo[Demand] if it.check in checks)


def _demands(file: NamedFile) -> Iterator[Demand]:
    for section in sections(file):
        for it, known in section.known:
            every = [fact for fact in known if fact.how == DEMANDED]
            facts = of_release(every, file.context.distro) if it.value is not None else []
            for fact in [one for one in facts if one.path == it.name] or facts:
                for check, text in fact.checks:
                    words = filled(text, fact.path, it.name)
                    yield Demand(section, it, check, words, fact.source, fact.releases)


def above_others(file: NamedFile) -> Iterator[Finding]:
    """Report values above another parameter that is the upper end of the same range."""
    for it in demands(file, "at_most", "not_above"):
        value, other = it.given.value, value_of(it.section, it.words[0])
        # A negative one stands for no limit, or for that of the sensor.
        sizes = it.check == "not_above" or (_is_size(value) and _is_size(other))
        if sizes and is_number(value) and is_number(other) and float(value) > float(other):
            above = f"above {it.words[0]} ({other})"
            message = f"{it.section.title}: {it.given.name} is {value}, {above}"
            yield remark_at(it.given.node, message, f"swap the two, or correct one; {it.source}")


def _is_size(value: Value | None) -> bool:
    return is_number(value) and value >= 0


def value_of(section: Section, name: str) -> Value | None:
    """Return the value of another parameter of the same node or plugin."""
    found = section.whole.get(section.at + name)
    return found.value if found else None


@rule("MB894", "parameters-contradict", WARNING, formats=(PARAMS, MOVEIT))
def contradictions(file: NamedFile) -> Iterator[Finding]:
    """Report every condition between two parameters that is no order."""
    for it in demands(file, *_PAIRS):
        if said := _PAIRS[it.check](it):
            message = f"{it.section.title}: {it.given.name} {said}"
            # What is 0 is mostly the default that was written down.
            level = "" if it.given.value != 0 or it.check != "with" else NOTE
            known = it.check != "period" or it.words[0] in it.section.whole
            level = ERROR if (it.check in _STOPS and not it.releases and known) else level
            yield remark_at(it.given.node, message, f"see {it.source}", level)
    for section in sections(file):
        node = load_nodes(file.context.distro).get(section.node.name) if section.node else None
        yield from _to_itself(section, node) if node else ()
    for it in demands(file, "managed"):
        # Names in a list that are no node of the file, but nearly one that the list lacks.
        nodes = {section.title for section in sections(file)}
        listed = _items(it)
        for word in (it for it in map(str, listed) if it not in nodes):
            left = [name for name in nodes - {*listed} if not differ_in_numbers(word, name)]
            if meant := slip_of(word, sorted(left)):
                message = f"{it.section.title}: {it.given.name} has {word!r}, and lacks {meant!r}"
                yield remark_at(
                    it.given.node, message, f"list such a node: it waits; see {it.source}"
                )


def _to_itself(section: Section, node: NodeFacts) -> Iterator[Finding]:
    """Yield transforms that a node sends from a frame to itself: tf2's buffer_core.cpp refuses them."""
    defaults: dict[str, Value | None] = {it.parameter: it.default for it in node.frames}
    values = {**defaults, **{name: it.value for name, it in section.whole.items()}}
    for parent, child, condition, _ in node.sends:
        given = section.whole.get(child) or section.whole.get(parent)
        frame = values.get(parent)
        if given and frame and frame == values.get(child) and holds(condition, values.get):
            message = f"{section.title}: {parent} and {child} are both {frame!r}"
            usual = f"by default they are {defaults[parent]} and {defaults[child]}"
            hint = f"tf2 refuses a transform from a frame to itself; {usual}"
            yield remark_at(given.node, message, hint)


def _with(it: Demand) -> str:
    """Return why a parameter has no effect without another one; empty if it has."""
    other, *wanted = it.words
    if it.given.value in ("", []):
        return ""
    value = value_of(it.section, other)
    if not wanted:
        there = other in {name.removeprefix(it.section.at) for name in it.section.whole}
        return "" if there else f"has no effect without {other}"
    # What is 0 is the default all the same; where nothing is said a launch file may say it.
    if value is None or word_of(value) == wanted[0]:
        return ""
    return f"has no effect with {other}: {word_of(value)}"


def _without(it: Demand) -> str:
    """Return why a parameter cannot be true with another one's value; empty if it can."""
    other, unwanted = it.words
    value = value_of(it.section, other)
    both = it.given.value is True and value is not None and word_of(value) == unwanted
    return f"cannot be true with {other}: {unwanted}" if both else ""


def _unlike(it: Demand) -> str:
    """Return the fault of a value that another parameter has as well; empty if they differ."""
    other, default = it.words
    value = value_of(it.section, other)
    same = it.given.value == (default if value is None else value)
    return f"is {it.given.value!r}, as {other} is; they have to differ" if same else ""


def _among(it: Demand) -> str:
    """Return the fault of a value that none of some parameters has; empty if one has it."""
    names, defaults = it.words[::2], it.words[1::2]
    pairs = zip(names, defaults, strict=True)
    found = {name: value_of(it.section, name) or default for name, default in pairs}
    if it.given.value in found.values():
        return ""
    known = " nor ".join(f"{name} ({value})" for name, value in found.items())
    return f"is {it.given.value!r}, neither {known}"


def _foreign(it: Demand) -> str:
    """Return the fault of a list with a library that Nav2's nodes register anyway; empty if none."""
    own = [str(word) for word in _items(it) if _OWN.fullmatch(str(word))]
    return f"lists {own[0]}, which is loaded without it, so it is registered twice" if own else ""


def _as_many(it: Demand) -> str:
    """Return the fault of a list that has not as many items as another one; empty if it has."""
    other = value_of(it.section, it.words[0])
    here, there = len(_items(it)), len(other) if isinstance(other, list) else 0
    return (
        f"has {here}, and {it.words[0]} {there}: they go in pairs"
        if there != here and there
        else ""
    )


def _instead(it: Demand) -> str:
    """Return the fault of a parameter that is not read any more; empty if its value does no harm."""
    there = it.words[0] in it.section.whole or it.given.value in it.words[1:]
    return "" if there else f"is not read; the node reads {it.words[0]}"


def _is_one(it: Demand) -> str:
    """Return the fault of a name that is none of the known ones; empty if it is one."""
    word, *known = it.words
    return "" if word in known else f"is for {word!r}; there are {', '.join(known)}"


def _together(it: Demand) -> str:
    """Return the fault of a list with one word and without the other; empty if it has both."""
    word, other = it.words
    alone = word in _items(it) and other not in _items(it)
    return f"has {word!r} without {other!r}" if alone else ""


def _or_true(it: Demand) -> str:
    """Return the fault of parameters that are all false; empty if one is true."""
    none = it.given.value is False and all(value_of(it.section, at) is not True for at in it.words)
    return f"is false, and so are {' and '.join(it.words)}: nothing is sent" if none else ""


def _alone(it: Demand) -> str:
    """Return why a parameter cannot be true with another one; empty if that is not set."""
    there = it.section.at + it.words[0] in it.section.whole
    return f"cannot be true with {it.words[0]}" if there and it.given.value is True else ""


def _period(it: Demand) -> str:
    """Return the fault of a plugin's period below that of its node; empty if it is long enough."""
    other, default = it.words
    given = it.section.whole.get(other)
    rate = given.value if given else float(default)
    short = is_number(rate) and is_number(it.given.value) and rate * it.given.value < 1 - _ROUNDED
    return f"is {it.given.value}, below the period of {other} ({rate})" if short else ""


def _once(it: Demand) -> str:
    """Return the fault of a value that an earlier parameter of its kind has; empty if none has."""
    kind, _, rest = (it.section.at + it.given.name).partition(".")
    for name, other in it.section.whole.items():
        if name == f"{kind}.{rest}":
            return ""
        same = name.startswith(f"{kind}.") and name.rpartition(".")[2] == rest.rpartition(".")[2]
        if same and other.value == it.given.value:
            return f"is {it.given.value!r}, as {name} is"
    return ""


def _renamed(it: Demand) -> str:
    """Return the fault of a list with the old name of something; empty without it."""
    old, new = it.words
    return f"lists {old}, which is called {new} since Humble" if old in _items(it) else ""


def _bonded(it: Demand) -> str:
    """Return the fault of a listed name with a slash: a bond has the node's name alone (nav2_util)."""
    words = [str(word) for word in _items(it) if "/" in str(word)]
    bond = value_of(it.section, it.words[0])
    kept = bond is None or (is_number(bond) and bond > 0)
    return f"lists {words[0]}, and waits for a bond of that name" if words and kept else ""


def _listed(it: Demand) -> str:
    """Return the fault of a value that is missing in the list of another parameter; empty if none."""
    other = it.section.whole.get(it.words[0])
    known = other.value if other else None
    value = it.given.value
    if not isinstance(known, list) or not value:
        return ""
    strange = [
        word for word in (value if isinstance(value, list) else [value]) if word not in known
    ]
    return f"has {strange[0]!r}, which {it.words[0]} has not" if strange else ""


def _items(it: Demand) -> list[Any]:
    """Return the items of a list; empty for another value."""
    return it.given.value if isinstance(it.given.value, list) else []


_OF_OTHERS = _with, _without, _unlike, _among, _as_many, _instead, _together, _or_true, _alone
_OF_WORDS = _period, _foreign, _is_one, _once, _renamed, _bonded, _listed
_PAIRS = {it.__name__[1:]: it for it in (*_OF_OTHERS, *_OF_WORDS)}
_ROUNDED = 1e-4
