# SPDX-License-Identifier: Apache-2.0
"""Entries of nodes -> their parameters: which of them hold names, of what kind, and their defaults."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from multibot_rewrite.knowledge.records import NodeParameters, Param
from multibot_rewrite.knowledge.yaml_with_lines import (
    FACT_KEYS,
    YamlItem,
    check_apart,
    flag_of,
    one_of,
    releases_of,
    source_of,
    table,
    table_of,
    variants,
    word,
    word_of,
    words_of,
    wrong,
)

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
# What one node has for itself: no other one can have its port, write its file, or be told the same.
PORT = "port"
OWN_KINDS = (PORT, "output", "exclusive")
KINDS = (*NAME_KINDS, *GRAPH_NAME_KINDS, *OTHER_KINDS, *SWITCH_KINDS, *OWN_KINDS, "keep")
# Placeholders for a segment of a path; an id holds no name of a robot.
SEGMENTS = ("joint", "sensor", "gpio", "frame", "interface", "controller", "group", "id")
PARAMETER_KEYS = (
    *("aliases", "types", "deprecated_types", "known_by", "absolute", "strips", "params"),
    "declared_in",
)
PARAM_KEYS = ("kind", "default", "absolute", "deprecated", "own", "instead", "note", *FACT_KEYS)


def read_parameters(
    name: str, keys: Mapping[str, YamlItem], old: NodeParameters | None
) -> NodeParameters:
    """Return an entry's parameters, added to what is known of the node; raises UsageError."""
    if old is None:
        old = NodeParameters(name.rpartition("/")[2], "")
    absolute = releases_of(keys, "absolute")
    # Every form of each parameter, those of one path behind another.
    given: list[Param] = []
    for path, item in table_of(keys, "params").items():
        for segment in path.split("."):
            if not segment:
                hint = "separate names by single dots"
                wrong(item, f"parameter {path!r} has an empty segment; {hint}")
            if segment.startswith("<"):
                one_of(item, "segment", segment[1:-1], SEGMENTS)
        forms = [_param(path, it, absolute) for it in variants(item)]
        check_apart(item, f"parameter {path!r}", [it.releases for it in forms])
        given += forms
    said = {it.path for it in given}
    deprecated = table_of(keys, "deprecated_types")
    return NodeParameters(
        old.name,
        word_of(keys, "package", old.package),
        (*(it for it in old.forms if it.path not in said), *given),
        (*old.aliases, *words_of(keys, "aliases")),
        (*old.types, *words_of(keys, "types")),
        words_of(keys, "known_by") or old.known_by,
        releases_of(keys) or old.releases,
        source_of(keys) or old.source,
        releases_of(keys, "strips") or old.strips,
        {**old.deprecated_types, **{type_: releases_of(deprecated, type_) for type_ in deprecated}},
        (*old.declared_in, *words_of(keys, "declared_in")),
    )


def has_default(param: Param) -> bool:
    """Return whether the parameter has a default, and a path without placeholders."""
    return bool(param.default or param.kind in PREFIX_KINDS) and "<" not in param.path


def _param(path: str, item: YamlItem, absolute: str) -> Param:
    if isinstance(item.value, str):
        kind = one_of(item, "kind", item.value, KINDS)
        return Param(path, kind, absolute=absolute if kind == "topic" else "")
    keys = table(item, f"parameter {path!r}", PARAM_KEYS)
    if "kind" not in keys:
        wrong(item, f"parameter {path!r} has no kind; add kind: with one of {', '.join(KINDS)}")
    kind = one_of(keys["kind"], "kind", word(keys["kind"], "kind"), KINDS)
    return Param(
        path,
        kind,
        word_of(keys, "default"),
        releases_of(keys),
        releases_of(keys, "absolute") or (absolute if kind == "topic" else ""),
        word_of(keys, "note"),
        source_of(keys),
        releases_of(keys, "deprecated"),
        flag_of(keys, "own"),
        words_of(keys, "instead"),
    )


def read_guesses(keys: Mapping[str, YamlItem]) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield kinds with the last words of paths that suggest them."""
    given = table_of(keys, "guesses")
    for kind, item in given.items():
        yield one_of(item, "kind", kind, KINDS), words_of(given, kind)
