# SPDX-License-Identifier: Apache-2.0
"""The parameter files that a build wrote -> the parameters that each node of the plan has by them."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.fleet.outputs.params_style import ZONES
from multibot_rewrite.producers.evidence.parameter_files import named_values
from multibot_rewrite.related_files.params.sections import PARAMETERS
from multibot_rewrite.related_files.yaml_text import YamlText, pairs, read_yaml
from multibot_rewrite.system.parameters import parameter_text
from multibot_rewrite.system.records import Parameter, System, nodes_by_robot

# A launch file replaces these; the last ones stand alone (nav2_bringup bringup_launch.py, kilted+).
_PLACEHOLDERS = ("$(", "${", "<", *ZONES)


def with_built(plan: System, folder: str) -> System:
    """Return the plan with the parameters in the files of ``folder``; raises InputError as rcl."""
    # The folder has one for each robot. What the plan says of a node comes first.
    nodes = nodes_by_robot(plan)
    found = (
        it for robot in plan.robots
        for it in _parameters_of_robot(robot.space, nodes[robot.name], os.path.join(folder, robot.name))
    )  # fmt: skip
    built: dict[str, dict[str, Parameter]] = {}
    for node, parameters in found:
        known = built.setdefault(node, {})
        for name, it in parameters.items():
            # Two files may be for two ways to start a node: what they agree on is planned.
            other = known.setdefault(name, it)
            if other.value != it.value:
                known[name] = it._replace(value="")
    said = {(it.node, it.name) for it in plan.parameters}
    made = (it for parameters in built.values() for it in parameters.values() if it.value)
    more = (it for it in made if (it.node, it.name) not in said)
    return plan._replace(parameters=(*plan.parameters, *more))


def _parameters_of_robot(
    space: str, nodes: Sequence[str], folder: str
) -> Iterator[tuple[str, dict[str, Parameter]]]:
    """Yield (node, parameters by name) for the nodes in the YAML files of a folder."""
    for name in sorted(os.listdir(folder)) if os.path.isdir(folder) else ():
        path = os.path.join(folder, name)
        data = read_file(path) if name.endswith((".yaml", ".yml")) else b""
        if PARAMETERS.encode() in data:
            document = read_yaml(data, path)
            names = _full_names_in_file(document, space, nodes)
            for node, values in named_values(document, names):
                found = {}
                for key, (value, place) in values.items():
                    every = value if isinstance(value, list) else [value]
                    texts = [it for it in every if isinstance(it, str)]
                    if not any(it in text for text in texts for it in _PLACEHOLDERS):
                        found[key] = Parameter(names[node], key, parameter_text(value), place)
                yield names[node], found


def _full_names_in_file(document: YamlText, space: str, nodes: Sequence[str]) -> dict[str, str]:
    """Return full names of a robot's nodes by the names that a file has for them."""
    # For nav2_bringup they are below the namespace; all others begin with a slash.
    if any(key.value.startswith("/") for key, _ in pairs(document.root)):
        return {it: it for it in nodes}
    above = f"/{space}"
    return {it.removeprefix(above): it for it in nodes if it.startswith(f"{above}/")}
