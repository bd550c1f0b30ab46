# SPDX-License-Identifier: Apache-2.0
"""Guesses first plugin definitions for what a description loads and nothing knows."""

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import DefinitionsError
from multibot_rewrite.base.rosnames import split_remap
from multibot_rewrite.base.wording import clip
from multibot_rewrite.description.checks.mentions import MENTIONED
from multibot_rewrite.description.checks.unknown import is_unknown
from multibot_rewrite.description.reports.explain import plugin_name, short_name
from multibot_rewrite.description.rewriters import tree
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import (
    read_header,
    read_section,
    split_path,
    split_step,
)
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.description.steps.collect import Host, Inventory

if TYPE_CHECKING:
    from lxml.etree import _Element

# Names in the graph: what the tag says holds even where a link happens to be called the same.
_GRAPH = ("topic", "namespace", "service")
_LISTED = ("joint", "link", "frame")
# The last word of a tag -> what its value names.
WORDS = {"body": "link", **{word: word for word in (*_LISTED, *_GRAPH)}}
# Words at the end of a tag that do not say what it names.
_EMPTY = frozenset({"name", "names", "id", "ids", "list", "value", "text"})
_PIECES = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+")
_NO_NAME = re.compile(r"[-+0-9.eE\s,]*$|(?:true|false|yes|no|on|off|none)$", re.IGNORECASE)


class Guess(NamedTuple):
    """What a value may name, where in it the names are, and why that is thought.

    ``by_tag`` tells that the value itself says nothing.
    """

    kinds: tuple[str, ...]
    form: str
    why: str
    by_tag: bool = False


class SuggestedRow(NamedTuple):
    """One path of a section: the first value seen there, and a guess if there is one."""

    path: str
    value: str
    guess: Guess | None


class SuggestedSection(NamedTuple):
    """What can be said of one plugin or hardware class; ``blocks`` are those it shares.

    ``name`` is empty where no section can be called like it; ``label`` is what it is called then.
    """

    type: str
    name: str
    label: str
    blocks: tuple[str, ...]
    rows: tuple[SuggestedRow, ...]


class Loaded(NamedTuple):
    """What an element loads: the library (or class) of a plugin, the class of a hardware."""

    type: str
    name: str
    known: bool


def suggest(inventory: Inventory) -> list[SuggestedSection]:
    """Return a section for each unknown plugin and hardware class with parameters, in file order."""
    hosts: dict[tuple[str, str, str], list[Host]] = {}
    for host in inventory.hosts:
        thing = loaded_by(host)
        if thing is not None and not thing.known:
            name = _section_name(thing.type, host.element)
            hosts.setdefault((thing.type, name, "" if name else thing.name), []).append(host)
    sections = []
    for (type_, name, label), group in hosts.items():
        seen = lists_by_key(it for host in group for it in _values(host.element, host.node, ""))
        known = [it.node.section for it in group if it.node.section is not None]
        blocks = dict.fromkeys(b for it in known if it.type == "plugin" for b in it.blocks)
        rows = tuple(_row(path, values, inventory.declared) for path, values in seen.items())
        has_params = any("param" in split_path(it.path)[0][-1] for it in rows if it.path[0] != "@")
        if type_ == "plugin" or has_params:
            sections.append(SuggestedSection(type_, name, label, tuple(blocks), rows))
    return sections


def loaded_by(host: Host) -> Loaded | None:
    """Return what an element loads; None if it loads nothing (a sensor is no plugin)."""
    section = host.node.section
    assert section is not None
    type_ = section.select or section.type
    if type_ == "plugin":
        return Loaded(type_, plugin_name(host.element), not is_unknown(section))
    class_ = text_at(host.element, "hardware/plugin") if type_ == "hardware" else ""
    return Loaded(type_, class_, not section.select) if class_ else None


def _section_name(type_: str, element: "_Element") -> str:
    """Return the first name by which the element is looked up and that a section can have."""
    keys = tree.plugin_keys(element) if type_ == "plugin" else tree.hardware_keys(element)
    return next((key for key in keys if key != tree.ANY_WITH_ROS and _is_header(type_, key)), "")


def _is_header(type_: str, name: str) -> bool:
    """Return whether ``[TYPE NAME]`` is a valid header in a file of plugin definitions."""
    try:
        return read_header("", f"{type_} {name}]") == (type_, name)
    except DefinitionsError:
        return False


def _values(
    element: "_Element", node: tree.TreeNode | None, path: str
) -> Iterator[tuple[str, str]]:
    """Yield (path, value) of every attribute and text below an element that no row is about."""
    known = {""} if node is not None and node.text is not None else set()
    if node is not None:
        known |= {attribute for attribute, _ in node.attributes} | node.keeps.keys()
    chosen = path.endswith("]")
    for attribute, value in element.items():
        if attribute not in known and value.strip() and not (chosen and attribute == "name"):
            yield f"{path}@{short_name(str(attribute))}", str(value).strip()
    if "" not in known and element.text and element.text.strip() and path:
        yield path, element.text.strip()
    for child in element.iterchildren("*"):
        yield from _values(child, _child_node(node, child), f"{path}/{_step(child)}".lstrip("/"))


def _child_node(node: tree.TreeNode | None, child: "_Element") -> tree.TreeNode | None:
    below = node.children.get(str(child.tag)) if node is not None else None
    return below.select(child) if below is not None and below.select is not None else below


def _step(element: "_Element") -> str:
    """Return a step of a path for an element; parameters are told apart by their name."""
    tag, name = short_name(str(element.tag)), element.get("name", "")
    step = f"{tag}[@name={name}]"
    return step if tag in ("param", "parameter") and _is_path(step) else tag


def _is_path(path: str) -> bool:
    """Return whether a row can start with this path: XML allows more in a name."""
    try:
        _, sites = read_section("", 0, ["plugin x]", f"{path} keep it"])
    except DefinitionsError:
        return False
    return path in sites


def _row(path: str, values: Sequence[str], declared: Declared) -> SuggestedRow:
    """Return the best guess of all values at one path, with the kinds that others of them add."""
    word = tag_kind(path)
    guesses = [_guess_value(value, word, declared) for value in values]
    made = [it for it in guesses if it is not None]
    best = max(made, key=lambda it: (not it.by_tag, it.form != "whole"), default=None)
    if best is None or not _is_path(path):
        return SuggestedRow(path, values[0], None)
    value = values[guesses.index(best)]
    if best.by_tag or best.form == "remap":
        return SuggestedRow(path, value, best)
    others = [kind for it in made if not it.by_tag and it.form != "remap" for kind in it.kinds]
    kinds = tuple(dict.fromkeys((*best.kinds, *others)))
    return SuggestedRow(path, value, best._replace(kinds=kinds))


def tag_kind(path: str) -> str:
    """Return the kind of name that a path suggests: ``left/jointName`` a joint; or empty."""
    steps, attribute = split_path(path)
    names = [split_step(step)[2] or split_step(step)[0] for step in steps]
    for name in reversed([*names, attribute]):
        words = [word.lower() for word in _PIECES.findall(name)]
        while words and words[-1] in _EMPTY:
            words.pop()
        if words:
            last = words[-1].removesuffix("name").removesuffix("s")
            return next((kind for word, kind in WORDS.items() if last.endswith(word)), "")
    return ""


def _guess_value(value: str, word: str, declared: Declared) -> Guess | None:
    """Return the guess by the value, or by the word of its tag; None for no name."""
    by_value = _by_value(value, declared)
    if by_value is None or (word in _GRAPH and by_value.form != "remap"):
        return _by_tag(value, word)
    if word == "frame" and by_value.kinds[0] in MENTIONED:
        kinds = ("frame",) if by_value.form in ("whole", "list") else (*by_value.kinds, "frame")
        return by_value._replace(kinds=kinds)
    first = [word] if word in by_value.kinds else []
    return by_value._replace(kinds=tuple(dict.fromkeys((*first, *by_value.kinds))))


def _by_value(value: str, declared: Declared) -> Guess | None:
    """Return the guess for a value that holds a declared name, or is a remap rule."""
    if split_remap(value) is not None:
        return Guess(("topic",), "remap", f"{shown(value)} is a remap rule")
    for form, names in _readings(value):
        found = {kind: next((n for n in names if n in declared[kind]), "") for kind in MENTIONED}
        if named := [(kind, name) for kind, name in found.items() if name]:
            return Guess(tuple(kind for kind, _ in named), form, _names_in_words(value, named))
    if value.startswith("/") and value[1:] in declared["link"]:
        return Guess(("frame",), "whole", f"{shown(value)} is a link here, but for the slash")
    return None


def _names_in_words(value: str, named: Sequence[tuple[str, str]]) -> str:
    if all(name == value for _, name in named):
        return f"{shown(value)} is a {' and a '.join(kind for kind, _ in named)} here"
    return f"{shown(value)} holds {' and '.join(f'the {k} {shown(name)}' for k, name in named)}"


def _readings(value: str) -> Iterator[tuple[str, Sequence[str]]]:
    """Yield (form, names) for each form that a value may have."""
    yield "whole", [value]
    if _NO_NAME.match(value):
        return
    if "::" in value and not any(mark in value for mark in ", \t\n"):
        yield "scoped", [value.rpartition("::")[2]]
    items = value.replace(",", " ").split()
    if len(items) > 1:
        yield "list", items
    elif "/" in value:
        ends = [at for at, letter in enumerate(value) if letter == "/"]
        yield "suffixed", [value[:at] for at in reversed(ends)]


def _by_tag(value: str, word: str) -> Guess | None:
    """Return the guess by the tag, if the value can be a name."""
    if not word or _NO_NAME.match(value):
        return None
    several = len(value.replace(",", " ").split()) > 1
    if several and word not in _LISTED:
        return None
    form = "list" if several else "scoped" if "::" in value and word in _LISTED else "whole"
    return Guess((word,), form, f"the tag, as in {shown(value)}", by_tag=True)


def shown(value: str) -> str:
    """Return a value in quotes, on one line and not too long."""
    return repr(clip(value))


def definitions_text(sections: Iterable[SuggestedSection], file: str) -> str:
    """Return a usable file of plugin definitions; without sections only comments."""
    name = " ".join(file.split())
    parts = [_section_text(section, name.rpartition("/")[2]) for section in sections]
    if not parts:
        return f"# Nothing to suggest: no plugin and no hardware class of {name} is unknown.\n"
    head = (
        f"# Guessed from {name}: check each line against the source of the plugin.\n"
        "# Of a line behind # nothing could be guessed; its value stays as it is.\n"
    )
    return "\n".join([head, *parts])


def _section_text(section: SuggestedSection, file: str) -> str:
    if not section.name:
        return f"# no section can be called {shown(section.label)}\n"
    head = [f"[{section.type} {section.name}]", f"about: guessed from {file}, not checked"]
    shared = [f"with: {' '.join(section.blocks)}"] if section.blocks else []
    return "\n".join([*head, *shared, *map(_row_text, section.rows)]) + "\n"


def _row_text(row: SuggestedRow) -> str:
    if row.guess is None:
        return f"# {' '.join(row.path.split())}: {shown(row.value)}"
    form = f" form={row.guess.form}" if row.guess.form != "whole" else ""
    return f"{row.path} uses {' '.join(row.guess.kinds)}{form}   # guessed: {row.guess.why}"
