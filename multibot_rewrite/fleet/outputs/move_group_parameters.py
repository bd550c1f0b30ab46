"""What move_group gets of a robot's files, as moveit_configs_utils puts it together for one robot.

Source: moveit2 2.12.4, moveit_configs_utils/moveit_configs_builder.py (``to_dict`` and what it joins).
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.companions.moveit.file_kind import EMPTY, file_kind
from multibot_rewrite.companions.yaml_text import read_yaml

DESCRIPTION = "robot_description"
# The parameter below which a kind of file is; the others are parameters themselves.
_BELOW = MappingProxyType(
    {"kinematics": f"{DESCRIPTION}_kinematics", "joint_limits": f"{DESCRIPTION}_planning"}
)
# Planners are below the first word of their file: ompl_planning.yaml. servo has a node of its own.
_PLANNING, _OTHERS = "planning", ("servo", "initial_positions", EMPTY)


def move_group_parameters(description: str, srdf: str, texts: Mapping[str, str]) -> dict[str, Any]:
    """The parameters of move_group; ``texts`` are the robot's MoveIt files by path.

    Raises InputError for a file that is none.
    """
    found: dict[str, Any] = {DESCRIPTION: description}
    if srdf:
        found[f"{DESCRIPTION}_semantic"] = srdf
    for path, text in texts.items():
        kind, data = file_kind(read_yaml(text.encode(), path)), load_yaml(text)
        if kind in _OTHERS:
            continue
        name = os.path.basename(path).partition("_")[0] if kind == _PLANNING else _BELOW.get(kind)
        below = found.setdefault(name, {}) if name else found
        below.update(data)
    return found
