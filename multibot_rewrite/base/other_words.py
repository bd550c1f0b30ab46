# SPDX-License-Identifier: Apache-2.0
"""Words that people write for what is called otherwise here: commands, options, keys of a fleet file.

"Did you mean" compares letters; these have the meaning and other letters.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

# A word in a command's place -> what does it, as it is typed.
COMMANDS: Mapping[str, str] = MappingProxyType(
    {
        "arguments": "multibot inspect FILE.xacro",
        "coverage": "multibot inspect PATH...",
        "vocabulary": "multibot inspect [NAME]",
        "explain": "multibot inspect CODE",
        "learn": "multibot snapshot --form nodes",
        "doctor": "multibot check without a PLAN",
        "diagnose": "multibot check without a PLAN",
        "lint": "urdf-lint PATH...",
        "remap": "multibot plan INPUT ROBOT... --form table",
        "zenoh": "multibot build, with the key zenoh in the fleet file",
        "rewrite": "urdf-postfix INPUT ROBOT...",
        "postfix": "urdf-postfix INPUT ROBOT...",
        "prefix": "urdf-postfix INPUT ROBOT... --affix prefix",
        "strip": "urdf-postfix FILE ROBOT --undo",
        "undo": "multibot build FLEET --undo, or urdf-postfix FILE ROBOT --undo",
        "clean": "multibot build FLEET --undo",
        "new": "multibot init PATH",
        "create": "multibot init PATH",
        "generate": "multibot build FLEET",
        "make": "multibot build FLEET",
        "launch": "ros2 launch out/fleet.launch.py, which multibot build writes",
        "run": "ros2 launch out/fleet.launch.py, which multibot build writes",
        "start": "ros2 launch out/fleet.launch.py, which multibot build writes",
        "up": "ros2 launch out/fleet.launch.py, which multibot build writes",
        "simulate": "multibot rehearse FLEET, or ros2 launch out/fleet.launch.py with Gazebo",
        "test": "multibot rehearse FLEET",
        "verify": "multibot check PLAN",
        "watch": "multibot check PLAN --watch",
        "why": "urdf-postfix --why FILE:LINE",
        "diff": "multibot check BEFORE.json --from AFTER.json, or urdf-postfix --diff",
        "compare": "multibot check BEFORE.json --from AFTER.json",
        "bag": "multibot check --from BAG",
        "report": "multibot check PLAN --report FILE",
        "graph": "multibot snapshot",
        "record": "multibot snapshot -o FILE",
        "split": "multibot join FILE --undo -o FOLDER",
        "show": "multibot view FLEET",
        "visualize": "multibot view FLEET",
        "rviz": "multibot view FLEET",
    }
)
# An option that no command has -> what does it. A command's own options are not looked up.
OPTIONS: Mapping[str, str] = MappingProxyType(
    {
        "--again": "--force",
        "--undo": "urdf-postfix FILE ROBOT --undo, or multibot build FLEET --undo",
        "--revert": "--undo, where a command has it",
        "--strip": "urdf-postfix FILE ROBOT --undo",
        "--split": "multibot join FILE --undo -o FOLDER",
        "--changes": "urdf-postfix --form changes -o FILE",
        "--snapshot": "--from FILE",
        "--bag": "--from BAG",
        "--zenoh": "--from ROUTER",
        "--jobs": "taskset, or the quota of a container",
        "--groups": "--separator group=_",
        "--shared-frames": "--shared FRAME,FRAME",
        "--shared-topics": "--shared /TOPIC,/TOPIC",
        "--topic": "--expect /TOPIC",
        "--lint": "the command urdf-lint",
        "--prefix": "--affix prefix",
        "--postfix": "--affix postfix",
        "--suffix": "--affix postfix",
        "--frame-prefix": "--layout frame-prefix",
        "--namespace": "--topics namespace",
        "--out": "-o PATH",
        "--out-dir": "-o PATH",
        "--dry-run": "--check or --diff, where a command has it",
        "--overwrite": "--force",
        "--inplace": "--in-place",
        "--description": "the description as the first word",
        "--fleet": "the fleet file as the first word",
        "--plan": "the plan as the first word",
        "--number": "-n COUNT",
        "--ros-distro": "--distro NAME",
        "--release": "--distro NAME",
        "--fail": "--fail-on LEVEL",
        "--no-color": "--color never",
        "--json": "--format json",
        "--sarif": "--format sarif",
        "--sros2": "multibot plan FLEET --form sros2",
    }
)
# A key that a fleet file does not have -> the key that does it.
KEYS: Mapping[str, str] = MappingProxyType(
    {
        "urdf": "description",
        "xacro": "description",
        "sdf": "description",
        "model": "description",
        "robot_description": "description",
        "args": "arguments",
        "xacro_args": "arguments",
        "parameters": "params",
        "params_file": "params",
        "rviz_config": "rviz",
        "position": "pose",
        "initial_pose": "pose",
        "start_pose": "pose",
        "ros_distro": "distro",
        "release": "distro",
        "sim": "simulator",
        "gazebo": "simulator",
        "sim_time": "use_sim_time",
        "prefix": "affix",
        "postfix": "affix",
        "suffix": "affix",
        "ns": "namespace",
        "nodes_file": "nodes",
        "stacks": "stack",
    }
)
