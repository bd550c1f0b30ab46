# SPDX-License-Identifier: Apache-2.0
"""Parameter files, MoveIt files, behavior trees and Lua files of a fleet: one for each robot."""

import json
import os
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from multibot_rewrite.base.bounded import load_yaml, own_text
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.base.nearest import meant_name
from multibot_rewrite.description.own_ports import numbers_message
from multibot_rewrite.fleet.file.fleet_file import BRINGUP
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import (
    DEFAULTS,
    OPTIONS,
    FilesToCheck,
    OutputFile,
    ReadFile,
    params_of,
    path_for,
    text_of,
    without_slots,
)
from multibot_rewrite.fleet.robots.rewritten_robots import OWN_PORTS
from multibot_rewrite.fleet.robots.robot_groups import RobotGroup, group_robots
from multibot_rewrite.knowledge.node_entries import PORT, RUN_TIME
from multibot_rewrite.knowledge.parameters import KnownNodes, load_known_nodes
from multibot_rewrite.knowledge.records import CARTOGRAPHER
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.evidence.nodes import children_of
from multibot_rewrite.producers.launch.handed_on import HandedOn
from multibot_rewrite.producers.launch.known_node import STATIC
from multibot_rewrite.related_files.context import (
    NUMBER_STEP,
    fill_template,
    make_template,
)
from multibot_rewrite.related_files.formats import made_for_any
from multibot_rewrite.related_files.lua import rewrite_lua
from multibot_rewrite.related_files.named_file import LUA, MOVEIT, PARAMS, TREE, RelatedFile
from multibot_rewrite.related_files.names.node_topics import facts_by_name
from multibot_rewrite.related_files.params.rewrite import rewrite_params, rewrite_values
from multibot_rewrite.related_files.params.shared_defaults import all_sections, missing_defaults
from multibot_rewrite.related_files.params.values import ParamsJob
from multibot_rewrite.related_files.sites import found_in
from multibot_rewrite.related_files.yaml_text import Splice, read_yaml

# The key of a fleet file -> the kind of the files that it names.
_KINDS = {"params": PARAMS, "moveit": MOVEIT, "behavior_trees": TREE, "lua": LUA}


def related_files(plan: FleetPlan) -> FilesToCheck:
    """Yield the related files of all robots; raises InputError if one cannot be rewritten."""
    groups = list(group_robots(plan))
    for key in _KINDS:
        for group in groups:
            for path in group.related_files.get(key, ()):
                yield from _files_for_robots(plan, group, key, path)
    for group in groups:
        yield from _own_options(plan, group)
    yield from launched_values(plan).findings
    if plan.file.params_style != BRINGUP:
        for group in groups:
            yield from () if "params" in group.related_files else _own_defaults(plan, group)


class LaunchedValues(NamedTuple):
    """What launch files set for nodes, by robot and node, and what is wrong with it."""

    values: Mapping[tuple[str, str], Mapping[str, Any]]
    findings: tuple[Finding, ...]


def launched_values(plan: FleetPlan) -> LaunchedValues:
    """Return what launch files set for the nodes of each robot; raises InputError as rcl would."""
    import yaml

    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    values: dict[tuple[str, str], Mapping[str, Any]] = {}
    findings: list[Finding] = []
    numbers = {it.spec.name: at for at, it in enumerate(plan.robots)}
    for group in group_robots(plan):
        evidence = plan.evidence_of(group.robots[0])
        once = {it.name for it in evidence.nodes if it.shared}
        known, bare = _known_nodes(plan, group)
        facts = facts_by_name(group.facts, plan.file.distro)
        job = ParamsJob(read_yaml(b"", ""), group.context, known, facts, (), bare)
        given: dict[str, set[str]] = defaultdict(set)
        for run in evidence.given:
            given[run.node].update(run.values)
        for name, it in evidence.handed_on.items():
            if name in once:
                # It is no robot's: its names stay.
                values |= {(one.spec.name, name): it.values for one in group.robots if it.values}
                continue
            # As a parameter file has them.
            body = {it.kind or name: {"ros__parameters": dict(it.values)}}
            data = yaml.dump(body, None, dumper, sort_keys=False, allow_unicode=True).encode()
            made = rewrite_values(job._replace(document=read_yaml(data, it.place.file)))
            lacking = _missing_names(group, name, it, job.known, given[name])
            if not (it.values or lacking):
                continue
            file, line, *_ = it.place
            findings += (one._replace(file=file, line=line, column=1) for one in made.findings)
            for robot in group.robots:
                spec = robot.spec
                own = spec.namespace, spec.tag, numbers[spec.name]
                text = fill_template(made.template, *own)
                values[spec.name, name] = {
                    **_parameters_in(text, it.place.file),
                    **_parameters_in(
                        fill_template(make_template("", [Splice(0, 0, lacking)]), *own), name
                    ),
                }
    return LaunchedValues(values, tuple(findings))


def _missing_names(
    group: RobotGroup, name: str, it: HandedOn, known: KnownNodes, given: Iterable[str]
) -> str:
    """Return default names of a launched node that robots would share, as parameters with slots."""
    first, *_ = (*group.related_files.get("params", ()), "")
    has_section = name in group.context.nodes and (not first or os.path.realpath(first) in it.files)
    if it.kind not in known.nodes or has_section or it.kind == STATIC:
        return ""
    lines = missing_defaults(group.context, known.nodes[it.kind], {*given, *it.values})
    return "".join(f"{line.path}: {line.value}\n" for line in lines)


def _parameters_in(text: str, file: str) -> Mapping[str, Any]:
    """Return the parameters of the one section of a text."""
    found: Any = load_yaml(text, file) if text else {}
    for section in found.values():
        found = section.get("ros__parameters", found) if isinstance(section, dict) else found
    return dict(found)


def _known_nodes(plan: FleetPlan, group: RobotGroup) -> tuple[KnownNodes, frozenset[str]]:
    """Return what is known of nodes with the frames that they send, and those that prefix frames."""
    evidence = plan.evidence_of(group.robots[0])
    known = load_known_nodes(plan.file.nodes, plan.file.distro)
    bare = _prefixing_nodes(plan.fleet.naming, evidence.given, known)
    links = group.context.names.declared["link"]
    sent = {it for node in evidence.nodes for it in children_of(node)}
    # A frame may be a link with a typing mistake.
    return known._replace(sent=known.sent | {it for it in sent if not meant_name(it, links)}), bare


def _files_for_robots(plan: FleetPlan, group: RobotGroup, key: str, path: str) -> FilesToCheck:
    """Yield a file for each robot of a group, and what is found in it."""
    spec = group.robots[0].spec
    if _KINDS[key] == PARAMS:
        made = _rewritten_params(plan, group, path)
    else:
        text_made = text_of(spec, path)
        made = made_for_any(_KINDS[key], text_made, path, group.context, group.facts)
    # The robots that have a file, counted from 0.
    having = (it for it in plan.robots if path in it.spec.related_files.get(key, ()))
    numbers = {it.spec.name: at for at, it in enumerate(having)}
    # Robots that differ in their descriptions may have one file.
    file = made.file._replace(is_for_one=made.file.is_for_one and len(numbers) == 1)
    yield ReadFile(file, tuple(group.robots))
    yield from (without_slots(it, spec) for it in made.findings)
    # The ports that robots get numbers of their own for.
    for site in made.file.names if len(numbers) > 1 else ():
        if site.kind == PORT and site.text.isdecimal() and int(site.text):
            given = {name: int(site.text) + at * NUMBER_STEP for name, at in numbers.items()}
            message, hint = numbers_message(site.key, given.items())
            yield found_in(made.file.file, site.slot, OWN_PORTS, message, hint)
    for robot in group.robots:
        spec = robot.spec
        text = fill_template(made.template, spec.namespace, spec.tag, numbers[spec.name])
        yield OutputFile(path_for(robot, path), text.encode(), (path,))


def _own_defaults(plan: FleetPlan, group: RobotGroup) -> Iterator[OutputFile]:
    """Yield for each robot without a parameter file the one that its nodes need."""
    known = load_known_nodes(plan.file.nodes, plan.file.distro)
    given = plan.evidence_of(group.robots[0]).given
    text = all_sections(group.context, known, _prefixing_nodes(plan.fleet.naming, given, known))
    template = make_template("", [Splice(0, 0, text)])
    for robot in group.robots if text else ():
        made = fill_template(template, robot.spec.namespace, robot.spec.tag)
        yield OutputFile(path_for(robot, DEFAULTS), made.encode())


def _own_options(plan: FleetPlan, group: RobotGroup) -> Iterator[OutputFile]:
    """Yield for each robot without a Lua file that runs Cartographer its options."""
    for node in plan.evidence_of(group.robots[0]).nodes:
        if node.kind == CARTOGRAPHER and node.usual:
            values = (*((it.parameter, it.default) for it in node.frames), *node.usual)
            lines = "\n  ".join(f"{name} = {json.dumps(value)}," for name, value in values)
            text = own_text(__file__, OPTIONS).replace("-- OPTIONS", lines).encode()
            made = rewrite_lua(text, OPTIONS, group.context)
            for robot in group.robots:
                own = fill_template(made.template, robot.spec.namespace, robot.spec.tag)
                yield OutputFile(path_for(robot, OPTIONS), own.encode())


def _rewritten_params(plan: FleetPlan, group: RobotGroup, path: str) -> RelatedFile:
    """Return a ROS parameter file; what the robot's other parameter files set is not inserted in it."""
    read = params_of(group.robots[0].spec)
    others = [document for it, document in read.items() if it != path]
    known, bare = _known_nodes(plan, group)
    own = group.robots[0].spec.words if len(group.robots) == 1 else ()
    return rewrite_params(
        read[path],
        group.context,
        known,
        others,
        group.facts,
        own,
        bare,
        group.robots[0].spec.use_sim_time,
        path == next(iter(read)),
    )


def _prefixing_nodes(naming: Naming, given: Iterable[Run], known: KnownNodes) -> frozenset[str]:
    """Return nodes that put the robot's name before frames; a rewrite leaves those unchanged."""
    if not naming.layout.at_run_time:
        return frozenset()
    found = set()
    for node in (it for it in given if it.fact.known in known.nodes):
        params = known.nodes[node.fact.known].params
        prefixes = (it for it, value in node.values.items() if value.value and it in params)
        if any(params[it].kind in RUN_TIME for it in prefixes):
            found.add(node.node.rpartition("/")[2])
    return frozenset(found)
