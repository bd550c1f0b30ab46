# SPDX-License-Identifier: Apache-2.0
"""``python watch.py FOLDER FILE [NAME:=VALUE ...]``: start a launch file with stubs for its programs.

It is run by ``running.py`` in a process of its own, which can write in FOLDER alone. Every package and
program that the launch file asks for is there as soon as it is asked for; launch itself, its actions,
conditions, substitutions and events are the real ones. Needs launch and launch_ros.
"""

from __future__ import annotations

import asyncio
import json
import os
import re
import signal
import sys
import time
import types
from pathlib import Path
from typing import Any, NamedTuple

STUB = Path(__file__).with_name("stub.py")
# Seconds without a new process after which a launch file has started what it starts: more if the
# machine is busy.
QUIET = 1.5 * min(4.0, max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1)))
# Ends of processes that are waited for, one after the other.
ROUNDS = 20
# Programs that a shell is, and what runs as it is.
SHELLS = {"sh", "bash", "dash"}
# The launch configuration that says after how many seconds something starts.
DELAY = "bringup_delay"
# What begins a command in a line of a shell.
COMMANDS = re.compile(r"(?:^|&&|\|\||[;|&(])\s*(?:exec\s+|source\s+\S+\s*&&\s*)?([\w.+-]+)")


def note(rows: Path, row: dict[str, Any]) -> None:
    """Write a row that no program writes."""
    (rows / f"{time.time_ns()}.json").write_text(json.dumps(row, default=str))


class Prefix:
    """An install folder in which packages and programs appear when they are asked for."""

    def __init__(self, folder: Path) -> None:
        """Take ``install`` and ``bin`` below a folder."""
        self.install, self.bin = folder / "install", folder / "bin"
        self.installed = [Path(it) for it in os.environ["AMENT_PREFIX_PATH"].split(os.pathsep)]
        self.index = self.install / "share" / "ament_index" / "resource_index" / "packages"

    def package(self, name: str) -> str:
        """Return the prefix of a package; one that is not here is an empty folder from now on."""
        if not re.fullmatch(r"[a-zA-Z0-9][\w-]+", name):
            raise ValueError(f"{name!r} is not a valid package name")
        for prefix in self.installed:
            if (prefix / self.index.relative_to(self.install) / name).exists():
                return str(prefix)
        (self.index / name).touch()
        (self.install / "share" / name).mkdir(exist_ok=True)
        return str(self.install)

    def program(self, package: str, name: str) -> str:
        """Return the path of a program of a package."""
        return self._made(self.install / "lib" / package / name)

    def command(self, name: str) -> str:
        """Return the path of a program on PATH."""
        return self._made(self.bin / Path(name).name)

    def _made(self, path: Path) -> str:
        if not path.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f"#!{sys.executable} -IS\n{STUB.read_text()}")
            path.chmod(0o755)
        return str(path)


def without_composition() -> None:
    """Give launch_ros the type of the service that loads components, where it is not installed."""
    try:
        from composition_interfaces.srv import LoadNode  # noqa: F401
    except ImportError:
        empty = dict.fromkeys(("package_name", "plugin_name", "node_name", "node_namespace"), "")
        lists = dict.fromkeys(("remap_rules", "parameters", "extra_arguments"), ())
        request = type("Request", (types.SimpleNamespace,), {**empty, **lists})
        service = types.ModuleType("composition_interfaces.srv")
        vars(service).update(LoadNode=type("LoadNode", (), {"Request": request}))
        package = types.ModuleType("composition_interfaces")
        vars(package).update(srv=service)
        sys.modules |= {package.__name__: package, service.__name__: service}


def with_frontends() -> None:
    """Let launch files in XML and YAML be read, where launch is on PYTHONPATH and not installed."""
    import launch_xml
    import launch_yaml
    from launch.frontend import Parser

    Parser.extensions_loaded = True
    Parser.frontend_parsers = {"xml": launch_xml.Parser, "yaml": launch_yaml.Parser}


def with_packages(prefix: Prefix) -> None:
    """Let every package and every program of one be found."""
    import ament_index_python
    from ament_index_python import packages
    from launch.substitutions import Command, FindExecutable
    from launch.utilities import perform_substitutions
    from launch_ros.substitutions import ExecutableInPackage, find_package

    for module in (packages, ament_index_python, find_package):
        module.get_package_prefix = prefix.package

    def found(self: Any, context: Any) -> str:
        name = perform_substitutions(context, self.executable)
        return prefix.program(perform_substitutions(context, self.package), name)

    answer = Command.perform

    def answered(self: Any, context: Any) -> str:
        for name in COMMANDS.findall(perform_substitutions(context, self.command)):
            prefix.command(name)
        os.environ["BRINGUP_ASKED"] = "answer"
        try:
            return str(answer(self, context))
        finally:
            os.environ["BRINGUP_ASKED"] = "1"

    Command.perform = answered
    ExecutableInPackage.perform = found
    FindExecutable.perform = lambda self, context: prefix.command(
        perform_substitutions(context, self.name)
    )


def with_descriptions() -> None:
    """Let a description that cannot be expanded here be an empty one."""
    import xacro

    real = xacro.process_file

    def processed(*args: Any, **options: Any) -> Any:
        try:
            return real(*args, **options)
        except Exception:
            from xml.dom.minidom import parseString

            return parseString('<robot name="not_expanded"/>')

    xacro.process_file = processed


def with_files(prefix: Prefix) -> None:
    """Let a parameter file of a package that is not here be an empty one."""
    from launch_ros.parameter_descriptions import ParameterFile

    real = ParameterFile.evaluate

    def evaluate(self: Any, context: Any) -> Path:
        path = Path(real(self, context))
        if not path.exists() and path.is_relative_to(prefix.install / "share"):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text("{}\n")
        return path

    ParameterFile.evaluate = evaluate


def with_includes(prefix: Prefix, rows: Path) -> None:
    """Note launch files of packages that are not here, with their arguments."""
    from launch.actions import IncludeLaunchDescription
    from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

    real = IncludeLaunchDescription.execute

    def text(context: Any, value: Any) -> str:
        return str(perform_substitutions(context, normalize_to_list_of_substitutions(value)))

    def execute(self: Any, context: Any) -> Any:
        source = self.launch_description_source
        place = Path(text(context, source._LaunchDescriptionSource__location))
        if place.exists() or not place.is_relative_to(prefix.install / "share"):
            return real(self, context)
        package, *inside = place.relative_to(prefix.install / "share").parts
        given = {text(context, name): text(context, it) for name, it in self.launch_arguments}
        inside_space = context.launch_configurations.get("ros_namespace", "")
        note(
            rows,
            {
                "include": "/".join(inside),
                "package": package,
                "arguments": given,
                "namespace": inside_space,
            },
        )
        return []

    IncludeLaunchDescription.execute = execute


def with_components(rows: Path) -> None:
    """Note components in place of loading them; a lifecycle node is a node, and changes at once."""
    from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
    from launch_ros.actions import (
        ComposableNodeContainer,
        LifecycleNode,
        LifecycleTransition,
        LoadComposableNodes,
        Node,
    )
    from launch_ros.actions.load_composable_nodes import get_composable_node_load_request
    from rclpy.parameter import parameter_value_to_python

    def load(self: Any, context: Any) -> None:
        own = "_LoadComposableNodes__"
        target = getattr(self, f"{own}target_container")
        name = (
            target.node_name
            if isinstance(target, ComposableNodeContainer)
            else perform_substitutions(context, normalize_to_list_of_substitutions(target))
        )
        for it in getattr(self, f"{own}composable_node_descriptions"):
            request = get_composable_node_load_request(it, context)
            if request is None:
                continue
            values = {it.name: parameter_value_to_python(it.value) for it in request.parameters}
            note(
                rows,
                {
                    "component": request.plugin_name,
                    "package": request.package_name,
                    "name": request.node_name,
                    "namespace": request.node_namespace,
                    "rules": [rule.split(":=", 1) for rule in request.remap_rules],
                    "parameters": values,
                    "container": name,
                },
            )

    LoadComposableNodes.execute = load
    LifecycleNode.execute = Node.execute
    LifecycleTransition.execute = lambda self, context: None


class Watched(NamedTuple):
    """The processes of a launch: those that run, and of each what its command line does not show."""

    running: dict[int, Any]
    started: list[tuple[Any, dict[str, Any]]]


def with_programs(prefix: Prefix, watched: Watched) -> None:
    """Let every command be a stub, and nothing wait for a time."""
    from launch.actions import (
        ExecuteLocal,
        SetLaunchConfiguration,
        TimerAction,
        UnsetLaunchConfiguration,
        execute_local,
    )
    from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

    real = execute_local.async_execute_process
    begin = ExecuteLocal.execute

    async def started(protocol: Any, cmd: Any, shell: bool = False, **options: Any) -> Any:
        environ = {**(options.pop("env", None) or os.environ)}
        environ.pop("BRINGUP_ASKED", None)
        words = [cmd] if isinstance(cmd, str) else [str(it) for it in cmd]
        if shell or Path(words[0]).name in SHELLS:
            for name in COMMANDS.findall(" ".join(words) if shell else words[-1]):
                prefix.command(name)
            cmd = words if shell else [f"/bin/{Path(words[0]).name}", *words[1:]]
        elif not Path(words[0]).is_relative_to(prefix.install):
            cmd = [prefix.command(words[0]), *words[1:]]
        if not Path(options.get("cwd") or "/").is_dir():
            options["cwd"] = None
        return await real(protocol, cmd=cmd, shell=shell, env=environ, **options)

    def execute(self: Any, context: Any) -> Any:
        found = begin(self, context)
        watched.running[id(self)] = self
        again = {"respawn": "yes"} if self._ExecuteLocal__respawn is True else {}
        delay = context.launch_configurations.get(DELAY, "")
        watched.started.append((self, again | ({"delay": delay} if delay else {})))
        return found

    def at_once(self: Any, context: Any) -> Any:
        period = self._TimerAction__period
        if not isinstance(period, (int, float)):
            period = perform_substitutions(context, normalize_to_list_of_substitutions(period))
        mark = SetLaunchConfiguration(DELAY, str(float(period)))
        return [mark, *self.actions, UnsetLaunchConfiguration(DELAY)]

    execute_local.async_execute_process = started
    ExecuteLocal.execute = execute
    TimerAction.execute = at_once


def is_shutdown(action: Any) -> bool:
    """Return whether an action ends the launch."""
    from launch.actions import EmitEvent, Shutdown
    from launch.events import Shutdown as Ended

    return isinstance(action, Shutdown) or (
        isinstance(action, EmitEvent) and isinstance(action.event, Ended)
    )


def is_meant(handler: Any) -> bool:
    """Return whether an end is waited for by the launch file, to do more than to stop."""
    from launch.actions import ExecuteLocal

    own = "_OnActionEventBase__"
    actions = getattr(handler, f"{own}actions_on_event", ())
    if actions:
        return any(it is not None and not is_shutdown(it) for it in actions)
    call = getattr(handler, f"{own}on_event", None)
    return call is not None and not isinstance(getattr(call, "__self__", None), ExecuteLocal)


def end_awaited(context: Any, running: dict[int, Any]) -> bool:
    """End the processes whose end the launch file waits for; return whether there was one."""
    from launch.event_handlers import OnExecutionComplete, OnProcessExit
    from launch.events import ExecutionComplete
    from launch.events.process import ProcessExited

    waiting = [
        it
        for it in context._event_handlers
        if isinstance(it, (OnProcessExit, OnExecutionComplete)) and is_meant(it)
    ]
    ended = False
    for key, action in list(running.items()):
        transport = getattr(action, "_subprocess_transport", None)
        if transport is None or transport.get_returncode() is not None:
            continue
        words = {"action": action, "name": "", "cmd": [], "cwd": "", "env": {}, "pid": 1}
        events = (ProcessExited(returncode=0, **words), ExecutionComplete(action=action))
        if any(handler.matches(event) for handler in waiting for event in events):
            action._ExecuteLocal__respawn = False
            os.kill(transport.get_pid(), signal.SIGUSR1)
            del running[key]
            ended = True
    return ended


async def launched(service: Any, rows: Path, watched: Watched) -> None:
    """Run the launch until nothing more starts; what runs ends with this process."""
    task = asyncio.ensure_future(service.run_async())
    for number in range(ROUNDS):
        before = (-1, -1)
        while before != (now := (len(watched.started), len(os.listdir(rows)))) and not task.done():
            before = now
            await asyncio.sleep(QUIET)
        if task.done() and task.result() and not number:
            note(rows, {"failed": True})
        if task.done() or not end_awaited(service.context, watched.running):
            break
    for action, facts in watched.started:
        if facts and action._subprocess_transport is not None:
            note(rows, {"facts": facts, "of": action._subprocess_transport.get_pid()})


def main(folder: str, file: str, *given: str) -> None:
    """Run the launch file."""
    without_composition()
    from launch import LaunchDescription, LaunchService
    from launch.actions import IncludeLaunchDescription
    from launch.launch_description_sources import AnyLaunchDescriptionSource

    rows, prefix, watched = Path(folder, "rows"), Prefix(Path(folder)), Watched({}, [])
    with_frontends()
    with_packages(prefix)
    with_descriptions()
    with_files(prefix)
    with_includes(prefix, rows)
    with_components(rows)
    with_programs(prefix, watched)
    note(rows, {"base": dict(os.environ)})
    os.environ["BRINGUP_ASKED"] = "1"
    service = LaunchService(noninteractive=True)
    words = [tuple(it.split(":=", 1)) for it in given]
    source = IncludeLaunchDescription(AnyLaunchDescriptionSource(file), launch_arguments=words)
    service.include_launch_description(LaunchDescription([source]))
    asyncio.run(launched(service, rows, watched))
    os._exit(0)


if __name__ == "__main__":
    main(*sys.argv[1:])
