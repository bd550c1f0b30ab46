# SPDX-License-Identifier: Apache-2.0
"""Which nodes a launch file starts, told by the real ``ros2 launch`` with programs that do nothing.

``python launch_recorder.py [--xacro] FILE [NAME:=VALUE ...]`` prints them as JSON, with the values of
their parameter files; ``--xacro`` expands descriptions, else they are empty. It knows nothing of the
project: it is the judge of what the project reads in launch files. Needs launch and launch_ros.
"""

from __future__ import annotations

import asyncio
import json
import os
import shlex
import sys
from pathlib import Path
from typing import Any

import launch_ros.actions as ros_actions
import xacro
import yaml
from launch import LaunchDescription, LaunchService
from launch.actions import IncludeLaunchDescription, TimerAction, execute_local
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch.substitutions import Command, FindExecutable
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.actions.load_composable_nodes import get_composable_node_load_request
from launch_ros.substitutions import ExecutableInPackage
from launch_ros.utilities import evaluate_parameters
from rclpy.parameter import parameter_value_to_python

# They do their work and end, so that what waits for their end starts.
ENDING = {
    *("spawner", "hardware_spawner", "create", "spawn_entity.py", "gz_spawn_model"),
    *("sleep", "xacro", "wait_for_robot_description"),
}
QUIET = float(os.environ.get("RECORDER_QUIET", "5.0"))
Rows = list[dict[str, Any]]


def words_of(command: list[str]) -> dict[str, Any]:
    """Return the name, namespace and rules of a node by its command line, and its own arguments."""
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


def values_of(path: str) -> dict[str, str]:
    """Return a parameter file and its text when a program is started with it; no name if launch
    made it of parameters in the launch file."""
    made = Path(path).name.startswith("launch_params_")
    return {"file": "" if made else path, "text": Path(path).read_text()}


def texts(words: list[str]) -> dict[str, str]:
    """Return the files among the arguments of a program, with what is in them."""
    given = (Path(it) for it in words if it.endswith((".rviz", ".yaml")) or it.startswith("/tmp/"))
    return {str(it): it.read_text() for it in given if it.is_file()}


def expanded(line: str) -> str:
    """Return what ``xacro FILE NAME:=VALUE`` prints; the text of another command is not needed."""
    program, *words = shlex.split(line)
    if Path(program).name != "xacro":
        return "<robot name='r'/>"
    file = next(it for it in words if ":=" not in it)
    given = dict(it.split(":=", 1) for it in words if ":=" in it)
    return str(xacro.process_file(file, mappings=given).toxml())


def record(rows: Rows, with_xacro: bool = False) -> None:
    """From now on launch notes programs and components in ``rows``; it starts none of them."""
    real = execute_local.async_execute_process

    async def started(protocol: Any, cmd: list[str], **options: Any) -> Any:
        package, _, executable = cmd[0].rpartition("|")
        words = cmd[1:]
        if [executable, *words[:1]] == ["ros2", "run"]:
            package, executable, *words = words[1:]
        row = {"package": package, "executable": executable, "words": words, **words_of(words)}
        params = {it: Path(it).read_text() for it in row["files"]}
        values = [values_of(it) for it in row["files"]]
        rows.append({**row, "params": params, "values": values, "texts": texts(row["own"])})
        program = ["true"] if executable in ENDING else ["sleep", "600"]
        return await real(protocol, cmd=program, **{**options, "shell": False})

    def found(self: Any, context: Any) -> str:
        words = (perform_substitutions(context, it) for it in (self.package, self.executable))
        return "|".join(words)

    execute_local.async_execute_process = started
    ExecutableInPackage.perform = found
    Command.perform = lambda self, context: (
        expanded(perform_substitutions(context, self.command))
        if with_xacro
        else "<robot name='r'/>"
    )
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
                    "values": parameters_of(it, context),
                    "parameters": [
                        [it.name, plain(parameter_value_to_python(it.value))]
                        for it in getattr(request, "parameters", ())
                    ],
                }
            )


def parameters_of(component: Any, context: Any) -> list[Any]:
    """Return the parameters of a component, as parameter files would have them."""
    given = evaluate_parameters(context, component.parameters or ())
    return [
        values_of(str(it))
        if isinstance(it, Path)
        else {"file": "", "text": yaml.safe_dump({"/**": {"ros__parameters": plain(it)}})}
        for it in given
    ]


def plain(values: Any) -> Any:
    """Parameters without the types of launch, which YAML cannot write."""
    return json.loads(json.dumps(values, default=list))


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
    file, *given = (it for it in sys.argv[1:] if it != "--xacro")
    started: Rows = []
    record(started, "--xacro" in sys.argv)
    service = LaunchService(noninteractive=True)
    source = AnyLaunchDescriptionSource(file)
    arguments = [tuple(it.split(":=", 1)) for it in given]
    include = IncludeLaunchDescription(source, launch_arguments=arguments)
    service.include_launch_description(LaunchDescription([include]))
    asyncio.run(launched(service, started))
    print(json.dumps(started, indent=1, default=str))
