# SPDX-License-Identifier: Apache-2.0
"""What the parameter files of a robot, MoveIt's too, set for nodes and plugins; what declares it."""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple, cast

import yaml

from multibot_rewrite.base.bounded import ANGLES
from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.packages import entries, is_for_ros_1
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.sources.trace import alike
from multibot_rewrite.knowledge.declared import EVERY_NODE, Declared, declared_by, stands_for
from multibot_rewrite.knowledge.node_sets import load_nodes
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.knowledge.records import NodeFacts, NodeParameters
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.evidence.parameter_files import given_nodes
from multibot_rewrite.related_files.moveit.file_kind import find_kind, parameter_above
from multibot_rewrite.related_files.moveit.rewrite import node_of
from multibot_rewrite.related_files.named_file import (
    MOVEIT,
    PARAMS,
    NamedFile,
    is_related_file,
    kind_of,
)
from multibot_rewrite.related_files.params.rcl_parameters import value_of
from multibot_rewrite.related_files.params.sections import (
    ANY,
    RawSection,
    controller_types,
    settings,
)
from multibot_rewrite.related_files.yaml_text import YamlText, read_yaml
from multibot_rewrite.rules.files.parameter_files import facts_of_node
from multibot_rewrite.rules.files.plugins import plugins_in
from multibot_rewrite.system.parameters import Value
from multibot_rewrite.system.records import NOWHERE, Place
from multibot_rewrite.system.words import last_word


class Beside(NamedTuple):
    """What all parameter files of a robot set for nodes, and the nodes that are known by name."""

    given: tuple[Run, ...]
    known: Mapping[str, NodeFacts]


def beside(file: NamedFile) -> Beside:
    """Return the robot's parameter files; for a file alone, those in its folder."""
    if Beside not in file.memo:
        release = file.context.distro
        file.memo[Beside] = Beside(_given_by(file, _files_in_folder(file)), load_nodes(release))
    found: Beside = file.memo[Beside]
    return found


def given_in(file: NamedFile) -> tuple[Run, ...]:
    """Return the settings of nodes by all files of a certain robot, otherwise by the file alone."""
    if file.is_certain:
        return beside(file).given
    return _given_by(file, [file.document] if file.document else [])


def is_set_in_other_file(file: NamedFile, title: str, name: str) -> bool:
    """Return whether a parameter file of the robot sets a name for the node of a section or plugin."""
    node = last_word(title.partition(":")[0])
    return any(name in it.values for it in beside(file).given if last_word(it.node) == node)


def is_in(file: NamedFile, place: Place) -> bool:
    """Return whether the place is in this file."""
    return os.path.abspath(place.file) == os.path.abspath(file.file)


def did_you_mean_at(near: str, place: Place) -> str:
    """Return the hint that asks whether a name was meant, with its place."""
    if place == NOWHERE:
        return f"did you mean {near}?"
    return f"did you mean {near} ({shown(place)})?" if near else f"see {shown(place)}"


def shown(place: Place) -> str:
    """Return a place as text; a file below the current folder by its path from there."""
    return str(place._replace(file=alike(place.file, os.curdir)))


def _given_by(file: NamedFile, documents: Iterable[YamlText]) -> tuple[Run, ...]:
    """Return the nodes; none if a file cannot be read, which is reported when it is linted itself."""
    try:
        return tuple(given_nodes(documents, built_in_nodes(file.context.distro)))
    except InputError:
        return ()


def _files_in_folder(file: NamedFile) -> Iterator[YamlText]:
    own = os.path.abspath(file.file)
    folder = os.path.dirname(own)
    for path in (os.path.join(folder, it) for it in sorted(entries(folder))):
        data = read_file(path) if is_related_file(path) else b""
        if kind_of(data) == PARAMS:
            yield file.document if file.document and path == own else read_yaml(data, path)


ASKED = "asked"
_FLOAT = "tag:yaml.org,2002:float"


class Setting(NamedTuple):
    """A parameter of a section: its dotted name, its key, and its value where rcl reads one."""

    name: str
    key: yaml.ScalarNode
    node: yaml.Node
    value: Value | None


class Section(NamedTuple):
    """The parameters of one node or plugin, each with what declares it, and all that is declared.

    ``whole`` is all that the node is given, where names of a plugin begin with ``at``."""

    title: str
    node: NodeParameters | None
    given: tuple[Setting, ...]
    facts: tuple[Declared, ...]
    known: tuple[tuple[Setting, tuple[Declared, ...]], ...]
    whole: Mapping[str, Setting]
    at: str = ""


def sections(file: NamedFile) -> tuple[Section, ...]:
    """Return the sections of a parameter file, or the parameters of a file of MoveIt."""
    if sections not in file.memo:
        read = _moveit_section if file.kind == MOVEIT else _sections
        file.memo[sections] = tuple(read(file))
    found: tuple[Section, ...] = file.memo[sections]
    return found


def _sections(file: NamedFile) -> Iterator[Section]:
    types = controller_types(RawSection(*it[:3]) for it, _ in file.pages)
    for it, _ in file.pages:
        name = it.path.rpartition("/")[2]
        if file.document is None:
            return
        given = _settings_below(file.document, it.body)
        if name in ANY or PLACEHOLDER.search(it.path):
            yield _section(it.path, None, given, declared_by(EVERY_NODE), _settings_by_name(given))
            continue
        type_ = types.get(name) or next((str(at.value) for at in given if at.name == "type"), "")
        node = it.node
        if node is not None and not _is_this_controller(node, name, type_, given):
            node = None
        facts = facts_of_node(node, type_, file.file, file.roots)
        whole = _settings_by_name(given)
        below, rest = _plugin_sections(it.path, given, whole)
        yield _section(it.path, node, rest, (*facts, *declared_by(EVERY_NODE)), whole)
        yield from below


def _moveit_section(file: NamedFile) -> Iterator[Section]:
    kind = find_kind(file.document) if file.document else None
    if file.document is None or kind is None or is_for_ros_1(file.file):
        return
    node = built_in_nodes(file.context.distro).nodes[node_of(kind)]
    above = parameter_above(kind, file.document)
    root = file.document.root
    read = _settings_below(file.document, root, above) if root is not None else ()
    given = tuple(it._replace(value=_moveit_value(it.node, it.value)) for it in read)
    facts = facts_of_node(node, "", file.file, file.roots)
    yield _section(node.name, node, given, facts, _settings_by_name(given))


def _settings_by_name(given: Sequence[Setting]) -> Mapping[str, Setting]:
    return {it.name: it for it in given}


def _section(
    title: str,
    node: NodeParameters | None,
    given: tuple[Setting, ...],
    facts: tuple[Declared, ...],
    whole: Mapping[str, Setting],
    at: str = "",
) -> Section:
    """Return a section of these settings, each with the declarations that it has."""
    exact = lists_by_key((it.path, it) for it in facts if "<" not in it.path)
    wild = [(it.path.rpartition(".")[2], it) for it in facts if "<" in it.path]
    known = tuple(
        (it, (*exact.get(it.name, ()), *_wild_declarations(wild, it.name))) for it in given
    )
    # Without what is not read with the value of another parameter.
    asked = tuple(
        (it, tuple(fact for fact in its if _is_read(fact, it.name, whole, at))) for it, its in known
    )
    return Section(title, node, given, facts, asked, whole, at)


def _is_read(fact: Declared, name: str, whole: Mapping[str, Setting], at: str) -> bool:
    """Return whether a declared parameter is read with the values of the others."""
    for check, text in fact.checks if ASKED in fact.bounds else ():
        if check == ASKED:
            other, value = filled(text, fact.path, name)
            given = whole.get(at + other)
            if given is None or str(given.value).lower() != value.lower():
                return False
    return True


def filled(text: str, path: str, name: str) -> tuple[str, ...]:
    """Return the words of a check, with the parts of a name that stand for ``<...>`` in a path."""
    words = text.split()
    for word, part in (stands_for(path, name) if "<" in text else {}).items():
        words = [it.replace(word, part) for it in words]
    return tuple(words)


def _wild_declarations(wild: Sequence[tuple[str, Declared]], name: str) -> Iterator[Declared]:
    """Yield the declarations whose path with a placeholder matches the name."""
    last = name.rpartition(".")[2]
    return (it for end, it in wild if (end == last or "<" in end) and it.has_name(name))


def _plugin_sections(
    title: str, given: Sequence[Setting], whole: Mapping[str, Setting]
) -> tuple[list[Section], tuple[Setting, ...]]:
    """Return a section for each known plugin with its names below; and the other settings."""
    plugins = plugins_in({it.name: it.value for it in given})
    of: dict[str, list[Setting]] = {}
    for it in given:
        parts = it.name.split(".")
        above = (".".join(parts[:end]) for end in range(len(parts) - 1, 0, -1))
        of.setdefault(next((name for name in above if name in plugins), ""), []).append(it)
    rest, found = of.pop("", []), []
    for name, its in of.items():
        class_, facts = plugins[name]
        own = tuple(it._replace(name=it.name.removeprefix(f"{name}.")) for it in its)
        found.append(_section(f"{title}: {name} ({class_})", None, own, facts, whole, f"{name}."))
    return found, tuple(rest)


def _is_this_controller(
    node: NodeParameters, name: str, type_: str, given: Sequence[Setting]
) -> bool:
    """Return whether a section is of this controller, not of another that often has its name."""
    if not node.types or type_ in node.types:
        return True
    words = {it.name.partition(".")[0] for it in given}
    by_words = bool(node.known_by) and words.issuperset(node.known_by)
    return "/" not in type_ and (name == node.name or by_words)


def _settings_below(document: YamlText, body: yaml.Node, above: str = "") -> tuple[Setting, ...]:
    every = settings(body, above)
    return tuple(
        Setting(name, key, node, _known_value(document, node)) for name, key, node in every
    )


def _moveit_value(node: yaml.Node, value: Value | None) -> Value | None:
    """Return a value of MoveIt's files as launch files read it; None for an expression of an angle.

    Source: launch_param_builder utils.py, load_yaml; moveit2 moveit_configs_utils."""
    if isinstance(node, yaml.SequenceNode) and isinstance(value, list):
        each = [_moveit_value(it, one) for it, one in zip(node.value, value, strict=True)]
        return None if None in each else cast("Value", each)
    read = float if node.tag == _FLOAT and isinstance(value, int) else ANGLES.get(node.tag)
    try:
        return read(float(str(node.value))) if read else value
    except ValueError:
        return None


def _known_value(document: YamlText, node: yaml.Node) -> Value | None:
    try:
        value = value_of(document, node)
    except InputError:
        return None
    texts = value if isinstance(value, list) else [value]
    filled = any(isinstance(it, str) and PLACEHOLDER.search(it) for it in texts)
    return None if filled else value
