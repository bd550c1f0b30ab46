"""Known nodes and their parameters: which of them hold names, of what kind, and their defaults.

Read from ``params.yaml`` and files of the same shape.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from importlib.resources import files

from multibot_rewrite.bounded import read_text
from multibot_rewrite.knowledge.fact_words import (
    FACT_KEYS,
    check_apart,
    releases_of,
    source_of,
    variants,
)
from multibot_rewrite.knowledge.yaml_with_lines import (
    YamlItem,
    flag_of,
    read_yaml_with_lines,
    table,
    table_of,
    unknown,
    word,
    word_of,
    words_of,
    wrong,
)
from multibot_rewrite.model import UsageError
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.releases import has_release
from multibot_rewrite.system.conventions import SENT_FRAMES

NAME_KINDS = (
    *("frame", "link", "joint", "sensor", "gpio", "component"),
    *("hardware", "group", "interface"),
)
GRAPH_NAME_KINDS = ("topic", "service", "node", "controller", "namespace")
# Put before names by the node; an empty one is a default.
PREFIX_KINDS = ("joint_prefix", "gpio_prefix", "joint_stem")
# Put before frames by the node; what it puts behind them.
RUN_TIME = {"doubles": "", "doubles_as_is": "/"}
OTHER_KINDS = ("stem", "link_prefix", *PREFIX_KINDS, "words", "text", "pattern", *RUN_TIME)
SWITCH_KINDS = ("off", "no_prefix")
KINDS = (*NAME_KINDS, *GRAPH_NAME_KINDS, *OTHER_KINDS, *SWITCH_KINDS, "exclusive", "keep")
# Placeholders for a segment of a path; an id holds no name of a robot.
SEGMENTS = ("joint", "sensor", "gpio", "frame", "interface", "controller", "group", "id")
NODE_WORDS = (
    "package",
    "aliases",
    "types",
    "deprecated_types",
    "known_by",
    "absolute",
    "strips",
    "note",
    "params",
)
NODE_KEYS = (*NODE_WORDS, *FACT_KEYS)
PARAM_KEYS = ("kind", "default", "list", "absolute", "deprecated", "own", "note", *FACT_KEYS)
# Undeclared names of these kinds stay as they are, so a wrong guess does no harm.
SAFE_KINDS = ("link", "joint")
_INDEX = "<index>"
NO_TYPES: Mapping[str, str] = {}


class Param(NamedTuple):
    """A parameter by its dotted path: what its value is, and its default.

    ``releases`` are release words (``multibot_rewrite.releases``), ``absolute`` those in which a
    relative topic in it is not resolved in the robot's namespace, ``deprecated`` those that warn of
    it, both empty for none; ``source`` are the places where it can be read. ``own`` is true for a
    frame that the node itself makes, so no description has it.
    """

    path: str
    kind: str
    default: str = ""
    is_list: bool = False
    releases: str = ""
    absolute: str = ""
    note: str = ""
    source: tuple[str, ...] = ()
    deprecated: str = ""
    own: bool = False


class Branch(NamedTuple):
    """Paths by their next segment: ``exact``, ``numbered`` (a stem with digits), ``wild`` (what the
    segment is, if any word is allowed); ``params`` are those whose path ends here."""

    exact: dict[str, Branch]
    numbered: dict[str, Branch]
    wild: dict[str, Branch]
    params: list[Param]


class KnownNode(NamedTuple):
    """A node's parameters; ``types`` are controller types, ``known_by`` parameters that identify the
    node if its section has another name, ``defaults`` parameters that hold one name by default in the
    release that was asked for. What a release lacks is known all the same: where a file sets it, it
    is for a release that has it. ``strips`` are the releases in which the node takes off a
    slash that a frame starts with, empty for none; ``deprecated_types`` has those of types."""

    name: str
    package: str
    params: Mapping[str, Param]
    aliases: tuple[str, ...]
    types: tuple[str, ...]
    known_by: tuple[str, ...]
    note: str
    tree: Branch
    defaults: tuple[Param, ...]
    releases: str = ""
    source: tuple[str, ...] = ()
    strips: str = ""
    deprecated_types: Mapping[str, str] = NO_TYPES


class KnownNodes(NamedTuple):
    """All known nodes; ``names`` and ``types`` lead to them. ``anywhere`` holds what is the same in
    every node that has it, ``guesses`` last words of other paths (``guessing`` as one expression),
    ``sent`` frames that nodes send.
    """

    nodes: Mapping[str, KnownNode]
    names: Mapping[str, str]
    types: Mapping[str, str]
    anywhere: Branch
    guesses: Mapping[str, tuple[str, ...]]
    guessing: re.Pattern[str]
    sent: frozenset[str]


@lru_cache
def built_in_nodes(release: str) -> KnownNodes:
    """The nodes that this package knows, with the defaults of a release."""
    text = (
        files("multibot_rewrite.companions.params")
        .joinpath("params.yaml")
        .read_text(encoding="utf-8")
    )
    return _known({}, {}, frozenset(SENT_FRAMES), text, "params.yaml", release)


def load_known_nodes(path: str, release: str) -> KnownNodes:
    """The built-in nodes, and those that a file of the same shape adds or changes.

    Raises UsageError, with file and line, for whatever is wrong in it.
    """
    if not path:
        return built_in_nodes(release)
    try:
        text = read_text(path)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise UsageError(f"{path}: cannot be read: it is not UTF-8; save it as UTF-8") from None
    base = built_in_nodes(release)
    return _known(base.nodes, base.guesses, base.sent, text, path, release)


def is_absolute(param: Param, release: str) -> bool:
    """Is a relative topic in it outside of the robot's namespace in this release?"""
    return bool(param.absolute) and has_release(param.absolute, release)


def guess(known: KnownNodes, path: str) -> str:
    """The kind that the last word of a path suggests; empty for none."""
    found = known.guessing.fullmatch(path, path.rfind(".") + 1)
    return (found.lastgroup or "") if found else ""


def _guessing(guesses: Mapping[str, tuple[str, ...]]) -> re.Pattern[str]:
    """One expression for all guesses, with a group for each kind."""
    every = {
        kind: "|".join(re.escape(it).replace(r"\*", ".*") for it in words)
        for kind, words in guesses.items()
    }
    return re.compile("|".join(f"(?P<{kind}>{words})" for kind, words in every.items()))


def _known(
    nodes: Mapping[str, KnownNode],
    guesses: Mapping[str, tuple[str, ...]],
    sent: frozenset[str],
    text: str,
    file: str,
    release: str,
) -> KnownNodes:
    top = table(read_yaml_with_lines(text, file), "the file", ("sent", "guesses", "nodes"))
    given = table_of(top, "guesses")
    for key, item in given.items():
        _one_of(item, "kind", key, KINDS)
    guesses = {**guesses, **{key: words_of(given, key) for key in given}}
    nodes = dict(nodes)
    for name, item in table_of(top, "nodes").items():
        nodes[name] = _node(name, item, nodes.get(name), release)
    names = {alias: it.name for it in nodes.values() for alias in (*it.aliases, it.name)}
    types = {type_: it.name for it in nodes.values() for type_ in it.types}
    names |= {name: name for name in nodes}
    sent |= frozenset(words_of(top, "sent"))
    guessing = _guessing(guesses)
    return KnownNodes(
        nodes, names, types, _tree(_anywhere(nodes, guessing)), guesses, guessing, sent
    )


def _node(name: str, item: YamlItem, old: KnownNode | None, release: str) -> KnownNode:
    """A node as a file describes it; of a known node, what the file adds."""
    keys = table(item, f"node {name!r}", NODE_KEYS)
    absolute = releases_of(keys, "absolute")
    releases = releases_of(keys) or (old.releases if old else "")
    params = dict(old.params) if old else {}
    for path, entry in table_of(keys, "params").items():
        params[path] = _param_in(path, entry, absolute, release)
    here = has_release(releases, release)
    there = [it for it in params.values() if here and has_release(it.releases, release)]
    return KnownNode(
        name,
        word_of(keys, "package", old.package if old else ""),
        params,
        (*(old.aliases if old else ()), *words_of(keys, "aliases")),
        (*(old.types if old else ()), *words_of(keys, "types")),
        words_of(keys, "known_by") or (old.known_by if old else ()),
        word_of(keys, "note", old.note if old else ""),
        _tree(params.values()),
        tuple(it for it in there if has_default(it)),
        releases,
        source_of(keys) or (old.source if old else ()),
        releases_of(keys, "strips") or (old.strips if old else ""),
        {**(old.deprecated_types if old else {}), **_deprecated_types(keys)},
    )


def _deprecated_types(keys: Mapping[str, YamlItem]) -> dict[str, str]:
    given = table_of(keys, "deprecated_types")
    return {type_: releases_of(given, type_) for type_ in given}


def has_default(param: Param) -> bool:
    """Does the parameter have a default, and a path without placeholders?"""
    return bool(param.default or param.kind in PREFIX_KINDS) and "<" not in param.path


def _param_in(path: str, item: YamlItem, absolute: str, release: str) -> Param:
    """What a parameter is in a release; where that lacks it, what it is in the last that had it."""
    _check_path(path, item)
    found = [_param(path, it, absolute) for it in variants(item)]
    check_apart(item, f"parameter {path!r}", [it.releases for it in found])
    return next((it for it in found if has_release(it.releases, release)), found[-1])


def _param(path: str, item: YamlItem, absolute: str) -> Param:
    if isinstance(item.value, str):
        kind = _one_of(item, "kind", item.value, KINDS)
        return Param(path, kind, absolute=absolute if kind == "topic" else "")
    keys = table(item, f"parameter {path!r}", PARAM_KEYS)
    if "kind" not in keys:
        wrong(item, f"parameter {path!r} has no kind; add kind: with one of {', '.join(KINDS)}")
    kind = _one_of(keys["kind"], "kind", word(keys["kind"], "kind"), KINDS)
    return Param(
        path,
        kind,
        word_of(keys, "default"),
        flag_of(keys, "list"),
        releases_of(keys),
        releases_of(keys, "absolute") or (absolute if kind == "topic" else ""),
        word_of(keys, "note"),
        source_of(keys),
        releases_of(keys, "deprecated"),
        flag_of(keys, "own"),
    )


def _check_path(path: str, item: YamlItem) -> None:
    for segment in path.split("."):
        if not segment:
            wrong(
                item,
                f"parameter {path!r} has an empty segment; separate names by single dots",
            )
        if segment.startswith("<"):
            _one_of(item, "segment", segment[1:-1], SEGMENTS)


def _one_of(item: YamlItem, what: str, value: str, allowed: tuple[str, ...]) -> str:
    if value not in allowed:
        wrong(item, unknown(what, value, allowed))
    return value


def _anywhere(nodes: Mapping[str, KnownNode], guessing: re.Pattern[str]) -> Iterator[Param]:
    """Parameters that likely mean the same in an unknown node: several nodes have them with one
    meaning, or their name suggests it."""
    found: dict[str, list[Param]] = {}
    for node in nodes.values():
        for param in node.params.values():
            if "*" not in param.path and "<" not in param.path.replace(_INDEX, ""):
                found.setdefault(param.path, []).append(param)
    for path, params in found.items():
        kind = params[0].kind
        sure = len(params) > 1 or kind in SAFE_KINDS or path.endswith(_INDEX)
        guessed = guessing.fullmatch(path.rpartition(".")[2])
        # What is [position] in a known controller may be [elbow/position] in another one.
        if kind == "keep" and guessed and guessed.lastgroup == "interface":
            continue
        if (
            kind != "exclusive"
            and len({it.kind for it in params}) == 1
            and (sure or (guessed and guessed.lastgroup == kind))
        ):
            yield params[0]._replace(default="", absolute="")


def _tree(params: Iterable[Param]) -> Branch:
    root = Branch({}, {}, {}, [])
    for param in params:
        branch = root
        for segment in param.path.split("."):
            branch = _below(branch, segment)
        branch.params.append(param)
    return root


def _below(branch: Branch, segment: str) -> Branch:
    if segment.endswith(_INDEX):
        where, key = branch.numbered, segment.removesuffix(_INDEX)
    elif segment == "*" or segment.startswith("<"):
        where, key = branch.wild, segment.strip("<>")
    else:
        where, key = branch.exact, segment
    return where.setdefault(key, Branch({}, {}, {}, []))
