"""A known node and the parameters that it gets -> the node as it runs with them.

Endpoints whose name a parameter sets get that name, conditions are decided, frames get their values.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain

from multibot_rewrite.evidence.records import Given, GivenNode
from multibot_rewrite.remap.conditions import Values, holds
from multibot_rewrite.remap.records import Endpoint, FrameParameter, NodeFacts, SentTransform
from multibot_rewrite.rosnames import check_topic_name

_ID = re.compile(r"<([a-z_ ]+)>")
# What stands for a number in the name of a parameter: odomN is odom0, odom1 and so on.
_NUMBER = "N"
Ids = Mapping[str, str]


def filled(node: NodeFacts, given: GivenNode) -> NodeFacts:
    """``node`` with the names that its parameters set, under the name that it has there."""
    values = given.values
    endpoints = chain.from_iterable(_endpoint(node, it, values) for it in node.endpoints)
    frames = tuple(_frame(it, values) for it in node.frames)
    with_frames = node._replace(frames=frames)
    return with_frames._replace(
        name=given.name,
        endpoints=tuple(dict.fromkeys(endpoints)),
        sends=tuple(_sent(with_frames, values)),
        origin=str(given.place),
    )


def _sent(node: NodeFacts, values: Mapping[str, Given]) -> Iterator[SentTransform]:
    """The transforms that it sends with these parameters."""
    value_of = _lookup(node, values)
    yield from (it._replace(condition="") for it in node.sends if holds(it.condition, value_of))


def _lookup(node: NodeFacts, values: Mapping[str, Given]) -> Values:
    defaults = {it.parameter: it.default for it in node.frames}
    return lambda name: values[name].value if name in values else defaults.get(name)


def _frame(frame: FrameParameter, values: Mapping[str, Given]) -> FrameParameter:
    given = values.get(frame.parameter)
    if given is None or given.value == "":
        return frame
    return frame._replace(default=str(given.value), given=True)


def _endpoint(
    node: NodeFacts, endpoint: Endpoint, values: Mapping[str, Given]
) -> Iterator[Endpoint]:
    """The endpoint once for each binding of its ids, with the names that are set."""
    named = (endpoint.name, endpoint.parameter, endpoint.condition)
    ids = dict.fromkeys(it for text in named for it in _ID.findall(text))
    wanted = [it for it in ids if it in dict(node.ids)]
    for binding in _bindings(dict(node.ids), wanted, values):
        bound = _bound(endpoint, binding)
        if holds(bound.condition, _lookup(node, values)):
            yield from _named(bound, values)


def _bindings(
    ids: Mapping[str, str], wanted: Iterable[str], values: Mapping[str, Given]
) -> Iterator[Ids]:
    """Every choice of the wanted ids; a list may depend on another id (``<layer>.sources``)."""
    found: list[dict[str, str]] = [{}]
    for name in _in_order(ids, wanted):
        found = [
            {**binding, name: word}
            for binding in found
            for word in _words(values.get(_put(ids[name], binding)))
        ]
    yield from found


def _in_order(ids: Mapping[str, str], wanted: Iterable[str]) -> list[str]:
    """The wanted ids and those that their lists need, the needed ones first."""
    order: list[str] = []
    for name in wanted:
        needed = [it for it in _ID.findall(ids[name]) if it in ids]
        order += [it for it in (*_in_order(ids, needed), name) if it not in order]
    return order


def _words(given: Given | None) -> list[str]:
    """The items of a list; a text is a list of its words."""
    if given is None:
        return []
    value = given.value
    return [str(it) for it in value] if isinstance(value, list) else str(value).split()


def _put(text: str, binding: Ids) -> str:
    return _ID.sub(lambda found: binding.get(found[1], found[0]), text)


def _bound(endpoint: Endpoint, binding: Ids) -> Endpoint:
    if not binding:
        return endpoint
    return endpoint._replace(
        name=_put(endpoint.name, binding),
        parameter=_put(endpoint.parameter, binding),
        condition=_put(endpoint.condition, binding),
    )


def _named(endpoint: Endpoint, values: Mapping[str, Given]) -> Iterator[Endpoint]:
    """The endpoint under the names that its parameter sets; under its own where none is set."""
    decided = "" if endpoint.condition else endpoint.when
    names = list(_set_names(endpoint.parameter, values)) if endpoint.parameter else []
    for name in names:
        if name and not check_topic_name(name):
            yield endpoint._replace(name=name, fixed="", when="", condition="")
    if not names and "<" not in endpoint.name:
        fixed = endpoint.fixed if endpoint.fixed and not endpoint.parameter else ""
        yield endpoint._replace(when=decided, condition="", fixed=fixed)


def _set_names(parameter: str, values: Mapping[str, Given]) -> Iterator[str]:
    """The names in a parameter: of all that match where it is a pattern, of a list each."""
    pattern = _pattern(parameter)
    for name, given in values.items():
        if pattern.fullmatch(name):
            yield from _words(given) if isinstance(given.value, list) else (str(given.value),)


def _pattern(parameter: str) -> re.Pattern[str]:
    text = re.escape(parameter).replace(r"\*", r"[^.]+")
    if parameter.endswith(_NUMBER) and parameter[:-1].islower():
        text = rf"{text[: -len(_NUMBER)]}\d+"
    return re.compile(re.sub(r"<[^<>]+>", r"[^.]+", text))
