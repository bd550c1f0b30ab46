# SPDX-License-Identifier: Apache-2.0
"""Entries of nodes -> what is known of their endpoints, frames, transforms and claims."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.rosnames import check_node_name
from multibot_rewrite.knowledge.endpoint_entries import endpoints_of
from multibot_rewrite.knowledge.fact_words import (
    FACT_KEYS,
    check_apart,
    condition_of,
    releases_of,
    source_of,
    text_and_words,
    variants,
)
from multibot_rewrite.knowledge.parameter_entries import has_default
from multibot_rewrite.knowledge.records import (
    Claim,
    Endpoint,
    FrameParameter,
    NodeFacts,
    Param,
    SentTransform,
)
from multibot_rewrite.knowledge.yaml_with_lines import (
    YamlItem,
    entries_of,
    flag_of,
    known_word,
    table,
    table_of,
    unknown,
    word,
    word_of,
    words_of,
    wrong,
)
from multibot_rewrite.system.records import ROLES

# A node with parameters and none of these is known by them alone: nobody says what it publishes.
GRAPH_KEYS = (*ROLES, "with", "host", "plugin", "claims", "frames", "sends", "ids")
GRAPH_WORDS = (
    "shared",
    "note",
    "when",
    "fixed",
    "apart",
    "programs",
    "component",
    "prefix_switch",
    "unmanaged",
)
SENT_KEYS = ("child", "if")
_LIFE_CYCLE = "lifecycle"
CLAIM_KINDS = ("command", "state")
CLAIM_KEYS = (*CLAIM_KINDS, "if", "releases")
NODE_KEYS = ("package", *GRAPH_KEYS, *GRAPH_WORDS, *FACT_KEYS)


def read_node(
    name: str,
    item: YamlItem,
    keys: Mapping[str, YamlItem],
    parts: Mapping[str, tuple[Endpoint, ...]],
    params: Iterable[Param],
) -> NodeFacts:
    """The facts of an entry; raises UsageError with file and line."""
    check_name(item, name)
    frames = tuple(_frames(keys, params))
    return NodeFacts(
        name,
        word_of(keys, "package"),
        (*endpoints_of(keys), *taken_over(keys, parts)),
        flag_of(keys, "shared"),
        word_of(keys, "note"),
        host=word_of(keys, "host"),
        when=condition_of(keys, "when"),
        frames=frames,
        fixed=words_of(keys, "fixed"),
        sends=tuple(_sends(keys, frames)),
        claims=tuple(read_claims(keys)),
        programs=words_of(keys, "programs"),
        component=word_of(keys, "component"),
        ids=tuple((name, word(it, f"ids {name}")) for name, it in table_of(keys, "ids").items()),
        releases=releases_of(keys),
        source=source_of(keys),
        plugin=word_of(keys, "plugin"),
        apart=flag_of(keys, "apart"),
        prefix_switch=word_of(keys, "prefix_switch"),
        unmanaged=releases_of(keys, "unmanaged"),
    )


def _frames(keys: Mapping[str, YamlItem], params: Iterable[Param]) -> Iterator[FrameParameter]:
    """The parameters that hold frames, with their defaults: those under ``params``, where ``frames``
    says nothing else of them."""
    said = table_of(keys, "frames")
    own = (it for it in params if it.kind == "frame" and it.path not in said and has_default(it))
    yield from (FrameParameter(it.path, it.default, it.releases, it.source) for it in own)
    for name, item in said.items():
        found = []
        for it in variants(item):
            words = text_and_words(it, f"frame {name}", "default")
            default = word_of(words, "default")
            found.append(FrameParameter(name, default, releases_of(words), source_of(words)))
        check_apart(item, f"frame {name}", [it.releases for it in found])
        yield from found


def _sends(
    keys: Mapping[str, YamlItem], frames: Iterable[FrameParameter]
) -> Iterator[SentTransform]:
    """The transforms that a node publishes, as the parameters that hold their frames."""
    known = {frame.parameter: frame.parameter for frame in frames}
    each = (
        (parent, it) for parent, item in table_of(keys, "sends").items() for it in variants(item)
    )
    for parent, item in each:
        if parent not in known:
            wrong(item, unknown("frame", parent, known))
        if isinstance(item.value, str):
            yield SentTransform(parent, known_word(item, "frame", known))
            continue
        sent = table(item, f"sends {parent}", SENT_KEYS)
        if "child" not in sent:
            wrong(item, f"sends {parent} has no child; write {{child: ..., if: ...}}")
        child = known_word(sent["child"], "frame", known)
        yield SentTransform(parent, child, condition_of(sent))


def read_claims(keys: Mapping[str, YamlItem]) -> Iterator[Claim]:
    """The interfaces under ``claims``: ``{command: TEMPLATE}`` or ``{state: TEMPLATE}``."""
    for item in entries_of(keys, "claims"):
        claim = table(item, "a claim", CLAIM_KEYS)
        kinds = [it for it in CLAIM_KINDS if it in claim]
        if len(kinds) != 1:
            wrong(item, "a claim is of one kind; write {command: ...} or {state: ...}")
        for template in words_of(claim, kinds[0]):
            yield Claim(kinds[0], template, condition_of(claim), releases_of(claim))


def taken_over(
    keys: Mapping[str, YamlItem], parts: Mapping[str, tuple[Endpoint, ...]]
) -> Iterator[Endpoint]:
    """The endpoints of the parts that an entry names under ``with``, and those of the life cycle in
    the releases of ``unmanaged``."""
    for entry in entries_of(keys, "with"):
        yield from known_word(entry, "part", parts)
    if "unmanaged" in keys:
        releases = releases_of(keys, "unmanaged")
        yield from (it._replace(releases=releases) for it in parts.get(_LIFE_CYCLE, ()))


def check_name(item: YamlItem, name: str) -> None:
    """Raise UsageError where a node cannot be called so."""
    for token in name.split("/"):
        fault = check_node_name(token)
        if fault:
            wrong(item, f"node name {name!r}: {fault.reason}")
