"""Which nodes a launch file starts, told by the real ``ros2 launch`` with programs that do nothing.

``python launch_recorder.py FILE [NAME:=VALUE ...]`` prints them as JSON. It knows nothing of the
project:
it is the judge of what the project reads in launch files. Needs launch and launch_ros.
"""

from __future__ import annotations

import asyncio
import json
import os
import sys
from pathlib import Path
from typing import Any

import launch_ros.actions as ros_actions
from launch import LaunchDescription, LaunchService
from launch.actions import IncludeLaunchDescription, TimerAction, execute_local
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch.substitutions import Command, FindExecutable
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.actions.load_composable_nodes import get_composable_node_load_request
from launch_ros.substitutions import ExecutableInPackage
from rclpy.parameter import parameter_value_to_python

# They do their work and end, so that what waits for their end starts.
ENDING = {
    *("spawner", "hardware_spawner", "create", "spawn_entity.py", "gz_spawn_model"),
    *("sleep", "xacro", "wait_for_robot_description"),
}
QUIET = float(os.environ.get("RECORDER_QUIET", "5.0"))
Rows = list[dict[str, Any]]


def words_of(command: list[str]) -> dict[str, Any]:
    """The name, namespace and rules of a node by its command line, and its own arguments."""
    found: dict[str, Any] = {"name": "", "namespace": "", "rules": [], "files": [], "own": []}
    inside, words = False, iter(command)
    for word in words:
        if word in ("--ros-args", "--"):
            inside = word == "--ros-args"
        elif not inside:
            found["own"].append(word)
        elif word == "--params-file":
            found["files"].append(next(words))
        elif word in ("-r", "--remap"):
            old, _, new = next(words).partition(":=")
            key = {"__node": "name", "__ns": "namespace"}.get(old)
            if key:
                found[key] = new
            else:
                found["rules"].append([old, new])
    return found


def record(rows: Rows) -> None:
    """From now on launch notes programs and components in ``rows``; it starts none of them."""
    real = execute_local.async_execute_process

    async def started(protocol: Any, cmd: list[str], **options: Any) -> Any:
        package, _, executable = cmd[0].rpartition("|")
        words = cmd[1:]
        if [executable, *words[:1]] == ["ros2", "run"]:
            package, executable, *words = words[1:]
        told = words_of(words)
        texts = {file: Path(file).read_text() for file in told["files"]}
        row = {"package": package, "executable": executable, "words": words, "texts": texts}
        rows.append({**row, **told})
        program = ["true"] if executable in ENDING else ["sleep", "600"]
        return await real(protocol, cmd=program, **{**options, "shell": False})

    def found(self: Any, context: Any) -> str:
        words = (perform_substitutions(context, it) for it in (self.package, self.executable))
        return "|".join(words)

    execute_local.async_execute_process = started
    ExecutableInPackage.perform = found
    Command.perform = lambda self, context: "<robot name='r'/>"
    FindExecutable.perform = lambda self, context: perform_substitutions(context, self.name)
    TimerAction.execute = lambda self, context: self.actions
    ros_actions.LifecycleNode.execute = ros_actions.Node.execute
    ros_actions.LoadComposableNodes.execute = lambda self, context: load(self, context, rows)


def load(action: Any, context: Any, rows: Rows) -> None:
    """Note the components that an action would load."""
    own = "_LoadComposableNodes__"
    target = getattr(action, f"{own}target_container")
    if isinstance(target, ros_actions.ComposableNodeContainer):
        container = target.node_name
    else:
        container = perform_substitutions(context, normalize_to_list_of_substitutions(target))
    for it in getattr(action, f"{own}composable_node_descriptions"):
        request = get_composable_node_load_request(it, context)
        if request is not None:
            rows.append(
                {
                    "package": request.package_name,
                    "executable": request.plugin_name,
                    "name": getattr(request, "node_name", ""),
                    "namespace": getattr(request, "node_namespace", ""),
                    "rules": [rule.split(":=", 1) for rule in getattr(request, "remap_rules", ())],
                    "container": container,
                    "parameters": [
                        [it.name, plain(parameter_value_to_python(it.value))]
                        for it in getattr(request, "parameters", ())
                    ],
                }
            )


def plain(value: Any) -> Any:
    """A parameter's value as JSON has it."""
    return value if isinstance(value, str | bool | int | float) else list(value or ())


async def quiet(rows: Rows) -> None:
    """Until nothing more is started."""
    before = -1
    while len(rows) != before:
        before = len(rows)
        await asyncio.sleep(QUIET)


async def launched(service: LaunchService, rows: Rows) -> None:
    """Run the launch until it is quiet, and stop it."""
    running = asyncio.ensure_future(service.run_async())
    await quiet(rows)
    stopping = service.shutdown()
    if stopping is not None:
        await stopping
    await asyncio.wait([running], timeout=20)


if __name__ == "__main__":
    file, *given = sys.argv[1:]
    started: Rows = []
    record(started)
    service = LaunchService(noninteractive=True)
    source = AnyLaunchDescriptionSource(file)
    arguments = [tuple(it.split(":=", 1)) for it in given]
    include = IncludeLaunchDescription(source, launch_arguments=arguments)
    service.include_launch_description(LaunchDescription([include]))
    asyncio.run(launched(service, started))
    print(json.dumps(started, indent=1))
