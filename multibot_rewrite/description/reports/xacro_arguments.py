# SPDX-License-Identifier: Apache-2.0
"""Finds which xacro argument goes into which names, by expanding with other values."""

import re
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from itertools import chain
from typing import NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.sources.access import BOUNDED, Reach
from multibot_rewrite.description.sources.expand import Expansion, expand, expand_traced
from multibot_rewrite.description.sources.own_names import MARKS, ROBOT
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.collect import Inventory, collect
from multibot_rewrite.description.steps.document import read_document, slot_values

# More arguments, or longer, and the rest is not tried.
MOST, SECONDS = 100, 60.0
PREFIX, POSTFIX, WHOLE, INSIDE = "prefix", "postfix", "whole", "inside"
# Values of an argument that names nobody yet; Husarion's ROSbot has the second one.
_NOTHING = ("", "None")
# What arguments for a robot's own names are called.
_NAMING = lazy_compile(r"prefix|namespace|^ns$|(robot|vehicle|arm|model)_?(name|id|ns)$")
# What an argument is called whose value is the namespace of the robot, whatever it is by default.
_SPACE = lazy_compile(r"(robot_?)?(namespace|ns)", re.IGNORECASE)
_MARK = MARKS[0]
PARTS = ("link", "joint")
_SEPARATORS = "/_-."


class Use(NamedTuple):
    """How an argument is in names of one kind: ``how`` is prefix, postfix, whole or inside.

    ``separator`` is what the file itself puts between the argument and the rest; ``names`` of the
    ``total`` names of the kind have the argument, ``example`` is one, with ``{robot}`` in its place.
    """

    kind: str
    how: str
    separator: str
    names: int
    total: int
    example: str


class Argument(NamedTuple):
    """An argument, its value where none is given, and its uses in names.

    ``others`` are values with it that are no known name. ``fault`` is why a word is not taken: the
    argument is a number, a switch, a file or one of some words. ``missed`` is a link or joint that is
    named as before though the argument gives it another name; empty if it misses none.
    """

    name: str
    default: str
    uses: tuple[Use, ...]
    others: int
    fault: str
    missed: str = ""

    @property
    def value(self) -> str:
        """The value for robots; empty if it is not for names or misses a link. Raises nothing."""
        return "" if self.missed else self.word

    @property
    def word(self) -> str:
        """The value for robots, as ``{robot}_``; empty if it is not for names. Raises nothing.

        It is for names if it is their beginning, their end or a namespace. Besides, it is empty by
        default, or in every link and joint (lbr of lbr_link_0), or the namespace of all plugins.
        """
        ends = {use.how: use.separator for use in self.uses if use.how in (PREFIX, POSTFIX)}
        spaces = any((use.kind, use.how) == ("namespace", WHOLE) for use in self.uses)
        if not (self.is_empty or self.is_everywhere or self.is_space) or not (ends or spaces):
            return ""
        before = "_" if ends.get(POSTFIX) == "" else ""
        after = "_" if ends.get(PREFIX) == "" else ""
        return f"{before}{ROBOT}{after}"

    @property
    def is_empty(self) -> bool:
        """Return whether the argument names no robot by default. Raises nothing."""
        return self.default.strip(_SEPARATORS) in _NOTHING

    @property
    def is_everywhere(self) -> bool:
        """Return whether the argument is in every link and joint. Raises nothing."""
        parts = [use for use in self.uses if use.kind in PARTS]
        return bool(parts) and all(use.names == use.total for use in parts)

    @property
    def is_space(self) -> bool:
        """Return whether the argument is every plugin's namespace, and in no other name."""
        called = bool(self.uses) and _SPACE.fullmatch(self.name) is not None
        return called and all(
            (use.kind, use.how, use.names) == ("namespace", WHOLE, use.total) for use in self.uses
        )


class XacroArguments(NamedTuple):
    """A file's arguments as declared, those ``untried`` (too many, not wanted), and files read."""

    file: str
    arguments: tuple[Argument, ...]
    untried: tuple[str, ...]
    read: tuple[str, ...] = ()

    @property
    def for_robots(self) -> Mapping[str, str]:
        """A value for every argument that names robots and has a name that says so."""
        named = (it for it in self.arguments if it.value and names_robots(it.name))
        return {it.name: it.value for it in named}

    @property
    def words(self) -> tuple[str, ...]:
        """``NAME:=VALUE`` for each argument of ``for_robots``."""
        return tuple(f"{name}:={value}" for name, value in self.for_robots.items())


def names_robots(name: str) -> bool:
    """Return whether vendors use an argument of this name for a robot's own names."""
    return _NAMING.search(name) is not None


def find_arguments(
    path: str,
    given: Mapping[str, str],
    tree: Tree,
    clock: Callable[[], float] = time.monotonic,
    reach: Reach = BOUNDED,
    wanted: Callable[[str], bool] = bool,
    read: Expansion | None = None,
) -> XacroArguments:
    """Return the arguments of a xacro file whose name is ``wanted``; ``given`` are some values."""
    # ``read`` is its expansion if that is known. Raises InputError if it does not expand.
    end = clock() + SECONDS
    read = read or expand_traced(path, read_file(path), given, None, reach)
    declared = {**declared_in(read.sources), **given}
    plain = _links_and_joints(collect(read_document(read.data, path), tree))
    found: dict[str, Argument] = {}
    for name, default in [it for it in declared.items() if wanted(it[0])][:MOST]:
        if clock() > end:
            break
        try:
            data = expand(path, {**given, name: _MARK}, reach=reach)
            inventory = collect(read_document(data, path), tree)
        except InputError as error:
            # What xacro said, without place and advice.
            said = str(error).rpartition("xacro failed")[2].partition(": ")[2].partition("; ")[0]
            found[name] = Argument(name, default, (), 0, said or str(error))
            continue
        values = [it for it in slot_values(inventory.document.root) if _MARK in it]
        claimed = sum(_MARK in claim.value for claim in inventory.claims)
        renamed = plain - _links_and_joints(inventory)
        names = chain.from_iterable(inventory.names)
        missed = next((it.text for it in names if it.text in renamed), "")
        others, uses = max(len(values) - claimed, 0), tuple(_uses_of_mark(inventory))
        found[name] = Argument(name, default, uses, others, "", missed)
    untried = tuple(it for it in declared if it not in found)
    return XacroArguments(path, tuple(found.values()), untried, read.read)


def declared_arguments(path: str, given: Mapping[str, str], reach: Reach) -> Mapping[str, str]:
    """Return the arguments that a xacro declares with their defaults; none if it does not expand."""
    with suppress(InputError):
        return declared_in(expand_traced(path, read_file(path), given, None, reach).sources)
    return {}


def declared_in(sources: Mapping[str, bytes]) -> dict[str, str]:
    """Return the ``<xacro:arg>`` of all files with their defaults; the first one counts."""
    found: dict[str, str] = {}
    # YAML that an expression loads may be among them.
    for file, data in ((file, data) for file, data in sources.items() if b"<" in data):
        for element in read_document(data, file).root.iter("{*}arg"):
            if element.prefix == "xacro":
                found.setdefault(element.get("name", ""), element.get("default", ""))
    return found


def _links_and_joints(inventory: Inventory) -> frozenset[str]:
    """Return the declared links and joints."""
    return frozenset(it for kind in PARTS for it in inventory.declared.get(kind, ()))


def _uses_of_mark(inventory: Inventory) -> Iterator[Use]:
    """Yield how an argument, in place of which the mark is, is used in each kind of names."""
    every = chain.from_iterable(inventory.names)
    names = dict.fromkeys((it.kind or it.kinds[0], it.text) for it in every)
    totals = Counter(kind for kind, _ in names)
    groups = lists_by_key(((kind, *_shape_of(text)), text) for kind, text in names if _MARK in text)
    for (kind, how, separator), texts in groups.items():
        example = texts[0].replace(_MARK, ROBOT)
        yield Use(kind, how, separator, len(texts), totals[kind], example)


def _shape_of(text: str) -> tuple[str, str]:
    """Return where in a name the argument is (whole, inside, prefix, postfix), and the separator."""
    before, _, after = text.strip("/").partition(_MARK)
    if not before and not after:
        return WHOLE, ""
    if before and after:
        return INSIDE, ""
    beside = after[:1] or before[-1:]
    return (PREFIX if after else POSTFIX), beside if beside in _SEPARATORS else ""


def as_json(found: XacroArguments) -> dict[str, object]:
    """Return the report as ``--output-kind json`` writes it."""
    rows = [(it, [use._asdict() for use in it.uses]) for it in found.arguments]
    arguments = [it._asdict() | {"uses": uses, "for_robots": it.value} for it, uses in rows]
    return {
        "file": found.file,
        "arguments": [{key: it[key] for key in it if key != "missed"} for it in arguments],
        "untried": found.untried,
        "for_robots": found.words,
    }
