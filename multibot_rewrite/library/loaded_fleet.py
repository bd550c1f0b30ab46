# SPDX-License-Identifier: Apache-2.0
"""A fleet file for launch scripts: plain values for each robot, without writing files.

from multibot_rewrite import load_fleet

for robot in load_fleet("fleet.yaml").robots:
    Node(package="nav2_amcl", executable="amcl", **robot.node("amcl", "params.yaml"))
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from typing import Any

from multibot_rewrite.base.arguments import checked
from multibot_rewrite.base.findings.finding import ERROR, Finding, RewriteRefused
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import unknown
from multibot_rewrite.checks.build import Outputs, make_outputs
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.fleet.file.fleet_file import FleetFile, read_fleet
from multibot_rewrite.fleet.file.robot_choice import Choice
from multibot_rewrite.fleet.file.robot_spec import Sources
from multibot_rewrite.fleet.fleet import Fleet
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.launch.starts import FleetStarts
from multibot_rewrite.fleet.outputs.output_file import OutputFile
from multibot_rewrite.fleet.robots import start_poses
from multibot_rewrite.fleet.robots.loaded_robot import KeptFiles, LoadedRobot
from multibot_rewrite.fleet.robots.node_names import NodeNames, names_of
from multibot_rewrite.fleet.robots.rewritten_robots import Jobs
from multibot_rewrite.fleet.robots.start_poses import with_start_pose_nodes
from multibot_rewrite.related_files.params.rcl_parameters import check_values
from multibot_rewrite.related_files.yaml_text import YamlText, read_yaml


class LoadedFleet:
    """A fleet file, ready for a launch script; ``robots`` are in its order.

    ``findings`` are warnings about the descriptions and the remap table. It can be copied
    and pickled: the descriptions are included as they were read, other files are read again.
    """

    def __init__(self, plan: FleetPlan) -> None:
        self.plan = plan
        self.file: str = plan.file.file
        self.robots: tuple[LoadedRobot, ...] = tuple(LoadedRobot(self, it) for it in plan.robots)
        said = dict.fromkeys((*plan.of_rewrites, *plan.fleet.table.problems))
        self.findings: tuple[Finding, ...] = tuple(said)
        self._parameters: dict[str, YamlText] = {}
        self.kept = KeptFiles()

    def __repr__(self) -> str:
        return f"LoadedFleet({self.file!r})"

    def __reduce__(self) -> tuple[Callable[..., LoadedFleet], tuple[object, ...]]:
        return _unpickled, (self.plan.file, self.plan.jobs)

    @checked
    def robot(self, name: str) -> LoadedRobot:
        """Return the robot of this name; raises UsageError for another."""
        found = {it.name: it for it in self.robots}
        if name not in found:
            raise UsageError(f"{self.file}: {unknown('robot', name, found)}")
        return found[name]

    @cached_property
    def table(self) -> NodeNames:
        """Names and remappings of the nodes that serve all robots; raises nothing."""
        return names_of(self.planned.table, "")

    @cached_property
    def planned(self) -> Fleet:
        """The fleet with the nodes that publish start poses; raises nothing."""
        return with_start_pose_nodes(self.plan)

    @cached_property
    def placed(self) -> start_poses.StartPoses:
        """The start poses of its robots; raises nothing."""
        return start_poses.start_poses(self.plan)

    @cached_property
    def made(self) -> Outputs:
        """Everything that ``multibot build`` would write, made on first use.

        Raises InputError for a related file that cannot be read, RewriteRefused for one that cannot be
        rewritten.
        """
        made = make_outputs(self.plan)
        _refuse_errors(made.findings)
        return made

    @cached_property
    def _with_full_names(self) -> Mapping[str, OutputFile]:
        """The files of the build, with full names of nodes in parameter files."""
        return {it.path: it for it in self._named_outputs.files}

    @cached_property
    def _named_outputs(self) -> Outputs:
        """The outputs of the build, with parameter files in the usual style."""
        if not self.plan.file.params_style:
            return self.made
        return make_outputs(self.plan._replace(file=self.plan.file._replace(params_style="")))

    @property
    def starts(self) -> FleetStarts:
        """All that the launch file of its build starts; raises as ``made``."""
        return self._named_outputs.starts

    @cached_property
    def files(self) -> Mapping[str, OutputFile]:
        """The files of the build by path, as ``robot1/params.yaml``; raises as ``made``."""
        return {it.path: it for it in self.made.files}

    @checked
    def text(self, path: str) -> str:
        """Return the text of a file; raises UsageError for an unknown path, and as ``made``."""
        if path not in self.files:
            hint = "list it under related_files: in the fleet file"
            raise UsageError(f"{self.file}: {unknown('file', path, self.files)}; {hint}")
        return self.files[path].data.decode()

    def node_text(self, path: str) -> str:
        """Return the text as ``LoadedRobot.node_text``, by path; raises as ``text``."""
        self.text(path)
        return self._with_full_names[path].data.decode()

    @checked
    def parameters(self, path: str) -> YamlText:
        """Return a parameter file; raises as ``text``, InputError for values that rcl rejects."""
        if path not in self._parameters:
            text = self.node_text(path)
            made = {it for one in self.plan.file.robots for it, _ in one.filled}
            for source in (it for it in self.files[path].sources if it not in made):
                check_values(read_yaml(read_file(source), source))
            self._parameters[path] = read_yaml(text.encode(), path)
        return self._parameters[path]


@checked
def load_fleet(
    path: str | os.PathLike[str] | Mapping[str, Any],
    *,
    trust: bool = False,
    distro: str = "",
    robots: str = "",
    count: int = 0,
) -> LoadedFleet:
    """Read a fleet file, rewrite its robots' descriptions and make their tables.

    ``path`` may be what a fleet file holds, as a dict; its paths are relative to the working directory.
    ``robots`` are the robots in place of those of the file, with their poses, as Nav2 writes them:
    ``robot1={x: 1.0, y: 0}; robot2={x: 2.0}``. ``count`` is the number of robots of the one that is a
    pattern.

    ``trust`` lets xacro files do anything; without it they only compute (SECURITY.md). ``distro``
    is the ROS 2 release that the robots run (default: the fleet file's, else ROS_DISTRO, else the
    newest LTS).

    Raises InputError and UsageError for what cannot be read or used, RewriteRefused if two
    robots would get the same name, DefinitionsError and ProofError as ``rewrite`` does.
    """
    source = path if isinstance(path, Mapping) else os.fspath(path)
    file = read_fleet(source, distro, os.environ, Choice(robots, count))
    fleet = LoadedFleet(plan_fleet(file, trust=trust))
    _refuse_errors(fleet.findings)
    return fleet


def _unpickled(file: FleetFile, jobs: Mapping[Sources, Jobs]) -> LoadedFleet:
    """Return the fleet of a pickle, rewritten from the descriptions in it."""
    return LoadedFleet(plan_fleet(file, jobs=jobs))


def _refuse_errors(findings: Iterable[Finding]) -> None:
    wrong = tuple(it for it in findings if it.level == ERROR)
    if wrong:
        raise RewriteRefused(wrong)
