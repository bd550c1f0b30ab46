# SPDX-License-Identifier: Apache-2.0
"""A program, from its start on: what each function declares, with what it is given, and when.

What is called is followed as far as its text is here. What nothing calls by name (a callback) may run.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.producers.sources.expressions import is_node, last, template_arguments
from multibot_rewrite.producers.sources.records import (
    ANY,
    ARGUMENT,
    HELPER,
    OTHERWISE,
    OWN,
    Api,
    Call,
    Class,
    Constructor,
    Place,
    apis,
    harmless,
    parameter_in,
)
from multibot_rewrite.producers.sources.resolve import (
    EACH,
    LIST,
    NOBODY,
    Made,
    Names,
    Spot,
    frame_in,
    text_in,
    type_in,
)

DEEPEST = 24
MOST_STEPS = 20_000
# Classes of ROS whose constructor makes a node, and what a life cycle calls of one.
NODES = {"Node", "LifecycleNode"}
_OF_CYCLE = {f"on_{it}" for it in ("configure", "activate", "init")}
_LOOKS_UP = (
    *("lookup_transform", "lookupTransform", "can_transform", "canTransform"),
    *("lookup_transform_async", "wait_for_transform_async"),
)
# They use nothing of a node that others see.
HARMLESS_BASES = {"object", "Thread", "ABC", "Enum", "Exception", "enable_shared_from_this"}


# What declares an endpoint in Python; in C++ those of ROS 1 have a type.
OF_PYTHON = {
    *("create_publisher", "create_subscription", "create_service", "create_client"),
    *("ActionServer", "ActionClient", "Subscriber", "service_caller", "Buffer", "Updater"),
    *("TransformBroadcaster", "StaticTransformBroadcaster", "TransformListener"),
    "InteractiveMarkerServer",
}
OF_ANY = {"create_publisher", "create_subscription", "create_service", "create_client"}
OF_ROS_1 = {"advertise", "advertiseCamera"}
IMAGE = "sensor_msgs/msg/Image"


class Declared(NamedTuple):
    """An endpoint as a program declares it, maybe with <> in ``name``; ``on`` another part's node."""

    api: Api
    name: str
    type: str
    helper: bool
    asked: str
    place: Place
    spot: Spot


class Parameter(NamedTuple):
    """A parameter that is declared."""

    name: str
    place: Place
    spot: Spot


class Looked(NamedTuple):
    """A frame that a program asks tf for or writes; ``role``: "looked up", or its end's."""

    role: str
    text: str
    variable: str
    asked: str
    place: Place
    spot: Spot


class Sent(NamedTuple):
    """A variable that is sent as a transform."""

    variable: str
    asked: str
    place: Place
    spot: Spot


class Named(NamedTuple):
    """A node that is made, with its name and namespace, as texts."""

    name: str
    space: str
    asked: str
    place: Place


class Unread(NamedTuple):
    """What a node is handed to and is not here."""

    what: str
    place: Place


Event = Declared | Parameter | Looked | Sent | Named | Unread


class _Walk(NamedTuple):
    """A walk's state: texts, functions that ran, objects by class, methods called on objects."""

    names: Names
    seen: set[object]
    objects: dict[str, list[Made]]
    budget: list[int]


def events_of(names: Names, starts: Sequence[Spot | Class]) -> Iterator[Event]:
    """Yield all that a program does that starts in functions, or by making objects of classes."""
    walk = _Walk(names, set(), {}, [MOST_STEPS])
    for it in starts:
        if isinstance(it, Class):
            yield from _object(walk, it, (), (), Spot(NOBODY, "", "", {}, "", it.place.path))
        else:
            yield from _function(walk, it)
    # What no name has called: callbacks, threads.
    for made in [one for every in [*walk.objects.values()] for one in every]:
        yield from _uncalled_parts(walk, made)
    # What would declare an endpoint, in a part that no call was followed to. A node of its own that
    # this program does not make is none of its parts.
    for (owner, function), rows in names.calls.items():
        left = (it for it in rows if it.name in OF_ANY and it.place not in walk.seen)
        if (first_left := next(left, None)) and not _is_new_node(names, f"<new {owner}>"):
            what = f"{owner or function}, which nothing is seen to call,"
            yield Unread(what, first_left.place)
    if walk.budget[0] <= 0:
        first = starts[0]
        path = first.place.path if isinstance(first, Class) else first.path
        yield Unread("more than is followed", Place("", "", path, 1))


def _uncalled_parts(walk: _Walk, made: Made) -> Iterator[Event]:
    """Yield what methods of an object may do that nothing calls by name: callbacks."""
    # Has it the states of a life cycle?
    cycled = any(last(it) == "LifecycleNode" for it in made.beyond)
    for it in made.chain:
        for owner, function in [key for key in walk.names.calls if key[0] == it.name]:
            key = (made.owners[0], owner, function)
            if key in walk.seen:
                continue
            asked = "" if cycled and function in _OF_CYCLE else OTHERWISE
            yield from _function(walk, Spot(made, owner, function, {}, asked, it.place.path))


def _function(walk: _Walk, spot: Spot) -> Iterator[Event]:
    """Yield what a function does, with what it is given."""
    own = (spot.made.owners[0] if spot.made.chain else spot.path, spot.owner, spot.function)
    key = (*own, tuple(sorted(spot.given.items())), spot.asked, id(spot.made.given))
    walk.budget[0] -= 1
    if key in walk.seen or own in spot.trail or len(spot.trail) > DEEPEST or walk.budget[0] < 0:
        return
    walk.seen.update((key, own))
    spot = spot._replace(trail=(*spot.trail, own))
    at = spot.owner, spot.function
    for call in walk.names.calls.get(at, ()):
        if spot.owner or call.place.path == spot.path:
            yield from _events_of_call(walk, spot, call)
    # Frames that are written into messages.
    for it in walk.names.frames.get(at, ()):
        if spot.owner or it.place.path == spot.path:
            text = text_in(walk.names, spot, it.text)
            yield Looked(frame_in(it), text, it.variable, spot.asked, it.place, spot)


def _conditions_of(names: Names, spot: Spot, call: Call) -> str:
    """Return all conditions of a call, with the values of their names."""
    own = []
    for it in filter(None, call.asked.split("&")):
        text = text_in(names, spot, it)
        if not text.startswith(f"<{EACH}{LIST}"):
            own.append(text if parameter_in(text.lstrip("!")) else OTHERWISE)
    return "&".join(dict.fromkeys((*filter(None, spot.asked.split("&")), *own)))


def _events_of_call(walk: _Walk, spot: Spot, call: Call) -> Iterator[Event]:
    """Yield what a call declares, sends, looks up or makes, or what it runs."""
    names, asked = walk.names, _conditions_of(walk.names, spot, call)
    here = spot._replace(asked=asked)
    name, types = _behind_aliases(names, spot, call)
    own = next((it for key, it in OF_TF.items() if name in key), None)
    if own or "declare_parameter" in name:
        yield from (own or _parameters)(names, here, call)
        return
    on = text_in(names, spot, call.on) if call.on else ""
    if _is_base_call(spot, call, name) or name in NODES or name == "create_node":
        yield from _events_of_base(walk, here, call, name)
    elif (found := _class_named(names, name, call.place)) and (
        # An object is made, and no method of that name called.
        not call.on or call.on.endswith(f"{name}>") or call.name != name or "." not in on
    ):
        yield from _object(walk, found, call.given, types, here, call.named)
    elif name in apis() and not (on.startswith("<new ") and (on[5:-1], name) in names.takers):
        walk.seen.add(call.place)
        yield from _declared_ends(names, here, call, name, types)
    elif followed := _called_functions(walk, here, call, name, on):
        for it in followed:
            yield from _function(walk, it)
    elif name not in harmless():
        # Something that is not here is given the node.
        texts = {text_in(names, spot, it) for it in call.given}
        mine = {"<this>", "<shared_from_this>"} if spot.made.chain else set()
        if name and (texts & mine or any(_is_new_node(names, it) for it in texts)):
            yield Unread(name, call.place)


def _is_new_node(names: Names, text: str) -> bool:
    """Return whether a text is a node that the program has made."""
    if text.startswith("<Node:") or text in ("<new Node>", "<new LifecycleNode>"):
        return True
    rows = names.classes.get(text[5:-1], ()) if text.startswith("<new ") else ()
    return any(last(it) in NODES for one in rows for it in _known_bases(names, one)[1])


def _lookups(names: Names, spot: Spot, call: Call) -> Iterator[Looked]:
    for it in call.given[:2]:
        yield Looked("looked up", text_in(names, spot, it), "", spot.asked, call.place, spot)


def _sent_transforms(names: Names, spot: Spot, call: Call) -> Iterator[Sent]:
    yield from (Sent(it.strip("<>"), spot.asked, call.place, spot) for it in call.given)


OF_TF: dict[tuple[str, ...], Callable[[Names, Spot, Call], Iterator[Event]]] = {
    _LOOKS_UP: _lookups,
    ("sendTransform", "send_transform"): _sent_transforms,
}


def _behind_aliases(names: Names, spot: Spot, call: Call) -> tuple[str, tuple[str, ...]]:
    """Return what is called or made, and its template arguments, behind other names of types."""
    for it in names.aliases.get(call.name, ()):
        if it.owner in (*spot.made.owners, ""):
            return last(it.type), template_arguments(it.type)
    for own in spot.made.chain:
        if not call.types and call.name in own.members and call.name not in apis():
            return _inner(own.members[call.name])
    return call.name, call.types


def _inner(type_: str) -> tuple[str, tuple[str, ...]]:
    """Return the class of a type, behind its pointers, with its template arguments."""
    inner = template_arguments(type_)
    if last(type_) in ("shared_ptr", "unique_ptr", "optional") and inner:
        return _inner(inner[0])
    return last(type_), inner


def _class_named(names: Names, name: str, place: Place) -> Class | None:
    """Return the class of this name: of the same file, or the only one."""
    rows = names.classes.get(name, ())
    own = [it for it in rows if it.place.path == place.path]
    return own[0] if len(own) == 1 else rows[0] if len(rows) == 1 else None


def _object(
    walk: _Walk,
    found: Class,
    given: tuple[str, ...],
    types: tuple[str, ...],
    spot: Spot,
    named: tuple[tuple[str, str], ...] = (),
) -> Iterator[Event]:
    """Yield what making an object does."""
    names = walk.names
    words = tuple(text_in(names, spot, it) for it in given)
    kept = tuple((key, text_in(names, spot, it)) for key, it in named)
    chain, beyond = _known_bases(names, found)
    heads = [it.partition("=")[0] for it in found.parameters]
    meant = [type_in(names, spot, it) or it for it in types]
    own = _taken(names, found.name, found.name, words, kept)
    made = Made(chain, {found.name: own}, dict(zip(heads, meant, strict=False)), beyond)
    key = ("object", found.name, tuple(sorted(own.items())), spot.asked)
    if key in walk.seen:
        return
    walk.seen.add(key)
    walk.objects.setdefault(found.name, []).append(made)
    yield from _events_of_construction(walk, made, found, own, spot)


def _events_of_construction(
    walk: _Walk, made: Made, found: Class, own: Mapping[str, str], spot: Spot
) -> Iterator[Event]:
    """Yield what a class's constructor does, its members' and its bases', too."""
    for function in ("__init__", found.name, ""):
        where = _path(walk.names, found.name, function, found.place.path)
        start = Spot(made, found.name, function, own, spot.asked, where, spot.trail)
        yield from _function(walk, start)
    for type_ in found.members.values():
        name, types = _inner(type_)
        inside = _class_named(walk.names, name, found.place)
        if inside and name == last(type_) and name not in walk.objects and name not in made.owners:
            yield from _object(walk, inside, (), types, spot._replace(made=made))
    # A constructor that calls none of its base has the one without arguments.
    for it in made.chain[1:]:
        if it.name not in made.given:
            made.given[it.name] = _taken(walk.names, it.name, it.name, (), ())  # type: ignore[index]
            yield from _events_of_construction(walk, made, it, made.given[it.name], spot)


def _known_bases(names: Names, found: Class) -> tuple[tuple[Class, ...], tuple[str, ...]]:
    """Return the class with its known base classes; and the names of its unknown ones."""
    chain, beyond, waiting = [found], [], [*found.bases]
    while waiting and len(chain) < DEEPEST:
        base = waiting.pop(0).strip("<>")
        above = _class_named(names, last(base.rpartition(".")[2]), found.place)
        if above is None:
            beyond.append(base.rpartition(".")[2])
        elif above not in chain:
            chain.append(above)
            waiting += above.bases
    return tuple(chain), tuple(beyond)


def _taken(
    names: Names,
    owner: str,
    function: str,
    words: tuple[str, ...],
    named: tuple[tuple[str, str], ...],
) -> dict[str, str]:
    """Return the arguments of a function, by the names of its parameters, with their defaults."""
    rows = names.takers.get((owner, function), ())
    fitting = [it for it in rows if len(it.names) >= len(words)]
    best: Constructor | None = min(fitting, key=lambda it: len(it.names), default=None)
    if best is None:
        return {}
    given = {**dict(zip(best.names, words, strict=False)), **dict(named)}
    return {**dict(best.defaults), **given}


def _is_base_call(spot: Spot, call: Call, name: str) -> bool:
    """Return whether a call is of the constructor of a base, in its class."""
    if name == "__init__":
        return True
    inside = spot.function in ("", spot.owner) and not call.on
    own = (it for it in spot.made.chain if it.name == spot.owner)
    return inside and any(name in map(last, it.bases) for it in own)


def _events_of_base(walk: _Walk, spot: Spot, call: Call, name: str) -> Iterator[Event]:
    """Yield what the constructor of a base does, or a node that is made."""
    names, made = walk.names, spot.made
    words = tuple(text_in(names, spot, it) for it in call.given)
    if name == "__init__" and call.on != "<new super>" and words[:1] == ("<this>",):
        words = words[1:]
    named = tuple((key, text_in(names, spot, it)) for key, it in call.named)
    above = _called_base(spot, call, name)
    if above:
        own = _taken(names, above.name, above.name, words, named)
        made.given[above.name] = own  # type: ignore[index]
        yield from _events_of_construction(walk, made, above, own, spot)
        return
    base, beyond = name, made.beyond
    if name not in (*NODES, "create_node"):
        # The base that is not here.
        word = name if name != "__init__" else call.on.strip("<>").rpartition(".")[2]
        nodes = (it for it in beyond if last(it) in NODES)
        base = word if word in beyond else next(nodes, next(iter(beyond), ""))
    if last(base) not in (*NODES, "create_node"):
        if base and base not in HARMLESS_BASES:
            yield Unread(base, call.place)
        return
    texts = [it for it in words if not is_node(it)]
    keys = dict(named)
    called = texts[0] if texts else keys.get("node_name", keys.get("name", ANY))
    space = texts[1] if len(texts) > 1 and "<" not in texts[1] else keys.get("namespace", "")
    asked = spot.asked or keys.get("use_global_arguments", "")
    yield Named(called, space, asked, call.place)


def _called_base(spot: Spot, call: Call, name: str) -> Class | None:
    """Return the base whose constructor is called, if its source is here."""
    chain, owners = spot.made.chain, spot.made.owners
    if name != "__init__":
        return next((it for it in chain if it.name == name and name != spot.owner), None)
    if call.on == "<new super>":
        at = owners.index(spot.owner) if spot.owner in owners else len(owners)
        return next(iter(chain[at + 1 :]), None)
    return next((it for it in chain if f"<{it.name}>" == call.on), None)


def _parameters(names: Names, spot: Spot, call: Call) -> Iterator[Parameter]:
    texts = [it for it in call.given if not is_node(it)]
    for it in texts[:1]:
        text = text_in(names, spot, it)
        if "<" not in text:
            yield Parameter(text, call.place, spot)


def _declared_ends(
    names: Names, spot: Spot, call: Call, name: str, types: tuple[str, ...]
) -> Iterator[Declared]:
    """Yield the endpoints that a call declares, by each API of its name."""
    given = [(it, text_in(names, spot, it)) for it in (*call.given, *(it for _, it in call.named))]
    nodes = [text for raw, text in given if is_node(raw) or is_node(text)]
    others = [text for raw, text in given if not (is_node(raw) or is_node(text))]
    own = call.place.path.endswith(".py")
    if (own and name not in OF_PYTHON) or (name in OF_ROS_1 and types):
        return
    for api in apis()[name]:
        if (api.node == OWN and not nodes) or (ARGUMENT in api.name and not others):
            continue
        if not own and not types and nodes and name in {"create_publisher", "create_subscription"}:
            # That of image_transport; those of rclcpp have a type.
            api = api._replace(function="advertise", type=IMAGE)  # noqa: PLW2901
        text = api.name.replace(ARGUMENT, others[0] if others else "")
        helper = api.node == HELPER and not nodes
        type_ = _type_of(names, spot, api, types)
        # A member may be told later what to subscribe to.
        members = (_inner(it.members.get(call.on.strip("<>"), "")) for it in spot.made.chain)
        rows = ((one, own) for member, own in members for one in apis().get(member, ())[:1])
        for one, own_types in () if type_ else rows:
            type_ = _type_of(names, spot, one, own_types)
            break
        yield Declared(api, text, type_, helper, spot.asked, call.place, spot)


def _type_of(names: Names, spot: Spot, api: Api, types: tuple[str, ...]) -> str:
    if not api.type.isdigit():
        return api.type
    at = int(api.type)
    return type_in(names, spot, types[at]) if at < len(types) else ""


def _called_functions(walk: _Walk, spot: Spot, call: Call, name: str, on: str) -> list[Spot]:
    """Return the functions that a call runs, if their text is here."""
    names = walk.names
    words = tuple(text_in(names, spot, it) for it in call.given)
    named = tuple((key, text_in(names, spot, it)) for key, it in call.named)
    if call.on in ("", "<new super>", "<this>"):
        owners = spot.made.owners
        if call.on == "<new super>" and spot.owner in owners:
            owners = owners[owners.index(spot.owner) + 1 :]
        own = next((it for it in owners if (it, name) in names.takers), "")
        if own:
            given = _taken(names, own, name, words, named)
            path = _path(names, own, name, spot.path)
            return [spot._replace(owner=own, function=name, given=given, path=path)]
        inner = f"{spot.function}.{name}".strip(".")
        for owner, function in ((spot.owner, inner), ("", name)):
            rows = names.takers.get((owner, function), ())
            near = [it for it in rows if it.path == spot.path] or (rows if len(rows) == 1 else ())
            if near and (owner or not name[:1].isupper()):
                made = spot.made if owner else NOBODY
                given = _taken(names, owner, function, words, named)
                return [Spot(made, owner, function, given, spot.asked, near[0].path, spot.trail)]
        return []
    # The objects that the call is made on.
    made_of = on[5:-1] if on.startswith("<new ") else ""
    for it in spot.made.chain:
        made_of = made_of or _inner(it.members.get(call.on.strip("<>"), ""))[0]
    found = []
    for made in walk.objects.get(made_of, ()) if made_of else ():
        for own in [one for one in made.owners if (one, name) in names.takers][:1]:
            given, path = _taken(names, own, name, words, named), _path(names, own, name, spot.path)
            found.append(spot._replace(made=made, owner=own, function=name, given=given, path=path))
    return found


def _path(names: Names, owner: str, function: str, path: str) -> str:
    """Return the file of a function's calls; ``path`` if it makes none."""
    rows = names.calls.get((owner, function), ())
    return rows[0].place.path if rows else path
