# SPDX-License-Identifier: Apache-2.0
"""Read the entries of nodes: endpoints, frames, transforms, claims and parameters, all checked."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.nearest import unknown
from multibot_rewrite.base.rosnames import check_name_in_code, check_node_name
from multibot_rewrite.knowledge.conditions import CHOSEN, OPEN_KIND, words_in
from multibot_rewrite.knowledge.records import (
    Claim,
    Endpoint,
    FrameParameter,
    NodeFacts,
    NodeParameters,
    Param,
    SentTransform,
    made_of,
)
from multibot_rewrite.knowledge.yaml_with_lines import (
    FACT_KEYS,
    YamlItem,
    check_apart,
    checked_condition,
    condition_of,
    entries_of,
    flag_of,
    known_word,
    one_of,
    releases_of,
    source_of,
    table,
    table_of,
    text_and_words,
    variants,
    word,
    word_of,
    words_of,
    wrong,
)
from multibot_rewrite.system.records import ACTION, PUBLISHES, ROLES, SERVICE, SUBSCRIBES, TOPIC

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
        forms = [_read_param(path, it, absolute) for it in variants(item)]
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


def _read_param(path: str, item: YamlItem, absolute: str) -> Param:
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
    """Yield kinds of parameters, with the last words of paths that suggest them."""
    given = table_of(keys, "guesses")
    for kind, item in given.items():
        yield one_of(item, "kind", kind, KINDS), words_of(given, kind)


# A node with parameters and none of these is known by them alone: nobody says what it publishes.
GRAPH_KEYS = (*ROLES, "with", "host", "plugin", "claims", "frames", "sends", "ids")
GRAPH_WORDS = (
    "shared", "note", "when", "fixed", "apart", "programs", "component", "prefix_switch",
    "unmanaged",
)  # fmt: skip
CLAIM_KINDS = ("command", "state")
NODE_KEYS = ("package", *GRAPH_KEYS, *GRAPH_WORDS, *FACT_KEYS)


def read_node(
    name: str,
    item: YamlItem,
    keys: Mapping[str, YamlItem],
    parts: Mapping[str, tuple[Endpoint, ...]],
    params: Iterable[Param],
) -> NodeFacts:
    """Return the facts of an entry; raises UsageError with file and line."""
    check_name(item, name)
    frames = tuple(_frames(keys, params))
    sends = tuple(_sends(keys, frames))
    made = dict.fromkeys(end for it in sends for end in it[:2] if "<" in end)
    return NodeFacts(
        name,
        word_of(keys, "package"),
        (*endpoints_of(keys), *taken_over(keys, parts)),
        flag_of(keys, "shared"),
        word_of(keys, "note"),
        host=word_of(keys, "host"),
        when=condition_of(keys, "when"),
        frames=(*frames, *(FrameParameter(it, made_of(it, {})) for it in made)),
        fixed=words_of(keys, "fixed"),
        sends=sends,
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
    """Yield the parameters that hold frames, with defaults: ``frames``, then those of ``params``."""
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
    """Yield the transforms that a node publishes, by the parameters that hold or make their frames."""
    known = {frame.parameter: frame.parameter for frame in frames}
    each = (
        (parent, it) for parent, item in table_of(keys, "sends").items() for it in variants(item)
    )
    for parent, item in each:
        if parent not in known and "<" not in parent:
            wrong(item, unknown("frame", parent, known))
        if isinstance(item.value, str):
            child = item.value if "<" in item.value else known_word(item, "frame", known)
            yield SentTransform(parent, child)
            continue
        sent = table(item, f"sends {parent}", ("child", "if", "static"))
        if "child" not in sent:
            wrong(item, f"sends {parent} has no child; write {{child: ..., if: ...}}")
        child = word(sent["child"], "frame")
        child = child if "<" in child else known_word(sent["child"], "frame", known)
        yield SentTransform(parent, child, condition_of(sent), flag_of(sent, "static"))


def read_claims(keys: Mapping[str, YamlItem]) -> Iterator[Claim]:
    """Yield the interfaces under ``claims``: ``{command: TEMPLATE}`` or ``{state: TEMPLATE}``."""
    for item in entries_of(keys, "claims"):
        claim = table(item, "a claim", (*CLAIM_KINDS, "if", "releases"))
        kinds = [it for it in CLAIM_KINDS if it in claim]
        if len(kinds) != 1:
            wrong(item, "a claim is of one kind; write {command: ...} or {state: ...}")
        for template in words_of(claim, kinds[0]):
            yield Claim(kinds[0], template, condition_of(claim), releases_of(claim))


def taken_over(
    keys: Mapping[str, YamlItem], parts: Mapping[str, tuple[Endpoint, ...]]
) -> Iterator[Endpoint]:
    """Yield the endpoints of the parts under ``with``, and of the life cycle if ``unmanaged``."""
    for entry in entries_of(keys, "with"):
        yield from known_word(entry, "part", parts)
    if "unmanaged" in keys:
        releases = releases_of(keys, "unmanaged")
        yield from (it._replace(releases=releases) for it in parts.get("lifecycle", ()))


def check_name(item: YamlItem, name: str) -> None:
    """Raise UsageError for a name that no node can have."""
    for token in name.split("/"):
        fault = check_node_name(token)
        if fault:
            wrong(item, f"node name {name!r}: {fault.reason}")


ENDPOINT_WORDS = ("type", "parameter", "remapped", "when", "fixed", "note", "by", "beside")
ENDPOINT_OTHERS = ("also", "types", "transport", "helper", "if", "above")
ENDPOINT_KEYS = (*ENDPOINT_WORDS, *ENDPOINT_OTHERS, *FACT_KEYS)
_TYPE = lazy_compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Za-z][A-Za-z0-9_]*")
# Part of a name that is only known at run time.
_MADE = lazy_compile(r"<[^<>/]+>")
_GIVES = {"msg": "a topic", "srv": "a service", "action": "an action"}


def endpoints_of(keys: Mapping[str, YamlItem]) -> Iterator[Endpoint]:
    """Yield the endpoints of a node or part; raises UsageError at the first mistake."""
    for role in ROLES:
        for name, item in table_of(keys, role).items():
            found = [_read_endpoint(role, name, it) for it in variants(item)]
            check_apart(item, f"{role} {name!r}", [it.releases for it in found])
            yield from found


def _read_endpoint(role: str, name: str, item: YamlItem) -> Endpoint:
    if isinstance(item.value, str):
        return checked_endpoint(
            item, Endpoint(_kind_of_end(role, item.value), role, name, item.value)
        )
    keys = table(item, f"{role} {name!r}", ENDPOINT_KEYS)
    also = words_of(keys, "also")
    every, types = (word_of(keys, "type"), *also), []
    for condition, type_ in table_of(keys, "types").items():
        checked_condition(type_, condition)
        if type_.value not in every:
            wrong(type_, f"{type_.value!r} is neither the type nor in also ({', '.join(every)})")
        types.append((condition, str(type_.value)))
    endpoint = Endpoint(
        _kind_of_end(role, word_of(keys, "type")),
        role,
        name,
        **{key: word_of(keys, key) for key in keys.keys() & set(ENDPOINT_WORDS)},
        also=also,
        types=tuple(types),
        transport=flag_of(keys, "transport"),
        helper=flag_of(keys, "helper", "by" in keys),
        own=False,
        condition=condition_of(keys),
        above=releases_of(keys, "above"),
        releases=releases_of(keys),
        source=source_of(keys),
    )
    if CHOSEN in words_in(condition_of(keys, "when"), OPEN_KIND):
        wrong(keys["when"], f"{CHOSEN} is a word of nodes; an endpoint is there with its node")
    return checked_endpoint(item, endpoint)


def _kind_of_end(role: str, type_: str) -> str:
    if role in (PUBLISHES, SUBSCRIBES):
        return TOPIC
    return ACTION if "/action/" in type_ else SERVICE


def checked_endpoint(item: YamlItem, endpoint: Endpoint) -> Endpoint:
    """Return the endpoint if its name and types are valid; no rule renames one made at run time."""
    for name in filter(None, (endpoint.name, endpoint.remapped)):
        text = _MADE.sub("x", name) if "<" in name else name
        fault = check_name_in_code(text)
        if fault:
            wrong(item, f"name {name!r}: {fault.reason}")
    for type_ in filter(None, (endpoint.type, *endpoint.also)):
        found = _TYPE.fullmatch(type_)
        if not found:
            wrong(item, f"{type_!r} is not a ROS type; write it like std_msgs/msg/String")
        # The parts of an action have types like nav2_msgs/action/Spin_FeedbackMessage.
        if endpoint.kind == TOPIC and "/action/" in type_ and "_" in type_.rpartition("/")[2]:
            continue
        if found[1] != {TOPIC: "msg", SERVICE: "srv", ACTION: "action"}[endpoint.kind]:
            what = f"{type_} is the type of {_GIVES[found[1]]}"
            wrong(item, f"{endpoint.role} {endpoint.name!r}: {what}")
    if not _MADE.search(endpoint.name) or endpoint.fixed:
        return endpoint
    source = f"parameter {endpoint.parameter}" if endpoint.parameter else "its configuration"
    return endpoint._replace(fixed=f"the name is made at run time from {source}")
