# SPDX-License-Identifier: Apache-2.0
"""What the real launch starts of a built launch file: ``python launched.py FILE [NAME:=VALUE ...]``.

It prints what ``started.py`` prints, which stands in where launch is not installed. No program runs:
launch is the judge of actions, conditions, substitutions, parameters and rules
(``launch_recorder.py``). Packages need not be installed: a launch file of another package is noted with
its arguments. Needs launch and launch_ros.
"""

from __future__ import annotations

import asyncio
import json
import os
import re
import runpy
import sys
import tempfile
from pathlib import Path
from typing import Any

import yaml
from paths import fixture_text

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

# A launch file of another package that does nothing but say with what it was included.
INCLUDED = fixture_text("launched_included.txt")


class Values(yaml.SafeLoader):
    """launch tags lists that were tuples; rcl reads no tags."""


Values.add_constructor(
    "tag:yaml.org,2002:python/tuple", lambda it, node: it.construct_sequence(node)
)
SHARE = re.compile(r"FindPackageShare\('(\w+)'\)")
FILES = re.compile(r"'([\w./]+\.launch\.py)'")


def installed(file: Path, prefix: Path) -> None:
    """Install the packages that the launch file looks for, each with all launch files that it names."""
    text = file.read_text()
    index = prefix / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    for package in set(SHARE.findall(text)):
        (index / package).touch()
        for name in set(FILES.findall(text)):
            for path in (name, f"launch/{name}"):
                made = prefix / "share" / package / path
                made.parent.mkdir(parents=True, exist_ok=True)
                made.write_text(INCLUDED)
    os.environ["AMENT_PREFIX_PATH"] = str(prefix)


def noting_changes(rows: list[dict[str, Any]]) -> None:
    """Note what a launch file asks of lifecycle nodes; each change is done at once."""
    from launch.actions import EmitEvent
    from launch_ros.actions import LifecycleNode
    from launch_ros.events.lifecycle import ChangeState, StateTransition
    from lifecycle_msgs.msg import TransitionEvent

    nodes: list[Any] = []
    starts, emits = LifecycleNode.execute, EmitEvent.execute
    between = {1: ("configuring", "inactive"), 3: ("activating", "active")}

    def execute(self: Any, context: Any) -> Any:
        nodes.append(self)
        return starts(self, context)

    def emit(self: Any, context: Any) -> Any:
        if not isinstance(self.event, ChangeState):
            return emits(self, context)
        for node in (it for it in nodes if self.event.lifecycle_node_matcher(it)):
            space, _, name = node.node_name.rpartition("/")
            rows.append({"change": self.event.transition_id, "node": name, "namespace": space})
            message = TransitionEvent()
            message.start_state.label, message.goal_state.label = between[self.event.transition_id]
            context.emit_event_sync(StateTransition(action=node, msg=message))
        return None

    LifecycleNode.execute, EmitEvent.execute = execute, emit


def start_of(row: dict[str, Any]) -> dict[str, Any]:
    """Return a row of the recorder as ``started.py`` has it."""
    if "change" in row:
        return row
    if row["package"] == "include":
        arguments = json.loads(row["words"][0])
        return {"include": row["executable"], "arguments": arguments}
    if "/" not in row.get("name", "") and not row["package"]:
        return {"command": [row["executable"], *row["words"]]}
    found = {it: row[it] for it in ("package", "executable", "name", "namespace", "rules")}
    values = [parameters_of(it) for it in row["values"]]
    found |= {"parameters": values, "arguments": row.get("own", [])}
    return {**found, "component": True} if "container" in row else found


def parameters_of(made: dict[str, str]) -> dict[str, Any]:
    """Return a file that launch was given, or the values of the file that it made."""
    if made["file"]:
        return {"": made["file"]}
    (section,) = yaml.load(made["text"], Values).values()
    values: dict[str, Any] = section["ros__parameters"]
    return values


def main(file: str, *given: str) -> None:
    import launch_recorder
    from launch import LaunchDescription, LaunchService
    from launch.actions import IncludeLaunchDescription
    from launch.launch_description_sources import AnyLaunchDescriptionSource

    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as prefix:
        installed(Path(file), Path(prefix))
        launch_recorder.record(rows)
        noting_changes(rows)
        service = LaunchService(noninteractive=True)
        words = [tuple(it.split(":=", 1)) for it in given]
        source = IncludeLaunchDescription(AnyLaunchDescriptionSource(file), launch_arguments=words)
        service.include_launch_description(LaunchDescription([source]))
        asyncio.run(launch_recorder.launched(service, rows))
        starts = [start_of(it) for it in rows]
    names = runpy.run_path(file)["ROBOTS"]
    print(json.dumps({"robots": list(names), "starts": starts}))


if __name__ == "__main__":
    main(*sys.argv[1:])
