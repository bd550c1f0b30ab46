"""What a release lacks, what is deprecated in it, and what a broadcaster no longer sends in it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import yaml

from multibot_rewrite.companions.params.name_sites import params_at
from multibot_rewrite.companions.params.sections import ParamSection, flattened
from multibot_rewrite.companions.params.values import ParamsJob
from multibot_rewrite.companions.yaml_text import found_at, items, pairs
from multibot_rewrite.findings.finding import NOTE, WARNING, Finding
from multibot_rewrite.findings.rule import declare
from multibot_rewrite.knowledge.records import NodeParameters, Param
from multibot_rewrite.releases import has_release, releases_with

_BROADCASTER = "joint_state_broadcaster"
# What sensor_msgs/JointState has a field for.
_IN_JOINT_STATES = frozenset(("position", "velocity", "effort"))
_GONE_SINCE = "lyrical+"

DEPRECATED = declare(
    "MF129",
    "deprecated-in-release",
    NOTE,
    what="A parameter or controller type is deprecated in the release, or gone.",
    why="The node warns at each start, and a later release removes it: a controller of that type is "
    "then not loaded, and the parameter has no effect.",
    fix="Do what the hint says. A JointGroup controller becomes a "
    "forward_command_controller/ForwardCommandController with interface_name: position, velocity or "
    "effort.",
    bad="""\
controller_manager:
  ros__parameters:
    arm: {type: position_controllers/JointGroupPositionController}
""",
    good="""\
controller_manager:
  ros__parameters:
    arm: {type: forward_command_controller/ForwardCommandController}
""",
    line=3,
    formats=("params",),
    options={"distro": "lyrical"},
)

NOT_SENT = declare(
    "MF130",
    "interfaces-not-published",
    WARNING,
    what="joint_state_broadcaster has interfaces that only dynamic_joint_states had, which it no "
    "longer publishes.",
    why="joint_states has positions, velocities and efforts alone. dynamic_joint_states was off by "
    "default from ros2_controllers 6.5 on and is gone since 6.8, which is in Lyrical: nobody sees the "
    "others.",
    fix="Use a state_interfaces_broadcaster or gpio_controllers for them.",
    bad="""\
joint_state_broadcaster:
  ros__parameters:
    joints: [wheel_joint]
    interfaces: [position, temperature]
""",
    good="""\
joint_state_broadcaster:
  ros__parameters:
    joints: [wheel_joint]
    interfaces: [position, velocity]
""",
    line=4,
    formats=("params",),
    options={"distro": "lyrical"},
)


ELSEWHERE = declare(
    "MF131",
    "parameter-of-another-release",
    NOTE,
    what="A parameter, or its node, is not in the release that is meant.",
    why="The node does not declare it, so the value has no effect. The names in it are rewritten all "
    "the same, since the file may be for another release.",
    fix="Delete it, or set the parameter that the release has in its place. If the file is for another "
    "release, name that one: distro: in the fleet file, or --distro.",
    bad="""\
behavior_server:
  ros__parameters:
    costmap_topic: local_costmap/costmap_raw
""",
    good="""\
behavior_server:
  ros__parameters:
    local_costmap_topic: local_costmap/costmap_raw
""",
    line=3,
    formats=("params",),
    options={"distro": "lyrical"},
)


def release_findings(job: ParamsJob, section: ParamSection) -> Iterator[Finding]:
    """What is to be told of a section for the release that is meant."""
    yield from _deprecated_parameters(job, section)
    yield from _of_another_release(job, section)
    yield from _deprecated_types(job, section.body)
    if section.node is not None and section.node.name == _BROADCASTER:
        yield from _not_sent(job, section.body)


def _deprecated_parameters(job: ParamsJob, section: ParamSection) -> Iterator[Finding]:
    for name, key in flattened(section.body):
        param = section.node.params.get(name) if section.node else None
        if param and param.deprecated and has_release(param.deprecated, job.context.distro):
            there = has_release(param.releases, job.context.distro)
            state = "is deprecated" if there else "is gone and has no effect"
            message = f"{name} {state} in {job.context.distro}"
            hint = f"{param.note}{_source(param.source)}"
            yield found_at(job.document, key, DEPRECATED, message, hint)


def _of_another_release(job: ParamsJob, section: ParamSection) -> Iterator[Finding]:
    """Nodes and parameters that only other releases have; what is called deprecated is told there."""
    node, release = section.node, job.context.distro
    if node is None or section.wild:
        return
    if not has_release(node.facts.releases, release):
        yield _elsewhere(job, section.keys[-1], f"node {node.name}", node.facts)
        return
    for name, key in flattened(section.body):
        found = params_at(node, name, key)
        told = any(it.deprecated and has_release(it.deprecated, release) for it in found)
        if found and not told and not any(has_release(it.releases, release) for it in found):
            yield _elsewhere(job, key, name, found[0])


def _source(places: Sequence[str]) -> str:
    """Where it can be read, as the end of a hint."""
    return f"; source: {places[0]}" if places else ""


def _elsewhere(
    job: ParamsJob, key: yaml.ScalarNode, what: str, known: NodeParameters | Param
) -> Finding:
    others = ", ".join(releases_with(known.releases))
    message = f"{what} is not in {job.context.distro}, only in {others}"
    hint = (
        "delete it, or name the release that the file is for: distro: in the fleet file, --distro"
    )
    return found_at(job.document, key, ELSEWHERE, message, f"{hint}{_source(known.source)}")


def _deprecated_types(job: ParamsJob, body: yaml.Node) -> Iterator[Finding]:
    types = {
        type_: it
        for node in job.known.nodes.values()
        for type_, it in node.facts.deprecated_types.items()
    }
    for key, value in _scalars(body):
        words = types.get(value.value, "") if key.value.rpartition(".")[2] == "type" else ""
        if words and has_release(words, job.context.distro):
            message = f"{value.value} is deprecated in {job.context.distro}"
            hint = "use forward_command_controller/ForwardCommandController with interface_name"
            yield found_at(job.document, value, DEPRECATED, message, hint)


def _not_sent(job: ParamsJob, body: yaml.MappingNode) -> Iterator[Finding]:
    """Interfaces that no topic holds."""
    given = {key.value: value for key, value in pairs(body)}
    mapped = {
        getattr(it, "value", "") for _, it in _scalars(given.get("map_interface_to_joint_state"))
    }
    if not has_release(_GONE_SINCE, job.context.distro):
        return
    for item in items(given.get("interfaces")):
        name = getattr(item, "value", "")
        if name not in _IN_JOINT_STATES | mapped:
            message = f"nobody publishes {name}: joint_states has no field for it"
            hint = "use a state_interfaces_broadcaster for it"
            yield found_at(job.document, item, NOT_SENT, message, hint)


def _scalars(node: yaml.Node | None) -> Iterator[tuple[yaml.ScalarNode, yaml.ScalarNode]]:
    for key, value in pairs(node):
        if isinstance(value, yaml.ScalarNode):
            yield key, value
        else:
            yield from _scalars(value)
