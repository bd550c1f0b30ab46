"""The names in a section -> splices that spell them, and what a person should know of them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.params.known import Known, in_release
from multibot_rewrite.companions.params.sections import Section, finding
from multibot_rewrite.companions.params.spelled import (
    SPELLERS,
    expressible,
    frames_are_spelled,
    is_component,
    is_plain,
    is_shared_frame,
)
from multibot_rewrite.companions.params.topics import FROM_NODE, FROM_PARENT, IN_FULL, Facts, topic
from multibot_rewrite.companions.params.uses import Use, Uses
from multibot_rewrite.companions.respell import is_declared
from multibot_rewrite.companions.yaml_text import Splice, YamlText, pairs, replaced
from multibot_rewrite.model import ERROR, WARNING, Finding
from multibot_rewrite.nearest import did_you_mean
from multibot_rewrite.rosnames import check_topic_name

# What must be among the description's names, by the kinds that are looked at.
_CLOSED = {"joint": ("joint",), "link": ("link",), "sensor": ("sensor",)}
_PREFIXES = ("stem", "link_prefix", "joint_prefix")
_PLACEHOLDER = re.compile(r"<[^>]*>|\$\([^)]*\)|\$?\{[^}]*\}")
# Kinds of which a guess needs the description's word.
_UNSURE = ("frame", "sensor", "interface")
# A pattern that lets everything pass or nothing names no robot's name.
_OPEN_PATTERNS = frozenset({".*", "*", "[*]", "(?!)", "^$"})


class Desk(NamedTuple):
    """What every step about one file needs."""

    document: YamlText
    context: Context
    known: Known
    facts: Facts
    robots: frozenset[str] = frozenset()


def respelled(desk: Desk, section: Section, uses: Uses) -> Iterator[Splice | Finding]:
    """What becomes of every name of a section."""
    keys: dict[int, tuple[yaml.ScalarNode, list[str]]] = {}
    for use in uses.names:
        if use.at >= 0:
            words = keys.setdefault(id(use.scalar), (use.scalar, str(use.scalar.value).split(".")))[
                1
            ]
            words[use.at] = _text(desk.context, use)
        elif use.kind in ("topic", "service"):
            yield from _topic(desk, section, use)
        elif use.kind in SPELLERS:
            yield from _replaced(desk, use, _text(desk.context, use))
        elif use.kind == "off":
            yield from _off(desk, use)
    for key, words in keys.values():
        if (text := ".".join(words)) != key.value:
            yield replaced(key, text)


def _text(context: Context, use: Use) -> str:
    # A frame that only its parameter's name makes one may as well be a word such as enu.
    guessed = use.param is None and use.kind in _UNSURE
    if guessed and not _is_certain(context, use):
        return use.value
    speller = SPELLERS.get(use.kind)
    return speller(context, use.value) if speller else use.value


def _is_certain(context: Context, use: Use) -> bool:
    if use.kind == "interface":
        return any(is_component(context, it) for it in use.value.split("/")[:-1])
    return is_declared(context.names, use.kind, use.value.lstrip("/")) or use.value == "odom"


def _replaced(desk: Desk, use: Use, text: str) -> Iterator[Splice | Finding]:
    if text == use.value:
        return
    if use.scalar.style in ("|", ">"):
        message = f"{use.key.value} is a block of text, which is not rewritten"
        hint = f"write it on one line: {use.key.value}: {use.value.strip()}"
        yield finding(desk.document, use.scalar, "MF119", WARNING, message, hint)
        return
    yield replaced(use.scalar, text)


def _topic(desk: Desk, section: Section, use: Use) -> Iterator[Splice | Finding]:
    landing = topic(
        desk.context, section.path, use.kind, use.value, _reach(desk, section, use), desk.facts
    )
    yield from _replaced(desk, use, landing.text)
    if landing.astray:
        message = f"{use.key.value}: {landing.text} leads to {landing.astray} by the robot's rules"
        hint = "take the name out of the remap rules of this node, or out of this file"
        yield finding(desk.document, use.scalar, "MF120", WARNING, message, hint)
    if landing.moved and landing.text != use.value:
        message = "relative topics of a costmap fall below the costmap's own name: written in full"
        hint = "a file for Kilted or later may have them relative: name that release as distro"
        yield finding(desk.document, use.scalar, "MF121", WARNING, message, hint)


def _reach(desk: Desk, section: Section, use: Use) -> str:
    words = use.param.absolute if use.param else ""
    if not words:
        return FROM_NODE
    if in_release(words, desk.context.distro) or _is_binary_filter(use):
        return IN_FULL
    return FROM_PARENT


def _is_binary_filter(use: Use) -> bool:
    """The one filter that does not join its names with the robot's namespace."""
    layer = {key.value: value.value for key, value in pairs(use.layer)}
    return "BinaryFilter" in str(layer.get("plugin", ""))


def _off(desk: Desk, use: Use) -> Iterator[Splice | Finding]:
    """What would put a namespace before frames that are spelled here."""
    if use.value.lower() in ("true", "yes", "on", "y"):
        yield Splice(use.scalar.start_mark.index, use.scalar.end_mark.index, "false")
    elif "$" in use.value or "<" in use.value:
        message = f"{use.key.value} is {use.value}, and has to be false"
        hint = "true puts the namespace before frames that have the robot's name already"
        yield finding(desk.document, use.scalar, "MF116", WARNING, message, hint)


def about_names(desk: Desk, section: Section, uses: Uses) -> Iterator[Finding]:
    """What a person should know of a section's names and of its form."""
    for use in uses.names:
        yield from _about(desk, use)
    guessed = [use.key for use in uses.names if use.param is None and _is_taken(desk, use)]
    if guessed and section.node is None and not section.wild:
        words = ", ".join(dict.fromkeys(key.value for key in guessed))
        message = f"node {section.path} is not known: what holds names is guessed from {words}"
        hint = "describe it in a file of parameters"
        yield finding(desk.document, guessed[0], "MF114", WARNING, message, hint)
    for key in uses.twice:
        message = f"{key.value!r} stands here twice"
        yield finding(desk.document, key, "MF108", WARNING, message, "the later counts: leave one")
    for key in uses.empty:
        message = f"{key.value!r} has no value"
        hint = 'rcl refuses the whole file: write a value, or ""'
        yield finding(desk.document, key, "MF109", WARNING, message, hint)


def _about(desk: Desk, use: Use) -> Iterator[Finding]:
    """What is to be said of one name."""
    said = None
    if use.kind == "frame" or use.kind in _CLOSED:
        said = _undeclared(desk, use)
    elif use.kind in ("topic", "service"):
        said = _no_topic(use)
    elif use.kind in _PREFIXES:
        said = _inexpressible(desk, use)
    elif use.kind in ("doubles", "exclusive", "pattern", "text"):
        said = _told(desk, use)
    if said:
        code, level, message, hint = said
        yield finding(desk.document, use.scalar, code, level, message, hint)
    if not is_plain(use.value) and (found := _PLACEHOLDER.search(use.value)):
        message = f"{found[0]} stays: a launch file has to fill it"
        hint = "if the fill is the robot's name, write the name without it"
        yield finding(desk.document, use.scalar, "MF110", WARNING, message, hint)


def _is_taken(desk: Desk, use: Use) -> bool:
    """Does the guess make a name of it?"""
    return use.kind in ("topic", "service") or _text(desk.context, use) != use.value


_Said = tuple[str, str, str, str]


def _undeclared(desk: Desk, use: Use) -> _Said | None:
    """A name that the description does not have."""
    names, value = desk.context.names, use.value.lstrip("/")
    known = names.declared.get("link" if use.kind == "frame" else use.kind, {})
    if not known or not is_plain(use.value) or is_declared(names, use.kind, value):
        return None
    if use.kind == "frame":
        if value in desk.known.sent or is_shared_frame(desk.context, value):
            return None
        what = "frame" if use.param else "perhaps a frame,"
        message = f"{what} {value!r} is not in the description"
        hint = did_you_mean(value, known) or "a node or driver must send it under the robot's name"
        return "MF112", WARNING, message, hint
    if "/" in value and use.kind == "joint" and value.rpartition("/")[2] in known:
        return None
    if use.param is None:
        return None
    message = f"{use.kind} {value!r} is not in the description"
    return "MF111", WARNING, message, did_you_mean(value, known) or "it stays as it is"


def _no_topic(use: Use) -> _Said | None:
    fault = check_topic_name(use.value) if is_plain(use.value) else None
    if not fault:
        return None
    message = f"{use.kind} {use.value!r} is none: {fault.reason}"
    return "MF113", WARNING, message, "it stays as it is: correct it"


def _inexpressible(desk: Desk, use: Use) -> _Said | None:
    if expressible(desk.context, use.kind):
        return None
    message = f"{use.key.value} can only put something before names, and the naming is a postfix"
    return "MF117", WARNING, message, "use affix: prefix"


def _told(desk: Desk, use: Use) -> _Said | None:
    """What nothing here rewrites."""
    key, value = use.key.value, use.value
    if use.kind == "doubles":
        level = ERROR if frames_are_spelled(desk.context) and is_plain(value) else WARNING
        return "MF115", level, f"{key} {value!r} is put before frames once more", 'write ""'
    if use.kind == "exclusive":
        idle = not value or value.lower() in ("false", "no", "off")
        hint = "give each robot its own, in a file that comes after this one"
        return None if idle else ("MF118", WARNING, f"{key} {value} is every robot's", hint)
    if value in _OPEN_PATTERNS or not (use.kind == "pattern" or _mentions(desk.context, value)):
        return None
    message = f"{key} {value!r} is a text in which names are not rewritten"
    return "MF122", WARNING, message, "check it for each robot"


def _mentions(context: Context, value: str) -> bool:
    words = "".join(c if c.isalnum() or c in "_-/" else " " for c in value).split()
    return any(is_declared(context.names, kind, it) for it in words for kind in ("link", "joint"))


def already(desk: Desk, sections: Iterable[Section], pages: Iterable[Uses]) -> Iterator[Finding]:
    """A name that has a robot's in it: the file was written for that robot."""
    names = [(key, key.value) for section in sections for key in section.keys]
    names += [(it.scalar, it.value) for uses in pages for it in uses.names if it.kind != "keep"]
    for scalar, value in names:
        found = desk.robots.intersection(value.strip("/").split("/"))
        for robot in sorted(found):
            message = f"{value} has the robot {robot} in it: the file is for that robot alone"
            hint = "take the robot out of every name: it is put there for each"
            yield finding(desk.document, scalar, "MF126", ERROR, message, hint)
            return


def unclaimed(desk: Desk, pages: Sequence[Uses]) -> Iterator[Finding]:
    """Names of the robot where nothing tells that they are names."""
    claimed = {it.value: it.kind for uses in pages for it in uses.names if _is_robots(desk, it)}
    declared = {
        name: kind
        for kind in ("link", "joint")
        for name in desk.context.names.declared.get(kind, ())
    }
    either = {**claimed, **declared}
    for uses in pages:
        found = [(it, either[it.value]) for it in uses.unclaimed if it.value in either]
        found += [(it, declared[it.value]) for it in uses.keys if it.value in declared]
        for scalar, kind in found:
            message = f"{scalar.value!r} is a {kind} of the robot, and nothing says what it is here"
            hint = "if it is a name, describe the parameter in a file of parameters"
            yield finding(desk.document, scalar, "MF123", WARNING, message, hint)


def _is_robots(desk: Desk, use: Use) -> bool:
    """A frame or an absolute topic that becomes the robot's; relative topics are common words."""
    if use.kind == "frame":
        return use.at < 0 and _text(desk.context, use) != use.value
    return use.kind == "topic" and use.value.startswith("/") and is_plain(use.value)
