# SPDX-License-Identifier: Apache-2.0
"""Endpoints of files of nodes: names and types are checked where they stand."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.rosnames import check_name_in_code
from multibot_rewrite.knowledge.conditions import CHOSEN, OPEN_KIND, words_in
from multibot_rewrite.knowledge.fact_words import (
    FACT_KEYS,
    check_apart,
    checked_condition,
    condition_of,
    releases_of,
    source_of,
    variants,
)
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.knowledge.yaml_with_lines import (
    YamlItem,
    flag_of,
    table,
    table_of,
    word_of,
    words_of,
    wrong,
)
from multibot_rewrite.system.records import ACTION, PUBLISHES, ROLES, SERVICE, SUBSCRIBES, TOPIC

ENDPOINT_WORDS = ("type", "parameter", "remapped", "when", "fixed", "note", "by", "beside")
ENDPOINT_OTHERS = ("also", "types", "transport", "helper", "if", "above")
ENDPOINT_KEYS = (*ENDPOINT_WORDS, *ENDPOINT_OTHERS, *FACT_KEYS)
_TYPE = lazy_compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Za-z][A-Za-z0-9_]*")
# Part of a name that is only known at run time.
_MADE = lazy_compile(r"<[^<>/]+>")
_GIVES = {"msg": "a topic", "srv": "a service", "action": "an action"}


def endpoints_of(keys: Mapping[str, YamlItem]) -> Iterator[Endpoint]:
    """The endpoints of a node or part; raises UsageError at the first mistake."""
    for role in ROLES:
        for name, item in table_of(keys, role).items():
            found = [_endpoint(role, name, it) for it in variants(item)]
            check_apart(item, f"{role} {name!r}", [it.releases for it in found])
            yield from found


def _endpoint(role: str, name: str, item: YamlItem) -> Endpoint:
    if isinstance(item.value, str):
        return checked_endpoint(item, Endpoint(_kind(role, item.value), role, name, item.value))
    keys = table(item, f"{role} {name!r}", ENDPOINT_KEYS)
    also = words_of(keys, "also")
    endpoint = Endpoint(_kind(role, word_of(keys, "type")), role, name)._replace(
        **{key: word_of(keys, key) for key in keys.keys() & set(ENDPOINT_WORDS)},
        also=also,
        types=tuple(_types(keys, (word_of(keys, "type"), *also))),
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


def _types(keys: Mapping[str, YamlItem], every: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Conditions with the type of each, which is one of ``every``."""
    for condition, item in table_of(keys, "types").items():
        checked_condition(item, condition)
        if item.value not in every:
            wrong(item, f"{item.value!r} is neither the type nor in also ({', '.join(every)})")
        yield condition, str(item.value)


def _kind(role: str, type_: str) -> str:
    if role in (PUBLISHES, SUBSCRIBES):
        return TOPIC
    return ACTION if "/action/" in type_ else SERVICE


def checked_endpoint(item: YamlItem, endpoint: Endpoint) -> Endpoint:
    """The endpoint, if its name and types are valid; no rule reaches a name made at run time."""
    for name in filter(None, (endpoint.name, endpoint.remapped)):
        text = _MADE.sub("x", name) if "<" in name else name
        fault = check_name_in_code(text)
        if fault:
            wrong(item, f"name {name!r}: {fault.reason}")
    for type_ in filter(None, (endpoint.type, *endpoint.also)):
        _check_type(item, endpoint, type_)
    if endpoint.beside:
        other = f"it is derived from the name that {endpoint.beside} is remapped to"
        return endpoint._replace(fixed=other)
    if not _MADE.search(endpoint.name) or endpoint.fixed:
        return endpoint
    source = f"parameter {endpoint.parameter}" if endpoint.parameter else "its configuration"
    return endpoint._replace(fixed=f"the name is made at run time from {source}")


def _check_type(item: YamlItem, endpoint: Endpoint, type_: str) -> None:
    found = _TYPE.fullmatch(type_)
    if not found:
        wrong(item, f"{type_!r} is not a ROS type; write it like std_msgs/msg/String")
    # The parts of an action have types like nav2_msgs/action/Spin_FeedbackMessage.
    if endpoint.kind == TOPIC and "/action/" in type_ and "_" in type_.rpartition("/")[2]:
        return
    if found[1] != {TOPIC: "msg", SERVICE: "srv", ACTION: "action"}[endpoint.kind]:
        wrong(item, f"{endpoint.role} {endpoint.name!r}: {type_} is the type of {_GIVES[found[1]]}")
