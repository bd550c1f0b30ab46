# SPDX-License-Identifier: Apache-2.0
"""Parameters of a file against what their nodes declare: unknown, of another type, out of bounds."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.nearest import MISTYPED, Guesses, meant_name, nearest
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.params.name_sites import params_at
from multibot_rewrite.companions.params.rcl_parameters import Value, value_of
from multibot_rewrite.companions.params.sections import (
    ANY,
    RawSection,
    controller_types,
)
from multibot_rewrite.companions.yaml_text import YamlText, pairs
from multibot_rewrite.knowledge.declared import (
    DEMANDED,
    EVERY_NODE,
    READ,
    YAML,
    Declared,
    declared_by,
    stands_for,
)
from multibot_rewrite.knowledge.parameters import KnownNode
from multibot_rewrite.rules.files.bounds import beyond
from multibot_rewrite.rules.files.parameter_facts import facts_of_node, of_release
from multibot_rewrite.rules.files.plugins import RENAMED, plugins_in
from multibot_rewrite.rules.files.records import Remark, remark_at

# What every node has, or every controller and plugin; prefixes end in a dot.
_EVERYWHERE = re.compile(
    r"use_sim_time|start_type_description_service|qos_overrides\..*|diagnostic_updater\..*|bond_\w+|type"
    r"|params_file|update_rate|is_async|async_parameters\..*|introspection.*|.*\.plugin|enable_parameter_\w+"
    r"|.*plugin_?\w*|robot_description.*|fallback_controllers|node_options_args|autostart_node|service_\w+"
)
_ARRAY = re.compile(r"(\w+?)_array(?:_fixed_\d+)?")
_CAPITALS = re.compile(r"[A-Z][A-Z0-9]*_[A-Z0-9_]+")
ID = "<id>."
_NUMBERS = frozenset(("double", "int", "bool"))
_SURE = frozenset((YAML, DEMANDED))
_WORDS = {bool: "bool", int: "int", float: "double", str: "string"}


class Given(NamedTuple):
    """A parameter of a section: its dotted name, its key, and its value where rcl reads one."""

    name: str
    key: yaml.ScalarNode
    node: yaml.Node
    value: Value | None


class Section(NamedTuple):
    """The parameters of one node or plugin, each with what declares it, and all that is declared.
    ``whole`` is all that the node is given, where names of a plugin begin with ``at``."""

    title: str
    node: KnownNode | None
    given: tuple[Given, ...]
    facts: tuple[Declared, ...]
    known: tuple[tuple[Given, tuple[Declared, ...]], ...]
    whole: Mapping[str, Given]
    at: str = ""


def sections(file: NamedFile) -> tuple[Section, ...]:
    """The sections of a parameter file whose node is known."""
    if sections not in file.memo:
        file.memo[sections] = tuple(_sections(file))
    found: tuple[Section, ...] = file.memo[sections]
    return found


def _sections(file: NamedFile) -> Iterator[Section]:
    types = controller_types(RawSection(*it[:3]) for it, _ in file.pages)
    for it, _ in file.pages:
        name = it.path.rpartition("/")[2]
        if file.document is None:
            return
        given = tuple(_given(file.document, it.body, ""))
        if name in ANY or PLACEHOLDER.search(it.path):
            yield _section(it.path, None, given, declared_by(EVERY_NODE), given)
            continue
        type_ = types.get(name) or next((str(at.value) for at in given if at.name == "type"), "")
        node = it.node
        if node is not None and not _is_surely(node, name, type_, given):
            node = None
        facts = facts_of_node(node, type_, file.file, file.roots)
        below, rest = _of_plugins(it.path, given)
        yield _section(it.path, node, rest, (*facts, *declared_by(EVERY_NODE)), given)
        yield from below


def _section(
    title: str,
    node: KnownNode | None,
    given: tuple[Given, ...],
    facts: tuple[Declared, ...],
    whole: Sequence[Given],
    at: str = "",
) -> Section:
    exact: dict[str, list[Declared]] = {}
    wild: list[tuple[str, Declared]] = []
    for fact in facts:
        if "<" in fact.path:
            wild.append((fact.path.rpartition(".")[2], fact))
        else:
            exact.setdefault(fact.path, []).append(fact)
    known = tuple((it, (*exact.get(it.name, ()), *_matching(wild, it.name))) for it in given)
    return Section(title, node, given, facts, known, {it.name: it for it in whole}, at)


def _matching(wild: Sequence[tuple[str, Declared]], name: str) -> Iterator[Declared]:
    """Those that have the name, each with the last word of its path."""
    last = name.rpartition(".")[2]
    return (it for end, it in wild if (end == last or "<" in end) and it.has_name(name))


def _of_plugins(title: str, given: Sequence[Given]) -> tuple[list[Section], tuple[Given, ...]]:
    """A section for each known plugin, with names below its own; and what is no plugin's. Nobody knows
    what an unknown plugin declares."""
    plugins = plugins_in({it.name: it.value for it in given})
    of: dict[str, list[Given]] = {}
    for it in given:
        parts = it.name.split(".")
        above = (".".join(parts[:end]) for end in range(len(parts) - 1, 0, -1))
        of.setdefault(next((name for name in above if name in plugins), ""), []).append(it)
    rest, found = of.pop("", []), []
    for name, its in of.items():
        class_, facts = plugins[name]
        own = tuple(it._replace(name=it.name.removeprefix(f"{name}.")) for it in its)
        found.append(_section(f"{title}: {name} ({class_})", None, own, facts, given, f"{name}."))
    return found, tuple(rest)


def _is_surely(node: KnownNode, name: str, type_: str, given: Sequence[Given]) -> bool:
    """Is it this controller, not another one that is often called the same?"""
    if not node.facts.types or type_ in node.facts.types:
        return True
    words = {it.name.partition(".")[0] for it in given}
    by_words = bool(node.facts.known_by) and words.issuperset(node.facts.known_by)
    return "/" not in type_ and (name == node.name or by_words)


def _given(document: YamlText, body: yaml.Node, above: str) -> Iterator[Given]:
    for key, value in pairs(body):
        name = f"{above}{key.value}"
        if isinstance(value, yaml.MappingNode):
            yield from _given(document, value, f"{name}.")
        else:
            yield Given(name, key, value, _value(document, value))


def _value(document: YamlText, node: yaml.Node) -> Value | None:
    try:
        value = value_of(document, node)
    except InputError:
        return None
    texts = value if isinstance(value, list) else [value]
    filled = any(isinstance(it, str) and PLACEHOLDER.search(it) for it in texts)
    return None if filled else value


def unknown_parameters(file: NamedFile) -> Iterator[Remark]:
    """Parameters that no release of their node declares, with a name nearly that of one."""
    guesses = Guesses()
    for section in sections(file):
        unknown = [it for it, found in section.known if not found and not _is_known(section, it)]
        if not unknown:
            continue
        facts = [it for it in section.facts if it.how != READ]
        paths = [it.path for it in of_release(facts, file.context.distro)]
        there = [it for it in paths if "<" not in it]
        there += _in_blocks(section, paths) if section.node is None else ()
        said = {it.name for it in section.given}
        free = [it for it in there if it not in said]
        for it in unknown if there else ():
            near = _meant(it.name, free, guesses)
            if near:
                message = f"{section.title} has no parameter {it.name!r}"
                yield remark_at(it.key, message, f"did you mean {near!r}?")


def _in_blocks(section: Section, paths: Sequence[str]) -> Iterator[str]:
    """Parameters of a plugin in the blocks that the file gives it: ``scan`` of a layer's sources."""
    blocks = {it.name.partition(".")[0] for it in section.given if "." in it.name}
    inner = [it.removeprefix(ID) for it in paths if it.startswith(ID)]
    yield from (f"{block}.{it}" for block in sorted(blocks) for it in inner if "<" not in it)


def _is_known(section: Section, it: Given) -> bool:
    """Has every node such a parameter, or does it hold names?"""
    of_node = section.node is not None and bool(params_at(section.node, it.name, it.key))
    return of_node or _EVERYWHERE.fullmatch(it.name) is not None


def _meant(name: str, known: Sequence[str], guesses: Guesses) -> str:
    """The parameter in the same place, or the same one in another, that differs by little."""
    above, _, last = name.rpartition(".")
    beside = {it.rpartition(".")[2]: it for it in known if it.rpartition(".")[0] == above}
    if RENAMED.get(last) in beside:
        return beside[RENAMED[last]]
    near = meant_name(last, beside) or guesses.nearest(last, beside, MISTYPED)
    return beside.get(near, "") or meant_name(name, known)


def wrong_types(file: NamedFile) -> Iterator[Remark]:
    """Values of another type than the one that all declarations of a parameter have. It is an error
    where no release takes the value."""
    for section in sections(file):
        for it, known in section.known:
            type_ = _wrong_type(it, of_release(known, file.context.distro))
            if type_:
                given = _type_of(it.value) if it.value is not None else ""
                message = f"{section.title}: {it.name} is {_article(given)}, not {_article(type_)}"
                level = (
                    ERROR
                    if all(
                        _wrong_type(it, of_release(known, release))
                        for release in RELEASES
                        if of_release(known, release)
                    )
                    else ""
                )
                yield remark_at(it.node, message, _other_type(type_, given, it), level)


def _wrong_type(it: Given, known: Sequence[Declared]) -> str:
    """The type that a value has to be and is not."""
    if it.value is None or it.value == [] or _is_filled_in(it.value):
        return ""
    read = [fact for fact in known if fact.how != READ]
    exact = [fact for fact in read if fact.path == it.name] or read
    facts = [fact for fact in exact if fact.how == DEMANDED] or exact
    types = {fact.type for fact in facts}
    if len(types) != 1:
        return ""
    (type_,) = types
    # What code gives as a default may be a variable of any type.
    sure = all(fact.how in _SURE for fact in facts) or type_ in _NUMBERS
    return type_ if sure and _expected(type_) not in ("", _type_of(it.value)) else ""


def not_read(file: NamedFile) -> Iterator[Remark]:
    """Parameters of a node whose package declares all of its own in one file, and not these."""
    for section in sections(file):
        facts = [fact for fact in section.facts if fact.how != DEMANDED]
        if not facts or any(fact.how != YAML for fact in facts) or section.node is None:
            continue
        paths = [fact.path for fact in facts]
        for it, found in section.known:
            if found or _is_known(section, it) or _meant(it.name, paths, Guesses()):
                continue
            message = f"{section.title} declares no parameter {it.name!r}"
            yield remark_at(it.key, message, f"nothing reads it; see {facts[0].source}")


def below_unknown_names(file: NamedFile) -> Iterator[Remark]:
    """Parameters below a name that the list which has those names lacks: ``constraints.JOINT``."""
    for section in sections(file):
        for it, known in section.known:
            for fact in known if len(known) == 1 and known[0].how == YAML else ():
                for word, name in stands_for(fact.path, it.name).items():
                    listed = section.whole.get(section.at + word.strip("<>"))
                    names = listed.value if listed else None
                    if isinstance(names, list) and names and name not in names:
                        yield _for_unknown(section, it, name, [str(each) for each in names], word)


def _for_unknown(section: Section, it: Given, name: str, names: Sequence[str], word: str) -> Remark:
    near = nearest(name, names)
    hint = f"did you mean {near!r}?" if near else "nothing reads it"
    message = f"{section.title}: {it.name} is for {name!r}, which is not in {word.strip('<>')}"
    return remark_at(it.key, message, hint, WARNING if near else "")


def of_other_releases(file: NamedFile) -> Iterator[Remark]:
    """Parameters that the node declares in other releases only."""
    release = file.context.distro
    for section in sections(file):
        for it, known in section.known:
            facts = [fact for fact in known if fact.how != READ]
            if not facts or of_release(facts, release) or _is_known(section, it):
                continue
            others = [at for at in RELEASES if of_release(facts, at)]
            message = f"{section.title}: {it.name} is not in {release}, only in {', '.join(others)}"
            yield remark_at(it.key, message, f"delete it; see {facts[0].source}")


def out_of_bounds(file: NamedFile) -> Iterator[Remark]:
    """Values that a check of generate_parameter_library, or of the node's code, rejects."""
    for section in sections(file):
        for it, facts in _declared(section, file.context.distro):
            given = None if it.value is None else _type_of(it.value)
            alone = sum(fact.how != DEMANDED for fact in facts) == 1
            for fact in facts:
                if given != _expected(fact.type) or not (alone or fact.how == DEMANDED):
                    continue
                said = [beyond(*check, it.value) for check in fact.checks]
                for words in filter(None, said):
                    message = f"{section.title}: {it.name} is {it.value!r}, and has to be {words}"
                    yield remark_at(it.node, message, f"declared in {fact.source}")


def _is_filled_in(value: Value) -> bool:
    """Is it a word in capitals, which a launch file of Nav2 puts a value in place of?"""
    return isinstance(value, str) and _CAPITALS.fullmatch(value) is not None


def _declared(section: Section, release: str) -> Iterator[tuple[Given, list[Declared]]]:
    """Each parameter with its declarations in a release: those of its name, else those of a pattern."""
    for it, known in section.known:
        found = [fact for fact in of_release(known, release) if fact.how != READ]
        exact = [fact for fact in found if fact.path == it.name]
        if found and not (isinstance(it.value, str) and _is_filled_in(it.value)):
            yield it, exact or found


def _type_of(value: Value) -> str:
    if isinstance(value, list):
        return f"{_WORDS[type(value[0])]}_array" if value else "array"
    return _WORDS[type(value)]


def _expected(type_: str) -> str:
    """The type that rclcpp compares; empty where any is taken."""
    array = _ARRAY.fullmatch(type_)
    word = f"{array[1]}_array" if array else type_.partition("_fixed")[0]
    return word if word.removesuffix("_array") in _WORDS.values() else ""


def _article(type_: str) -> str:
    return f"{'an' if type_.startswith('int') else 'a'} {type_}"


def _other_type(type_: str, given: str, it: Given) -> str:
    if type_ == "double" and given == "int":
        return f"write {it.value}.0"
    if type_.startswith("double_array") and given == "int_array" and isinstance(it.value, list):
        return f"write [{', '.join(f'{value}.0' for value in it.value)}]"
    return "rclcpp throws InvalidParameterTypeException, and the node does not come up"
