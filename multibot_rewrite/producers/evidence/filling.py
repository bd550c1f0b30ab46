# SPDX-License-Identifier: Apache-2.0
"""A known node and the parameters that it gets -> the node as it runs with them.

Endpoints whose name a parameter sets get that name, conditions are decided, frames get their values.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache

from multibot_rewrite.base.lazy import with_gaps
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.rosnames import check_name_in_code
from multibot_rewrite.knowledge.conditions import ALSO, Values, chosen_type, holds, verdict
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts, SentTransform, made_of
from multibot_rewrite.planning.records import Given, Run
from multibot_rewrite.system.records import Origin

_ID = re.compile(r"<([a-z_ ]+)>")
# What stands for a number in the name of a parameter: odomN is odom0, odom1 and so on.
_NUMBER = "N"
_GAP = re.compile(r"\*|<[^<>]+>")
# A type that a list has behind the name is called list/msg/Type and so on.
OF_LIST = "list/"
_TYPE = re.compile(r"/(?:msg|srv|action)/")
Ids = Mapping[str, str]


def filled(node: NodeFacts, given: Run, known: NodeFacts | None = None) -> NodeFacts:
    """Return ``node`` with the names that its parameters set, under the name that it has there.

    ``known`` is the node without what a node set changes: names of the node set remain unless
    parameters say more. Raises InputError for a word of a list that makes no valid name."""
    values, value_of = given.values, lookup(node, given.values)
    whole = known or node
    of_set: dict[tuple[str, str], list[Endpoint]]
    of_set = {(it.role, it.name): [] for it in whole.endpoints}
    alone: list[Endpoint] = []  # those of a part that the node set adds
    for it in node.endpoints:
        of_set.get((it.role, it.named_from or it.name), alone).append(it)
    each = ((it, of_set[it.role, it.name]) for it in whole.endpoints)
    made = [it for raw, own in each for it in _endpoint(node, raw, own, values, value_of)] + alone
    frames = []
    texts = {name: str(it.value) for name, it in values.items()}
    for frame in node.frames:
        told = values.get(frame.parameter)
        # <pose_name> stands for the value of another parameter.
        text = frame.parameter if "<" in frame.parameter else frame.default
        other = made_of(text, texts) if "<" in text else frame.default
        if told is not None and told.value != "":
            frame_set = frame._replace(default=str(told.value), given=True, is_kept=False)
        elif other != frame.default:
            frame_set = frame._replace(default=other, given=True)
        else:
            frame_set = frame
        frames.append(frame_set)
    with_frames = node._replace(frames=tuple(frames))
    return with_frames._replace(
        name=given.node,
        endpoints=tuple(dict.fromkeys(made)),
        sends=tuple(sent_with(with_frames, values)),
        origin=Origin(place=given.place),
        untold=tuple(it for it in node.untold if it.parameter not in values),
    )


def sent_with(node: NodeFacts, values: Mapping[str, Given]) -> Iterator[SentTransform]:
    """Yield the transforms that a node sends with these parameters."""
    value_of = lookup(node, values)
    yield from (it._replace(condition="") for it in node.sends if holds(it.condition, value_of))


def lookup(node: NodeFacts, values: Mapping[str, Given]) -> Values:
    """Return a function that finds the value of a parameter, or the default that names a frame."""
    defaults = {it.parameter: it.default for it in node.frames}
    return lambda name: values[name].value if name in values else defaults.get(name)


def _endpoint(
    node: NodeFacts,
    raw: Endpoint,
    own: Iterable[Endpoint],
    values: Mapping[str, Given],
    value_of: Values,
) -> Iterator[Endpoint]:
    """Yield an endpoint under the names that are set, once for each binding of its ids."""
    is_made = "<" in raw.name or "*" in raw.name
    if not (raw.parameter or raw.condition or raw.when or is_made):
        yield from (_with_chosen_type(it, value_of) if it.types else it for it in own)
        return
    ids = dict(node.ids)
    wanted = _ids_in(ids, raw.name, raw.parameter, raw.condition)
    asked = _ids_in(ids, raw.when)
    # What its name has decides how it is called; what only its condition asks may be unknown.
    if _are_listed([ids[it] for it in asked], values):
        wanted = [*dict.fromkeys((*wanted, *asked))]
    is_there = verdict(raw.when, value_of) if raw.when and not wanted else None
    if is_there is False:
        return
    of_set = [_sure_if(it, is_there) for it in own]
    remapped = next((it.remapped for it in of_set), "")
    if not _is_decided(raw, [ids[it] for it in wanted], values, of_set):
        yield from (_with_chosen_type(it, value_of) for it in of_set)
        return
    for binding in _bindings(ids, wanted, values):
        bound = _with_bound_ids(raw._replace(remapped=remapped), binding)
        is_bound = verdict(bound.when, value_of) if bound.when and binding else is_there
        if is_bound is not False and holds(bound.condition, value_of):
            decided = is_bound if bound.when else bool(binding or bound.condition)
            typed = _with_chosen_type(_sure_if(bound, decided), value_of)
            words = [it for it in _ID.findall(raw.name) if it in ids]
            listed = values.get(_with_ids(ids[words[-1]], binding)) if words else None
            if listed and isinstance(listed.value, list) and typed.type.startswith(OF_LIST):
                # The type stands behind its word in a list of names and types.
                items = [str(it) for it in listed.value]
                behind = items[items.index(binding[words[-1]]) + 1 :][:1]
                typed = typed._replace(type=next(filter(_TYPE.search, behind), ""))
            for it in _named(typed, values, _ending(node, raw)):
                yield _checked(it, listed)


def _sure_if(endpoint: Endpoint, is_there: bool | None) -> Endpoint:
    """Return an endpoint, without its condition if the condition holds."""
    return endpoint._replace(when="") if is_there else endpoint


def _checked(endpoint: Endpoint, listed: Given | None) -> Endpoint:
    """Return the endpoint; raises InputError if a word of a list makes a name that rcl rejects."""
    fault = check_name_in_code(endpoint.name) if listed else None
    if listed and fault:
        other = f", or set {endpoint.parameter}" if endpoint.parameter else ""
        made = f"topic {endpoint.name!r} is made of a word of this list: {fault.reason}"
        raise InputError(f"{listed.place}: {made}; write another word{other}")
    return endpoint


def _with_chosen_type(endpoint: Endpoint, value_of: Values) -> Endpoint:
    """Return the endpoint with the one type that its parameters choose."""
    chosen = chosen_type(endpoint.types, value_of)
    return endpoint._replace(type=chosen, also=(), types=()) if chosen else endpoint


def _is_decided(
    raw: Endpoint, lists: Iterable[str], values: Mapping[str, Given], of_set: Iterable[Endpoint]
) -> bool:
    """Return whether the parameters decide whether an endpoint exists, or its name."""
    needed = list(lists)
    if needed:
        return _are_listed(needed, values)
    if raw.condition or any(_set_names(raw.parameter, values)):
        return True
    # Of a pattern all are there that a file has, and no others.
    if "*" in raw.name and values:
        return True
    return "<" in raw.name and all("<" in it.name for it in of_set)


def _ids_in(ids: Mapping[str, str], *texts: str) -> list[str]:
    """Return the ids that texts have, each once."""
    return [it for it in dict.fromkeys(_ID.findall(" ".join(texts))) if it in ids]


def _are_listed(lists: Iterable[str], values: Mapping[str, Given]) -> bool:
    """Return whether each of these lists is given."""
    return all(_called(it, values) for it in lists)


def _bindings(
    ids: Mapping[str, str], wanted: Iterable[str], values: Mapping[str, Given]
) -> Iterator[Ids]:
    """Yield every choice of the wanted ids; a list may depend on another id (``<layer>.sources``)."""
    found: list[dict[str, str]] = [{}]
    for name in _with_needed_ids(ids, wanted):
        found = [
            {**binding, name: word}
            for binding in found
            for word in _items(values.get(_with_ids(ids[name], binding)))
        ]
    yield from found


def _with_needed_ids(ids: Mapping[str, str], wanted: Iterable[str]) -> list[str]:
    """Return the wanted ids and those that their lists need, the needed ones first."""
    order: list[str] = []
    for name in wanted:
        needed = [it for it in _ID.findall(ids[name]) if it in ids]
        order += [it for it in (*_with_needed_ids(ids, needed), name) if it not in order]
    return order


def _items(given: Given | None) -> list[str]:
    """Return the items of a list; a text is a list of its words."""
    if given is None:
        return []
    value = given.value
    words = [str(it) for it in value] if isinstance(value, list) else str(value).split()
    return [it for it in words if not _TYPE.search(it)]


def _with_ids(text: str, binding: Ids) -> str:
    """Return a text with its ``<id>`` placeholders filled in."""
    return _ID.sub(lambda found: binding.get(found[1], found[0]), text)


def _with_bound_ids(endpoint: Endpoint, binding: Ids) -> Endpoint:
    name = _with_ids(endpoint.name, binding)
    # A name that is made at run time is known now, so a rule reaches it.
    return endpoint._replace(
        name=name,
        fixed=endpoint.fixed if name == endpoint.name else "",
        parameter=_with_ids(endpoint.parameter, binding),
        condition=_with_ids(endpoint.condition, binding),
        when=_with_ids(endpoint.when, binding),
        types=tuple((_with_ids(it, binding), type_) for it, type_ in endpoint.types),
    )


def _ending(node: NodeFacts, raw: Endpoint) -> str:
    """Return what a node appends to a parameter's topic for another endpoint, such as ``_updates``."""
    alike = (it.named_from or it.name for it in node.endpoints if it.parameter == raw.parameter)
    bases = [it for it in alike if raw.name.startswith(it)] if raw.parameter else []
    return raw.name.removeprefix(min(bases, key=len)) if bases else ""


def _named(endpoint: Endpoint, values: Mapping[str, Given], ending: str) -> Iterator[Endpoint]:
    """Yield the endpoint under the names that its parameter sets; under its own if none is set."""
    names = list(_set_names(endpoint.parameter, values))
    for parameter, name in names:
        if name:
            # The node makes it absolute itself: /scan, or /robot1/scan below robot1.
            full = f"/{name}" if endpoint.above and name[0] not in "/~" else name
            full += ending
            set_ = endpoint._replace(name=full, parameter=parameter)
            yield set_._replace(fixed="", when="", condition="")
    if not names and "<" not in endpoint.name:
        fixed = endpoint.fixed if endpoint.fixed and not endpoint.parameter else ""
        yield endpoint._replace(condition="", fixed=fixed)


def _set_names(parameter: str, values: Mapping[str, Given]) -> Iterator[tuple[str, str]]:
    """Yield (parameter, topic) for the first parameter that is set, or all of a pattern; "" is none."""
    found: list[tuple[str, str]] = []
    for one in parameter.split(ALSO):
        found = []
        for name in _called(one, values):
            value = values[name].value
            topics = _items(values[name]) if isinstance(value, list) else [str(value)]
            found += ((name, it) for it in topics if not it or not check_name_in_code(it))
        if any(topic for _, topic in found):
            break
    yield from found


def _called(parameter: str, values: Mapping[str, Given]) -> list[str]:
    """Return the names of the values that a parameter may stand for, in their order."""
    if not (_is_numbered(parameter) or _GAP.search(parameter)):
        return [parameter] if parameter in values else []
    return [name for name in values if _pattern(parameter).fullmatch(name)]


def _is_numbered(parameter: str) -> bool:
    """Return whether a parameter ends with a number, as ``odomN``."""
    return parameter.endswith(_NUMBER) and parameter[:-1].islower()


@lru_cache(maxsize=1024)
def _pattern(parameter: str) -> re.Pattern[str]:
    """Return the expression for a parameter with placeholders."""
    number = r"\d+" if _is_numbered(parameter) else ""
    name = parameter.removesuffix(_NUMBER) if number else parameter
    return re.compile(with_gaps(_GAP.split(name), "[^.]") + number)
