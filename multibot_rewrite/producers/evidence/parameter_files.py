# SPDX-License-Identifier: Apache-2.0
"""Parameter files -> the nodes they are for, with all values that each node gets.

Sources: rcl_yaml_param_parser (a later section wins; wildcards count for every node that they match);
ros2_control controller_manager.cpp (a controller manager's ``NAME.type`` makes a controller NAME),
controller_manager/spawner.py (``type`` of a controller's own section is set as that).
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import lru_cache
from itertools import dropwhile
from operator import itemgetter
from typing import NamedTuple

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.nearest import SLIP, nearest
from multibot_rewrite.base.rosnames import check_node_name
from multibot_rewrite.knowledge.parameters import KnownNodes
from multibot_rewrite.knowledge.records import UNKNOWN
from multibot_rewrite.planning.records import Given, Run
from multibot_rewrite.related_files.names.placeholders import of_one_robot, without_robot
from multibot_rewrite.related_files.params.rcl_parameters import value_of
from multibot_rewrite.related_files.params.sections import (
    ANY,
    INNER,
    MANAGER,
    PARAMETERS,
    RawSection,
    identify_node,
    is_for,
    raw_sections,
)
from multibot_rewrite.related_files.yaml_text import YamlText, line_of, names_below, pairs
from multibot_rewrite.system.records import Place

OWN_TYPE = "type"
TYPE = f".{OWN_TYPE}"


class _Section(NamedTuple):
    """A section; ``name`` is the node's without wildcards in front, "" for a section of every node."""

    file: str
    raw: RawSection
    values: dict[str, Given]
    name: str

    @property
    def place(self) -> Place:
        return Place(self.file, line_of(self.raw.keys[0]))


def given_nodes(
    documents: Iterable[YamlText],
    known: KnownNodes,
    managers: Collection[str] = (),
) -> list[Run]:
    """Return the nodes that these files have sections for, and the controllers that they declare.

    ``managers`` have unusual names. Raises InputError for another file or an invalid name."""
    sections = [it for document in documents for it in _sections(document)]
    controllers = {**dict(_typed(sections, known)), **dict(_controllers(sections, managers))}
    for name, it in controllers.items():
        _check_name(name.rpartition("/")[2], it.type.place)
    # A node of Nav2 makes helpers that have its parameters, and none of its topics and actions.
    own = (it.name for it in sections if not it.name.endswith(INNER))
    names = dict.fromkeys(filter(None, (*own, *controllers)))
    near = _by_name(sections)
    return [_run_of_sections(name, near(name), controllers.get(name), known) for name in names]


def _check_name(name: str, place: Place) -> None:
    """Raise InputError for the name of a controller that no node can have."""
    fault = check_node_name(name)
    # Launch files fill in placeholders.
    if not fault or PLACEHOLDER.search(name):
        return
    owner, _, last = name.rpartition(".")
    if last == PARAMETERS:
        message = f"the type of {owner!r} is below a second {PARAMETERS}, where nothing reads it"
        raise InputError(f"{place}: {message}; write type: directly below {owner}:")
    hint = "write letters, digits and underscores, a letter first"
    raise InputError(f"{place}: controller {name!r}: {fault.reason}; {hint}")


def named_values(
    document: YamlText, nodes: Iterable[str]
) -> Iterator[tuple[str, dict[str, Given]]]:
    """Yield nodes that a file has sections for by name, with all their values; raises InputError."""
    sections = _sections(document)
    for node in nodes:
        own = [it for it in sections if is_for(it.raw.path, node)]
        if any(it.name for it in own):
            yield node, _values(own)


def values_for(node: str, documents: Iterable[YamlText]) -> dict[str, Given]:
    """Return all values that a node (full name) gets from these files; raises as ``named_values``."""
    sections = [it for document in documents for it in _sections(document)]
    return _values(_sections_for(sections, node.strip("/")))


@lru_cache(maxsize=64)
def _sections(document: YamlText) -> tuple[_Section, ...]:
    """Return the sections of a file, kept: each launched node that gets the file asks for them."""
    found = []
    for it in raw_sections(document):
        tokens = [*dropwhile(ANY.__contains__, it.path.strip("/").split("/"))]
        name = "/".join(tokens) if not set(tokens) & set(ANY) else ""
        found.append(_Section(document.file, it, dict(_flat_values(document, it.body, "")), name))
    return tuple(found)


def _flat_values(document: YamlText, body: yaml.Node, above: str) -> Iterator[tuple[str, Given]]:
    """Yield (dotted name, value) of a section's parameters, for any robot."""
    for key, node in pairs(body):
        name = f"{above}{without_robot(str(key.value))}"
        if below := names_below(node):
            yield from _flat_values(document, below, f"{name}.")
            continue
        # What rcl rejects is reported where the file is rewritten.
        with suppress(InputError):
            value = value_of(document, node)
            # Without what stands for the robot in names.
            if isinstance(value, list):
                value = [of_one_robot(it) if isinstance(it, str) else it for it in value]
            elif isinstance(value, str):
                value = of_one_robot(value)
            yield name, Given(value, Place(document.file, line_of(key)))


class _Controller(NamedTuple):
    type: Given
    manager: str


def _controllers(
    sections: Sequence[_Section], managers: Collection[str]
) -> Iterator[tuple[str, _Controller]]:
    """Yield (name, controller) of those in managers' sections, below the manager's namespace."""
    for section in sections:
        above, _, last = section.name.rpartition("/")
        # A renamed one is called controller_manager_robot1, for example.
        if MANAGER not in last and not any(is_for(section.raw.path, it) for it in managers):
            continue
        # What is for every node is for the manager, too; those of MoveIt are below a name there.
        own = f"/{section.name}"
        for_all = [it for it in sections if not it.name and is_for(it.raw.path, own)]
        shared = (pair for it in for_all for pair in it.values.items() if pair[0].count(".") == 1)
        for name, given in (*shared, *section.values.items()):
            if name.endswith(TYPE):
                controller = name.removesuffix(TYPE)
                full = f"{above}/{controller}" if above else controller
                yield full, _Controller(given, section.name)


def _typed(sections: Sequence[_Section], known: KnownNodes) -> Iterator[tuple[str, _Controller]]:
    """Yield (name, controller) of those whose own section has a type: a spawner hands that on."""
    for section in sections:
        given = section.values.get(OWN_TYPE)
        if section.name and given is not None and given.value in known.types:
            above = section.name.rpartition("/")[0]
            yield section.name, _Controller(given, f"{above}/{MANAGER}" if above else MANAGER)


def _by_name(sections: Sequence[_Section]) -> Callable[[str], list[_Section]]:
    """Return a function that finds a node's sections, in order: those of its name, and wildcards."""
    wild: list[tuple[int, _Section]] = []
    named: dict[str, list[tuple[int, _Section]]] = {}
    for number, it in enumerate(sections):
        of = wild if "*" in it.raw.path else named.setdefault(it.name, [])
        of.append((number, it))
    return lambda name: [it for _, it in sorted([*named.get(name, ()), *wild], key=itemgetter(0))]


def _sections_for(sections: Sequence[_Section], name: str) -> list[_Section]:
    """Return the sections that a node reads: those of its name, and wildcards."""
    # A section such as /*/NODE is for the node in whatever namespace it is.
    return [it for it in sections if it.name == name or is_for(it.raw.path, f"/{name}")]


def _values(sections: Sequence[_Section]) -> dict[str, Given]:
    """Return the values of sections by name; those of later sections count."""
    return {key: given for it in sections for key, given in it.values.items()}


def _run_of_sections(
    name: str, sections: Sequence[_Section], controller: _Controller | None, known: KnownNodes
) -> Run:
    """Return a node with the values of its sections, and what it is known as."""
    own = _sections_for(sections, name)
    values = _values(own)
    named = [it for it in own if it.name]
    last = name.rpartition("/")[2]
    type_ = str(controller.type.value) if controller else ""
    body = named[-1].raw.body if named else None
    found = identify_node(last, body, known, {last: type_} if type_ else {})
    place = controller.type.place if controller else named[0].place
    unknown = bool(type_) and type_ not in known.types
    like = nearest(type_, known.types, SLIP) if unknown else ""
    return Run(
        *("", name, "", last, (), UNKNOWN._replace(known=found.name if found else "")),
        host_name=controller.manager if controller else "",
        values=values,
        program=type_,
        place=place,
        unknown_type=unknown,
        like=like,
    )
