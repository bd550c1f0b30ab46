# SPDX-License-Identifier: Apache-2.0
"""The entities of a launch description, visited in the order of a launch.

What only sets something up is executed, what would start something is described. An entity is known
by the names of its classes, so that this works in every release. Source: launch, launch_ros jazzy.
"""

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from functools import cache
from inspect import getsource
from linecache import getline
from types import FunctionType, MethodType
from typing import Any, NamedTuple

from multibot_rewrite.planning.start import Switch, holds
from multibot_rewrite.producers.launch.describe import (
    OFF,
    Visit,
    component,
    is_wanted,
    node,
    process,
    seconds,
    text,
)
from multibot_rewrite.producers.launch.failures import failure, is_certain, is_unset, started_by
from multibot_rewrite.producers.launch.idle import called, switches_of, value_for, wants
from multibot_rewrite.producers.launch.includes import (
    included,
    not_here,
    path_of,
    simulator,
    unread_of,
)
from multibot_rewrite.producers.launch.places import place_of
from multibot_rewrite.producers.launch.programs import may_be_off
from multibot_rewrite.producers.launch.records import IdleAction
from multibot_rewrite.producers.launch.stand_in.names import names
from multibot_rewrite.producers.launch.unknown_modules import is_unknown

_ENDED = "groups and their launch configurations have ended by then"
_INCLUDE = "IncludeLaunchDescription"
# What launch asks a description for.
ASKED = "get_launch_arguments_with_include_launch_description_actions"
# They give further entities: with ``every`` whatever their conditions say.
_GIVING = ("GroupAction", "OpaqueFunction", _INCLUDE)
# The locals of a launch that are of this package.
_OURS = "multibot_"
# One after the other; a timer may start itself again.
_MOST_EVENTS = 20


def visit_all(entity: Any, seen: Visit) -> None:
    """Visit a description, then what its events and timers start, after all groups have ended."""
    visit(entity, seen)
    while seen.waiting:
        later, here, kept = seen.waiting.pop(0)
        seen.context._push_locals()
        seen.context.extend_locals(kept)
        visit(later, here)
        seen.context._pop_locals()


def visit(entity: Any, seen: Visit) -> None:
    """Visit an entity and what is below it; what cannot be visited becomes a note."""
    file = seen.context.get_locals_as_dict().get("current_launch_file_path", seen.place.file)
    here = seen._replace(place=place_of(entity, file))
    if not seen.every:
        there = {it.word for it in seen.switches}
        switches = tuple(it for it in switches_of(entity, seen) if it.word not in there)
        is_off = any(not holds(it.word, it.default) for it in switches)
        if is_off and not seen.off_by and _is_kept_off(entity, here, switches[0]):
            return
        here = here._replace(switches=(*seen.switches, *(() if is_off else switches)))
    # An include has the path of its file for what is below it; other actions may leave theirs.
    own = _is_a(entity, _INCLUDE)
    if not own and _is_a(entity, *_GIVING):
        # Note a group that is left out: launch itself asks for its condition.
        with suppress(Exception):
            wants(entity, here)
    apart = seen.every and _is_a(entity, *_GIVING)
    with suppress(Exception):
        apart = apart and not is_wanted(entity, seen.context)
    if own:
        seen.context._push_locals()
    if apart:
        seen.context._push_launch_configurations()
    try:
        known, kinds = _handlers(), (it.__name__ for it in type(entity).__mro__)
        handle = next((known[it] for it in kinds if it in known), _visit_unknown)
        for below in handle(entity, here) or ():
            visit(below, here)
    except (Exception, SystemExit) as error:
        # Of a long chain of files what is there is read; one that includes itself has no end.
        in_itself = len({*seen.includes}) < len(seen.includes)
        if isinstance(error, RecursionError) and in_itself and not seen.every:
            raise
        # A launch file is a program: it may raise anything.
        _failed(entity, error, here)
    finally:
        if apart:
            seen.context._pop_launch_configurations()
        if own:
            seen.context._pop_locals()


def _is_kept_off(entity: Any, here: Visit, switch: Switch) -> bool:
    """Keep what an action starts when an argument turns it on; return whether that is known."""
    if not (value := value_for(switch)):
        return False
    apart = here._replace(nodes=[], notes=[], waiting=[], unread=[], includes=[], idle=[])
    apart = apart._replace(numbers={**here.numbers}, switches=(*here.switches, switch))
    apart = apart._replace(off_by=switch.name, later=f"with {switch.name}:={value}")
    context = here.context
    context._push_launch_configurations()
    context._push_environment()
    try:
        context.launch_configurations.update({switch.name: value, OFF: "true"})
        visit_all(entity, apart)
    except RecursionError:
        return False
    finally:
        context._pop_environment()
        context._pop_launch_configurations()
    packages = {it.package for it in apart.nodes}
    whole = all(it.parameters or it.missing in packages for it in apart.notes)
    # What waits for something that is off, too, would start before it.
    waits = any(it.process.event and it.process.after < 0 for it in apart.nodes)
    hosts = {f"{it.namespace.rstrip('/')}/{it.name}" for it in here.nodes}
    inside = all(not it.container or it.container in hosts for it in apart.nodes)
    if waits or not (whole and inside and apart.nodes and all(map(may_be_off, apart.nodes))):
        # Once they are known to be missing, their launch files are known by name.
        here.notes.extend(it._replace(parameters=True) for it in apart.notes if it.missing)
        return False
    here.off.extend(apart.nodes)
    asked = ((switch.name, switch.default),)
    here.idle.append(IdleAction(here.place, called(entity, context), asked, is_off=True))
    return True


def _failed(entity: Any, error: BaseException, here: Visit) -> None:
    """Note why an entity cannot be visited; keep what it starts, if that is known all the same."""
    if _is_a(entity, _INCLUDE):
        try:
            known = simulator(error, entity, here)
        except TypeError as wrong:
            known, error = [], wrong
        here.nodes.extend(known or not_here(error, entity, here))
        if known:
            return
    reason = failure(error)
    # What a function of a launch file names that cannot be asked.
    function = getattr(entity, "_OpaqueFunction__function", getattr(entity, "function", None))
    if isinstance(function, FunctionType | MethodType):
        code = function.__code__
        with suppress(OSError):
            # Of a lambda in a list all that follows would be its source.
            line = getline(code.co_filename, code.co_firstlineno)
            reason += started_by(line if code.co_name == "<lambda>" else getsource(function))
    if here.later and is_unset(error):
        reason = f"{reason.partition(';')[0]}; {_ENDED}"
    message = f"{here.later} {reason}".strip()
    here.failed(error, message, fails=is_certain(error, here.place.file))


def _is_a(entity: Any, *names: str) -> bool:
    return any(it.__name__ in names for it in type(entity).__mro__)


def _execute(entity: Any, seen: Visit) -> Iterable[Any] | None:
    """Run an action of launch; return the entities that come of it."""
    whatever = seen.every and _is_a(entity, *_GIVING)
    found: Iterable[Any] | None = (entity.execute if whatever else entity.visit)(seen.context)
    return found


def _visit_include(entity: Any, seen: Visit) -> Iterable[Any] | None:
    """Note an include; return the entities that come of its launch file."""
    if not wants(entity, seen):
        return None
    include = included(entity, seen)
    seen.includes.append(include)
    if is_unknown(entity.launch_arguments):
        # Give an include all that is set: a package that is not here makes its arguments. What it
        # has to be given, and nothing sets, is empty.
        source = entity.launch_description_source
        asked = getattr(source.get_launch_description(seen.context), ASKED)()
        needed = {it.name: "" for it, _ in asked if it.default_value is None}
        own = "launch_arguments" in vars(entity)
        name = "launch_arguments" if own else "_IncludeLaunchDescription__launch_arguments"
        setattr(entity, name, tuple({**needed, **seen.context.launch_configurations}.items()))
        seen.note(
            "a package that is not installed sets the arguments of an include", parameters=True
        )
    found = _execute(entity, seen)
    unread_of(path_of(entity, seen.context), dict(include.arguments), seen)
    return found


def _add_nothing(entity: Any, seen: Visit) -> None:
    return None


def _visit_node(entity: Any, seen: Visit) -> Iterable[Any] | None:
    """Note the node that an action starts; nothing comes of it."""
    if not wants(entity, seen):
        return None
    # launch/later.py: an action for a robot gets its options when it runs, or others run in its place.
    instead = entity.resolve(seen.context) if type(entity).__name__ == "OfRobot" else None
    if instead is None:
        seen.start(entity, node(entity, seen))
        _ended(entity, seen)
    return instead


def _visit_container(entity: Any, seen: Visit) -> Iterable[Any] | None:
    if not wants(entity, seen):
        return None
    _visit_node(entity, seen)
    host = seen.nodes[-1]
    full = f"{host.namespace.rstrip('/')}/{host.name}"
    _visit_components(entity._ComposableNodeContainer__composable_node_descriptions, full, seen)
    return None


def _visit_load(entity: Any, seen: Visit) -> Iterable[Any] | None:
    """Note the components that are loaded into a container of the launch or of another one."""
    if not wants(entity, seen):
        return None
    target = entity._LoadComposableNodes__target_container
    if _is_a(target, "ComposableNodeContainer"):
        host = node(target, seen)
        name = f"{host.namespace.rstrip('/')}/{host.name}"
    else:
        # Its service is asked for by launch's own node, which is in no namespace.
        name = f"/{text(target, seen.context).lstrip('/')}"
    _visit_components(entity._LoadComposableNodes__composable_node_descriptions, name, seen)
    return None


class LoadedComponent(NamedTuple):
    """A component ``of`` a description, which is visited as the actions are."""

    condition: Any
    node_package: Any
    node_executable: Any
    of: Any
    container: str


def _visit_components(descriptions: Iterable[Any] | None, container: str, seen: Visit) -> None:
    for it in descriptions or ():
        condition = it.condition() if callable(getattr(it, "condition", None)) else None
        visit(LoadedComponent(condition, it.package, it.node_plugin, it, container), seen)


def _visit_component(entity: Any, seen: Visit) -> None:
    if wants(entity, seen):
        seen.nodes.append(component(entity.of, entity.container, seen))


def _visit_process(entity: Any, seen: Visit) -> Iterable[Any] | None:
    if wants(entity, seen):
        for it in process(entity, seen):
            seen.start(entity, it)
        _ended(entity, seen)
    return None


def _later(entity: Any, seen: Visit) -> Iterable[Any] | None:
    """Keep the actions of a timer or an event handler for the end of the description."""
    if not wants(entity, seen):
        return None
    timer = _is_a(entity, "TimerAction")
    handler = entity if timer else entity.event_handler
    if _is_a(handler, "OnShutdown"):
        return None
    actions = entity.actions if timer else _flat_list(handler.describe()[1])
    word = "after a time" if timer else f"at an event ({type(handler).__name__})"
    if not timer and not actions:
        message = f"what {type(handler).__name__} starts is decided only at run time"
        seen.note(message)
    if timer:
        seen = seen._replace(delay=seen.delay + seconds(entity.period, seen))
    else:
        target = getattr(handler, "_OnActionEventBase__action_matcher", None)
        target = getattr(handler, "target_action", target)
        seen = seen._replace(delay=0.0, event=type(handler).__name__, target=target)
    _visit_later(actions, word, seen, timer)
    return None


def _visit_later(actions: Iterable[Any], word: str, seen: Visit, timer: bool = False) -> None:
    """Queue actions for a later visit; a timer's keep all locals of the context, others only ours."""
    actions, known = [*actions], seen.context.get_locals_as_dict()
    kept = {key: it for key, it in known.items() if timer or key.startswith(_OURS)}
    if actions and seen.events >= _MOST_EVENTS:
        seen.note(f"what starts {word} starts something {word} again and again")
        return
    later = seen._replace(later=word, events=seen.events + 1)
    seen.waiting.extend((it, later, kept) for it in actions)


def _ended(entity: Any, seen: Visit) -> None:
    """Keep what ``on_exit`` of a program starts."""
    actions = getattr(entity, "_ExecuteLocal__on_exit", None)
    if not callable(actions):
        seen = seen._replace(delay=0.0, event="OnProcessExit", target=entity)
        _visit_later(_flat_list(actions), "at an event (on_exit)", seen)


def _flat_list(actions: Any) -> list[Any]:
    if isinstance(actions, list | tuple):
        return [below for it in actions for below in _flat_list(it)]
    return [] if actions is None else [actions]


def _visit_unknown(entity: Any, seen: Visit) -> Iterable[Any] | None:
    """Note that it is not known what an action starts; nothing comes of it."""
    if is_unknown(entity):
        # It makes what it starts in code that is not here.
        entity.perform(seen.context)
    if wants(entity, seen):
        message = f"what the action {type(entity).__name__} starts is decided only at run time"
        seen.note(message)
    return None


Handler = Callable[[Any, Visit], "Iterable[Any] | None"]


@cache
def _handlers() -> Mapping[str, Handler]:
    """Return the function for each class of actions, by its name."""
    return {
        **dict.fromkeys(names().executed.split(), _execute),
        **dict.fromkeys(names().passed.split(), _add_nothing),
        _INCLUDE: _visit_include,
        "ComposableNodeContainer": _visit_container,
        "LoadedComponent": _visit_component,
        "LoadComposableNodes": _visit_load,
        "Node": _visit_node,
        **dict.fromkeys(("ExecuteLocal", "ExecuteProcess"), _visit_process),
        **dict.fromkeys(("RegisterEventHandler", "TimerAction"), _later),
    }
