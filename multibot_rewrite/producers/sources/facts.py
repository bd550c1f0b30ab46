# SPDX-License-Identifier: Apache-2.0
"""What a program does by its source -> the facts of its node, as the library has those of known nodes.

Only what is sure is said without a condition. What is not known before it runs is listed in ``untold``.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations
from typing import NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.base.rosnames import check_node_name, check_topic_name, propose_token
from multibot_rewrite.knowledge.conditions import AND, OPEN_KIND, OR, SOURCE, joined
from multibot_rewrite.knowledge.parameters import built_in_nodes, guess
from multibot_rewrite.knowledge.records import (
    Endpoint,
    FrameParameter,
    NodeFacts,
    Param,
    SentTransform,
    Untold,
)
from multibot_rewrite.producers.sources.programs import (
    Packages,
    Read,
    Start,
    read_program,
    start_of,
)
from multibot_rewrite.producers.sources.records import OTHERWISE, Place, Value, parameter_in
from multibot_rewrite.producers.sources.resolve import (
    EACH,
    FRAMES,
    LIST,
    NOBODY,
    Names,
    Spot,
    default_of,
    names_of,
)
from multibot_rewrite.producers.sources.walk import (
    IMAGE,
    Declared,
    Event,
    Looked,
    Named,
    Parameter,
    Sent,
    Unread,
    events_of,
)
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Origin,
    Place as At,
)

# Beginnings of names that are no absolute ones.
_RELATIVE = ("~", "<")
SET = " set"
# Of more parameters in a name than these only the defaults are followed.
MOST_PARAMETERS = 3
PERHAPS = f"{OPEN_KIND}: {SOURCE}"
_KINDS = {PUBLISHES: TOPIC, SUBSCRIBES: TOPIC, SERVES: SERVICE, CALLS: SERVICE}
_ACTIONS = {
    *("ActionServer", "ActionClient", "SimpleActionServer"),
    *("create_action_server", "create_action_client"),
}
_FLAGS = {"True": True, "true": True, "False": False, "false": False}
_INFO, _SET_INFO = "<camera_info>", "<~>set_camera_info"
_CAMERAS = ("advertise", "advertiseCamera", "create_camera_publisher")
_WITH_INFO = (*_CAMERAS[1:], "create_camera_subscription")
LOOKED_UP = "looked up"


class NodeSource(NamedTuple):
    """A node by its source: facts, declared parameters, frames of the code, and files read."""

    facts: NodeFacts
    params: tuple[Param, ...]
    frames: tuple[tuple[str, str, At], ...]
    files: tuple[str, ...]


def node_of_program(
    folder: str, package: str, program: str, packages: Packages, release: str
) -> NodeSource | None:
    """Return what a program or component of a package does, by its source; None without source.

    ``packages`` are those whose files may be followed. Raises UsageError if C++ cannot be read."""
    start = start_of(folder, program)
    if start is None:
        return None
    read = read_program(start.files, packages)
    names = names_of(read.source)
    events = [*_events(names, start)]
    return _node_source(package, program, start, read, names, events, release)


def _events(names: Names, start: Start) -> Iterator[Event]:
    """Yield what a program does from its start on."""
    if start.class_:
        found = names.classes.get(start.class_, ())
        own = [it for it in found if it.place.path == start.path] or [*found]
        lost = Unread(start.class_, Place("", "", start.path, 1))
        yield from events_of(names, own[:1]) if own else [lost]
        return
    begin = Spot(NOBODY, "", "", {}, "", start.path)
    functions = dict.fromkeys(("", start.function.rpartition(".")[2]))
    yield from events_of(names, [begin._replace(function=it) for it in functions])


def _node_source(
    package: str,
    program: str,
    start: Start,
    read: Read,
    names: Names,
    events: Sequence[Event],
    release: str,
) -> NodeSource:
    """Return what a program does: endpoints, parameters, transforms, and what is left open."""
    named = [it for it in events if isinstance(it, Named)]
    plain = dict.fromkeys(it.name for it in named if not check_node_name(it.name))
    always = dict.fromkeys(it.name for it in named if it.name in plain and not it.asked)
    word = program.rpartition("::")[2].removesuffix(".py")
    made = [it for it in events if isinstance(it, Declared)]
    doubted = ("~",) * (len(plain) > 1) if not any(it.space for it in named) else _RELATIVE
    ends = _each_once((end for it in made for end in _endpoints(names, it, release)), doubted)
    params = tuple(_params(names, events, read.source.values))
    sends, of_sends = _sent_transforms(names, events)
    both = {it.parameter: it for it in (*_frames(names, events), *of_sends)}
    known, frames = built_in_nodes(release), []
    for frame in both.values():
        # As build leaves it: in a file it changes what is called as a frame, and adds nothing.
        seen = not frame.in_code and guess(known, frame.parameter) == "frame"
        frames.append(frame._replace(in_code=not seen, is_kept=seen))
    # The parameters that names are made of.
    as_set = (it.name.split("<")[1:] for it in ends if it.when.endswith(SET))
    ids = dict.fromkeys(part.partition(">")[0] for parts in as_set for part in parts)
    looked = (it for it in events if isinstance(it, Looked) and it.text and "<" not in it.text)
    named_frames = tuple((it.role, it.text, At(it.place.path, it.place.line)) for it in looked)
    where = At(
        start.path, named[0].place.line if named and named[0].place.path == start.path else 0
    )
    facts = NodeFacts(
        next(iter(plain), propose_token(word)),
        package,
        ends,
        frames=tuple(frames),
        sends=sends,
        ids=tuple((it, it) for it in ids),
        origin=Origin(place=where),
        source=tuple(dict.fromkeys(_at(it.place) for it in named)) or (start.path,),
        programs=() if start.class_ else (program,),
        component=program if start.class_ else "",
        untold=tuple(_untold(read, named, plain, events, ends)),
        together=tuple(always) if len(always) > 1 else (),
    )
    return NodeSource(facts, params, named_frames, read.files)


def _each_once(ends: Iterable[Endpoint], doubted: tuple[str, ...]) -> tuple[Endpoint, ...]:
    """Return each endpoint once, without a condition if it is there without one, too.

    The names of those that begin with one of ``doubted`` are not sure: they are resolved in a namespace
    or below a node that is not known for sure."""
    surest: dict[tuple[str, ...], Endpoint] = {}
    for it in dict.fromkeys(ends):
        is_doubted = doubted and it.name.startswith(doubted)
        is_doubted = is_doubted or (doubted == _RELATIVE and it.name[:1] != "/")
        end = it._replace(when=PERHAPS) if is_doubted else it
        key = (end.kind, end.role, end.name, end.type, end.parameter)
        other = surest.setdefault(key, end)
        if other.when and not end.when:
            surest[key] = end
        elif other.when and other.when != end.when:
            surest[key] = other._replace(when=PERHAPS)
    return tuple(surest.values())


def _at(place: Place) -> str:
    """Return a place as ``path:line``."""
    return f"{place.path}:{place.line}"


# Packages of services that a simulator has once for all robots.
_OF_SIMULATORS = ("gazebo_msgs/srv/", "ros_gz_interfaces/srv/", "simulation_interfaces/srv/")


def _endpoints(names: Names, it: Declared, release: str) -> Iterator[Endpoint]:
    """Yield the endpoints that a declaration in a source makes."""
    when = _condition(names, it.spot, it.asked)
    type_ = it.type
    action = "/action/" in type_ or (not type_ and it.api.function in _ACTIONS)
    bare = Endpoint(
        ACTION if action else _KINDS[it.api.role],
        it.api.role,
        "",
        type_,
        when=when,
        helper=it.helper,
        source=(_at(it.place),),
    )
    if it.name == _INFO:
        return
    if it.name == _SET_INFO:
        name = "~/set_camera_info" if has_release("jazzy+", release) else "set_camera_info"
        yield bare._replace(name=name)
        return
    images = it.api.function in _CAMERAS and type_ == IMAGE
    for name, parameter, more in (
        one for word in _names_in_rounds(it.name) for one in _names_by_setting(names, it.spot, word)
    ):
        both = joined(when, more) if when and more else when or more
        end = bare._replace(name=name, parameter=parameter, when=both, transport=images)
        if name.startswith("/") and bare.role == CALLS and type_.startswith(_OF_SIMULATORS):
            end = end._replace(fixed="the one simulator has it", own=True)
        yield end
        if it.api.function in _WITH_INFO and type_ == IMAGE and "<" not in name:
            info = f"{name.rpartition('/')[0]}/camera_info".lstrip("/" if name[:1] != "/" else "")
            own = end._replace(name=info, type="sensor_msgs/msg/CameraInfo", transport=False)
            # Since then image_transport makes it of the image's name with its rules applied (#326).
            yield own._replace(parameter="", beside=name if has_release("kilted+", release) else "")


def _names_in_rounds(text: str) -> Iterator[str]:
    """Yield a name in each round of its loop."""
    _, mark, rest = text.partition(f"<{EACH}{LIST}")
    words, _, _ = rest.partition(">")
    if not mark:
        yield text
        return
    for it in words.split("|"):
        yield from _names_in_rounds(text.replace(f"<{EACH}{LIST}{words}>", it))


def _names_by_setting(names: Names, spot: Spot, text: str) -> Iterator[tuple[str, str, str]]:
    """Yield (name, parameter that sets it, condition): by the default, and as it is set."""
    parts = text.split("<")
    params = [it.partition(">")[0] for it in parts[1:]]
    asked = list(dict.fromkeys(it[1:] for it in params if it.startswith("@") and "{" not in it))
    if len(asked) != len(set(params)):
        yield _placeholder(text), "", ""
        return
    defaults = {it: default_of(names, spot, it) for it in asked}
    known = text
    for it, default in defaults.items():
        known = known.replace(f"<@{it}>", f"<{it}>" if default is None else default)
    fine = "<" not in known and known and not check_topic_name(known)
    if not asked:
        yield (known if fine else "<?>"), "", ""
    elif text == f"<@{asked[0]}>":
        yield (known if fine else f"<{asked[0]}>"), asked[0], ""
    elif fine and len(asked) <= MOST_PARAMETERS:
        yield known, "", AND.join(f"{it} unset" for it in asked)
        # Where each of some of its parameters is set, and the others are not.
        sizes = range(1, len(asked) + 1)
        for given in (it for size in sizes for it in combinations(asked, size)):
            name = text
            for it in asked:
                name = name.replace(f"<@{it}>", f"<{it}>" if it in given else defaults[it] or "")
            said = (f"{it}{SET if it in given else ' unset'}" for it in reversed(asked))
            yield name, "", AND.join(sorted(said, key=lambda it: it.endswith(SET)))
    else:
        yield _placeholder(text), "", ""


def _placeholder(text: str) -> str:
    """Return a text with ``<name>`` for each value that is not known."""
    return text.replace("<@", "<").replace("{", "").replace("}", "")


def _condition(names: Names, spot: Spot, asked: str) -> str:
    """Return the condition that an entry would have; what nothing shows is open."""
    found = [_flag_condition(names, spot, it) for it in filter(None, asked.split("&"))]
    either = [it for it in found if OR in it]
    if PERHAPS in found or len(either) > 1:
        return PERHAPS
    text = "".join(either)
    for it in found:
        text = joined(text, it) if it not in either else text
    return text


def _flag_condition(names: Names, spot: Spot, text: str) -> str:
    """Return ``<@debug>`` or ``!<@debug>`` as a condition."""
    wrong, bare = text[:1] == "!", text.lstrip("!")
    if bare == OTHERWISE or not bare.startswith("<@"):
        return PERHAPS
    parameter = bare[2:-1]
    default = _FLAGS.get((default_of(names, spot, parameter) or "").strip("<>"))
    if default is None or "{" in parameter:
        return PERHAPS
    value = "false" if wrong else "true"
    given = f"{parameter} = {value}"
    return f"{parameter} unset{OR}{given}" if default != wrong else given


def _params(names: Names, events: Sequence[Event], values: Iterable[Value]) -> Iterator[Param]:
    """Yield the parameters that are declared where the program passes."""
    kinds: dict[str, str] = {}
    for it in events:
        if isinstance(it, Declared) and (name := parameter_in(it.name)):
            kinds[name] = TOPIC
        elif isinstance(it, Looked) and (name := parameter_in(it.text)):
            kinds[name] = "frame"
    spots = {
        (it.spot.owner, it.spot.function): it.spot for it in events if isinstance(it, Parameter)
    }
    named = [(it.name, it.place, it.spot) for it in events if isinstance(it, Parameter)]
    named += [
        (it.variable[1:], it.place, spots[it.owner, it.function])
        for it in values
        if it.variable.startswith("@") and (it.owner, it.function) in spots
    ]
    for name, place, spot in {it[0]: it for it in named if it[0] and "{" not in it[0]}.values():
        default = default_of(names, spot, name) or ""
        yield Param(name, kinds.get(name, ""), default.strip("<>"), source=(_at(place),))


def _frames(names: Names, events: Iterable[Event]) -> Iterator[FrameParameter]:
    """Yield parameters that hold frames."""
    for it in events:
        parameter = parameter_in(it.text) if isinstance(it, Looked) else ""
        if isinstance(it, Looked) and parameter and "{" not in parameter:
            default = default_of(names, it.spot, parameter) or ""
            yield FrameParameter(parameter, default, source=(_at(it.place),))


def _sent_transforms(
    names: Names, events: Sequence[Event]
) -> tuple[tuple[SentTransform, ...], tuple[FrameParameter, ...]]:
    """Return transforms by the frames written into messages, and their parameters or quoted frames."""
    frames_of = (it for it in events if isinstance(it, Looked) and it.role != LOOKED_UP)
    messages = ((it.variable.removesuffix(it.role).rstrip("."), it) for it in frames_of)
    written = lists_by_key(
        ((_key_of(it.spot), f"{message} {it.role}"), it) for message, it in messages
    )
    sends, frames = [], []
    for sent in (it for it in events if isinstance(it, Sent)):
        pair = [written.get((_key_of(sent.spot), f"{sent.variable} {it}"), []) for it in FRAMES]
        if not all(len({it.text for it in rows}) == 1 for rows in pair):
            continue
        words = []
        for text in (rows[0].text for rows in pair):
            own = parameter_in(text) if "{" not in text else ""
            words.append(own or (f"'{text}'" if text and "<" not in text else ""))
        if all(words) and words[0] != words[1]:
            # That a callback may never run is no switch.
            asked = "&".join(it for it in sent.asked.split("&") if it != OTHERWISE)
            switch = _condition(names, sent.spot, asked)
            sends.append(SentTransform(words[0], words[1], "" if switch == PERHAPS else switch))
            for (it, *_), word in zip(pair, words, strict=True):
                in_code = word[0] == "'"
                frame = word.strip("'") if in_code else default_of(names, it.spot, word) or ""
                frames.append(FrameParameter(word, frame, "", (_at(it.place),), in_code, in_code))
    return tuple(dict.fromkeys(sends)), tuple(frames)


def _key_of(spot: Spot) -> object:
    return spot.owner, spot.function, spot.path


def _untold(
    read: Read,
    named: Sequence[Named],
    plain: Mapping[str, None],
    events: Iterable[Event],
    ends: Iterable[Endpoint],
) -> Iterator[Untold]:
    """Yield what is unknown before it runs."""
    if len(plain) > 1:
        yield Untold(f"it makes several nodes: {', '.join(plain)}")
    if not plain:
        yield Untold("the name of its node is not known")
    for place, why in read.source.faults:
        yield Untold(f"{_at(place)}: {why}")
    for it in named:
        if it.space:
            yield Untold(f"{_at(it.place)}: its code sets its namespace")
    for one in dict.fromkeys(it for it in events if isinstance(it, Unread)):
        yield Untold(f"{_at(one.place)}: what {one.what} does with the node is not read")
    for end in ends:
        what = f"{end.source[0]}: {end.role} {end.type or 'something'} under a name"
        if end.name == f"<{end.parameter}>":
            yield Untold(f"{what} that only its parameter {end.parameter} has", end.parameter)
        elif "<" in end.name and not end.when.endswith(SET):
            yield Untold(f"{what} made at run time")
