# SPDX-License-Identifier: Apache-2.0
"""What a release lacks, what is deprecated in it, and what a broadcaster no longer sends in it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import yaml

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding, rule
from multibot_rewrite.base.releases import has_release, releases_with
from multibot_rewrite.knowledge.records import NodeParameters, Param
from multibot_rewrite.related_files.named_file import PARAMS, NamedFile
from multibot_rewrite.related_files.params.name_sites import params_at
from multibot_rewrite.related_files.params.sections import flattened, scalars
from multibot_rewrite.related_files.yaml_text import items, pairs
from multibot_rewrite.rules.declaration import remark_at
from multibot_rewrite.rules.files.declared import of_other_releases

_FORWARD = "forward_command_controller/ForwardCommandController"
_BROADCASTER = "joint_state_broadcaster"
# What sensor_msgs/JointState has a field for.
_IN_JOINT_STATES = frozenset(("position", "velocity", "effort"))


@rule("MB869", "deprecated-in-release", NOTE, formats=(PARAMS,), options={"distro": "lyrical"})
def deprecated(file: NamedFile) -> Iterator[Finding]:
    """Report parameters of known nodes, and types of controllers."""
    release, nodes = file.context.distro, file.known.nodes.values() if file.known else ()
    types = {name: it for node in nodes for name, it in node.deprecated_types.items()}
    for section, _ in file.pages:
        for name, key in flattened(section.body):
            param = section.node.params.get(name) if section.node else None
            if param and param.deprecated and has_release(param.deprecated, release):
                there = has_release(param.releases, release)
                state = "is deprecated" if there else "is gone and has no effect"
                message = f"{name} {state} in {release}"
                instead = f"use {' or '.join(param.instead)}" if param.instead else "delete it"
                yield remark_at(key, message, f"{instead}{_source(param.source)}")
        for key, value in scalars(section.body):
            words = types.get(value.value, "") if key.value.rpartition(".")[2] == "type" else ""
            if words and has_release(words, release):
                message = f"{value.value} is deprecated in {release}"
                interface = value.value.partition("_")[0]
                hint = f"use {_FORWARD} with interface_name: {interface}"
                yield remark_at(value, message, hint)


@rule(
    "MB871", "interfaces-not-published", WARNING, formats=(PARAMS,), options={"distro": "lyrical"}
)
def not_sent(file: NamedFile) -> Iterator[Finding]:
    """Report interfaces of joint_state_broadcaster that no topic holds."""
    if not has_release("lyrical+", file.context.distro):
        return
    nodes = ((section.node, section.body) for section, _ in file.pages)
    for body in (it for node, it in nodes if node is not None and node.name == _BROADCASTER):
        given = {key.value: value for key, value in pairs(body)}
        words = scalars(given.get("map_interface_to_joint_state"))
        mapped = {getattr(it, "value", "") for _, it in words}
        for item in items(given.get("interfaces")):
            name = getattr(item, "value", "")
            if name not in _IN_JOINT_STATES | mapped:
                message = f"no node publishes {name}: joint_states has no field for it"
                hint = "use a state_interfaces_broadcaster for it"
                yield remark_at(item, message, hint)


@rule(
    "MB870", "parameter-of-another-release", NOTE, formats=(PARAMS,), options={"distro": "lyrical"}
)
def of_another_release(file: NamedFile) -> Iterator[Finding]:
    """Report nodes and parameters that only other releases have."""
    yield from elsewhere(file)


def elsewhere(file: NamedFile) -> Iterator[Finding]:
    """Yield the nodes and parameters of a file that its release lacks and another one has."""
    release = file.context.distro
    for section, node in ((it, it.node) for it, _ in file.pages if not it.wild):
        if node is None:
            continue
        if not has_release(node.releases, release):
            yield _of_other_release(section.keys[-1], f"node {node.name}", node, release)
            continue
        for name, key in flattened(section.body):
            found = params_at(node, name, key)
            # What is called deprecated is told there.
            told = any(it.deprecated and has_release(it.deprecated, release) for it in found)
            if found and not told and not any(has_release(it.releases, release) for it in found):
                yield _of_other_release(key, name, found[0], release)
    yield from of_other_releases(file)


def _source(places: Sequence[str]) -> str:
    """Return where it can be read, as the end of a hint."""
    return f"; source: {places[0]}" if places else ""


def _of_other_release(
    key: yaml.ScalarNode, what: str, known: NodeParameters | Param, release: str
) -> Finding:
    others = ", ".join(releases_with(known.releases))
    message = f"{what} is not in {release}, only in {others}"
    hint = (
        "delete it, or name the release that the file is for: distro: in the fleet file, --distro"
    )
    return remark_at(key, message, f"{hint}{_source(known.source)}")
