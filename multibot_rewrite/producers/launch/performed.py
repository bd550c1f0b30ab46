# SPDX-License-Identifier: Apache-2.0
"""The actions of a launch file that ``build`` printed, with the values that launch gives them.

The file is executed with the stand-in for launch, as often as wanted, each time with other launch
arguments. Nothing is started, and every value is kept: what is printed can be compared with what is
planned.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PurePath
from types import ModuleType
from typing import Any, NamedTuple

from multibot_rewrite.producers.launch.describe import is_wanted
from multibot_rewrite.producers.launch.failures import failure
from multibot_rewrite.producers.launch.places import keep_places, place_of
from multibot_rewrite.producers.launch.stand_in import contents, standing_in
from multibot_rewrite.producers.launch.stand_in.actions import (
    DeclareLaunchArgument,
    IncludeLaunchDescription,
)
from multibot_rewrite.producers.launch.stand_in.names import names
from multibot_rewrite.producers.launch.stand_in.packages import (
    FindPackage,
    FindPackagePrefix,
    FindPackageShare,
    PackageNotFoundError,
)
from multibot_rewrite.producers.launch.stand_in.parameters import ParameterFile, evaluate_parameters
from multibot_rewrite.producers.launch.stand_in.processes import (
    ExecuteProcess,
    OnProcessExit,
    OnProcessStart,
    RegisterEventHandler,
    TimerAction,
)
from multibot_rewrite.producers.launch.stand_in.ros import ComposableNode, LifecycleNode
from multibot_rewrite.producers.launch.stand_in.values import Kept, LaunchContext, text_of
from multibot_rewrite.system.records import Place

# Where what starts later ends.
END = "end"
_OF_COMPONENT = ("package", "node_plugin", "node_name", "node_namespace")


class Launching(NamedTuple):
    """How a launch file is launched: arguments, installed packages that it needs, environment."""

    arguments: Mapping[str, str]
    installed: frozenset[str] = frozenset()
    environment: Mapping[str, str] = {}

    @property
    def command(self) -> str:
        """The command line, for people."""
        words = (f" {name}:={value}" for name, value in self.arguments.items())
        return f"ros2 launch fleet.launch.py{''.join(words)}"


class Action(NamedTuple):
    """What launch does: the name of the action, its values by keyword, and its place."""

    kind: str
    values: Mapping[str, Any]
    place: Place = Place("", 1)


class Performed(NamedTuple):
    """The actions of one launch, or why it fails."""

    actions: tuple[Action, ...]
    error: str = ""


def performed(path: str, launches: Sequence[Launching]) -> list[Performed]:
    """Return what each of the launches does. The file is loaded once."""
    packages = _Packages()
    with standing_in(**packages.modules()):
        keep_places()
        try:
            module = _loaded(path)
        except (Exception, SystemExit) as error:  # a launch file may raise anything
            return [Performed((), failure(error)) for _ in launches]
        return [_perform_launch(module, path, it, packages) for it in launches]


def prefix(package: str) -> str:
    """Return the folder that every package is installed in here."""
    return f"/{package}"


def share(package: str) -> str:
    """Return the share folder that every package has here."""
    return f"{prefix(package)}/share/{package}"


def _loaded(path: str) -> ModuleType:
    """Return the file as a module, of its text and not of what was compiled of it before."""
    module = ModuleType("launch_file")
    module.__file__ = path
    exec(compile(Path(path).read_bytes(), path, "exec"), vars(module))
    return module


class _Packages:
    """The packages that are installed."""

    def __init__(self) -> None:
        self.installed: frozenset[str] = frozenset()

    def modules(self) -> dict[str, Mapping[str, Any]]:
        """Return the modules that ask for packages."""

        class Share(FindPackageShare):
            def find(self, package_name: str) -> str:
                return share(package_name)

        class Prefix(FindPackagePrefix):
            def find(self, package_name: str) -> str:
                return prefix(package_name)

        asked, found = "ament_index_python.packages", "launch_ros.substitutions"
        known = contents()
        return {
            asked: {**known[asked], "get_package_prefix": self.prefix},
            found: {**known[found], "FindPackageShare": Share, "FindPackagePrefix": Prefix},
        }

    def prefix(self, package: str) -> str:
        """Return the folder of a package; raises PackageNotFoundError."""
        if package not in self.installed:
            raise PackageNotFoundError(package)
        return prefix(package)


def _perform_launch(module: Any, path: str, it: Launching, packages: _Packages) -> Performed:
    packages.installed = it.installed
    context = LaunchContext(noninteractive=True)
    context.environment.clear()
    context.environment.update(it.environment)
    context.launch_configurations.update(it.arguments)
    try:
        description = module.generate_launch_description()
        return Performed(tuple(_Seen(context, path, []).below(description)))
    except (Exception, SystemExit) as error:  # as above
        return Performed((), failure(error))


class _Seen(NamedTuple):
    """A launch: its context, its file, and the nodes with a life cycle so far."""

    context: LaunchContext
    path: str
    managed: list[Any]

    def below(self, entity: Any) -> Iterator[Action]:
        """Yield what an entity does, and all below it, in the order of the launch."""
        kind, executed = type(entity).__name__, names().executed.split()
        if isinstance(entity, DeclareLaunchArgument) or kind not in executed:
            if not is_wanted(entity, self.context):
                return
            name, inner = self.later(entity)
            yield Action(name, self.values(entity), place_of(entity, self.path))
            for it in inner:
                yield from self.below(it)
            yield from [Action(END, {})] * bool(inner)
        if kind in executed:
            for it in entity.visit(self.context) or ():
                yield from self.below(it)

    def later(self, entity: Any) -> tuple[str, Sequence[Any]]:
        """Return what an action is called, and what it starts later: by its event, or after a time."""
        if isinstance(entity, TimerAction):
            return type(entity).__name__, vars(entity)["actions"]
        handler = entity.event_handler if isinstance(entity, RegisterEventHandler) else None
        if isinstance(handler, OnProcessStart | OnProcessExit):
            return type(handler).__name__, handler.actions
        return type(entity).__name__, ()

    def values(self, entity: Any) -> dict[str, Any]:
        """Return what an action is given, evaluated."""
        _, inner = self.later(entity)
        if isinstance(entity, TimerAction):
            return {"period": vars(entity)["period"]}
        if isinstance(entity, RegisterEventHandler) and inner:
            first = entity.event_handler.target_action
            return {"target_action": self.values(first)}
        if isinstance(entity, RegisterEventHandler):
            return self.kept(entity.event_handler)
        if isinstance(entity, LifecycleNode):
            self.managed.append(entity)
        found = self.kept(entity)
        if isinstance(entity, IncludeLaunchDescription):
            location = entity.launch_description_source.location
            given = entity.launch_arguments
            found["launch_description_source"] = text_of(self.context, location)
            found["launch_arguments"] = [[text_of(self.context, one) for one in it] for it in given]
            given = self.context.launch_configurations
            space, rules = (given.get(it) for it in ("ros_namespace", "ros_remaps"))
            scope = {"namespace": space, "remappings": [[*it] for it in rules or ()]}
            found |= {name: it for name, it in scope.items() if it}
        if isinstance(entity, ExecuteProcess | IncludeLaunchDescription):
            found["environment"] = dict(self.context.environment)
        return found

    def kept(self, it: Kept) -> dict[str, Any]:
        """Return the values that an action keeps, evaluated, by keyword."""
        given = {name: vars(it).get(name) for name in (*it.names, *it.others)}
        return self.evaluated({name: one for name, one in given.items() if name != "condition"})

    def evaluated(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """Return the values that are not None, evaluated."""
        there = {name: it for name, it in given.items() if it is not None}
        own = there.pop("parameters", None)
        found = {name: self.plain(it) for name, it in there.items()}
        if own is not None:
            found["parameters"] = [self.parameters(it) for it in own]
        return found

    def parameters(self, it: Any) -> Any:
        """Return a parameter file or values as plain Python; no file is read."""
        if isinstance(it, ParameterFile):
            return {"param_file": it.path(self.context), "allow_substs": it.allow_substs}
        return self.plain(*evaluate_parameters(self.context, [it]))

    def plain(self, it: Any) -> Any:
        """Return a value as plain Python."""
        if hasattr(it, "perform"):
            return text_of(self.context, it)
        if isinstance(it, PurePath):
            return str(it)
        if isinstance(it, Mapping):
            return {self.plain(key): self.plain(one) for key, one in it.items()}
        if isinstance(it, list | tuple):
            if any(isinstance(one, FindPackage) for one in it):
                return text_of(self.context, it)
            return [self.plain(one) for one in it]
        return self.of_action(it)

    def of_action(self, it: Any) -> Any:
        """Return a value that is not plain; a node with a life cycle is its number."""
        if isinstance(it, LifecycleNode):
            return self.managed.index(it)
        if isinstance(it, ComposableNode):
            texts = {name: getattr(it, name) for name in _OF_COMPONENT}
            there = {name: one for name, one in texts.items() if one}
            given = {
                it.removeprefix("node_"): text_of(self.context, one) for it, one in there.items()
            }
            more = {"parameters": it.parameters or None, "remappings": it.remappings or None}
            return given | self.evaluated(more)
        if isinstance(it, Kept):
            return self.kept(it)
        if callable(it):
            return [number for number, node in enumerate(self.managed) if it(node)]
        return it
