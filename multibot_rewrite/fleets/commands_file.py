"""``commands.md``: the commands that place, spawn and drive each robot of a fleet, and open RViz."""

from __future__ import annotations

from collections.abc import Iterable

from multibot_rewrite.fleets import spawn, teleop
from multibot_rewrite.fleets.fleet_plan import FleetPlan
from multibot_rewrite.fleets.output_file import FilesAndFindings, OutputFile, path_for
from multibot_rewrite.fleets.start_poses import InitialPose, command, start_poses
from multibot_rewrite.releases import facts_of_release

COMMANDS, START = "commands.md", "start_pose.yaml"


def commands_file(
    each: Iterable[FleetPlan], windows: Iterable[str], release: str
) -> FilesAndFindings:
    """The commands robot by robot, and the parameters of those that amcl has to place.

    ``each`` is every robot as a fleet of its own, ``windows`` the lines that open RViz, ``release``
    that whose facts they rest on.
    """
    rows = [f"# Commands of this fleet{facts_of_release(release)}\n"]
    for one in each:
        (robot,) = one.robots
        poses = start_poses(one)
        spawned, findings = spawn.spawns(one)
        yield from (*poses.findings, *findings)
        rows.append(f"\n## {robot.spec.name}\n\n```sh\n")
        rows += [f"{command(it)}\n" for it in poses.transforms]
        rows += [spawn.either(it, robot) for it in spawned]
        rows += [*(f"{teleop.command(it)}\n" for it in teleop.teleops(one)), "```\n"]
        for pose in poses.initial:
            path = path_for(robot, START)
            rows.append(f"\nStart its {pose.node} with `--params-file {path}` as well.\n")
            yield OutputFile(path, _start_parameters(one, pose))
    if lines := [f"{it}\n" for it in windows]:
        rows += ["\n## RViz\n\n```sh\n", *lines, "```\n"]
    yield OutputFile(COMMANDS, "".join(rows).encode())


def _start_parameters(plan: FleetPlan, pose: InitialPose) -> bytes:
    import yaml

    tables = plan.fleet.table.nodes
    node = next(it for it in tables if (it.robot, it.node) == (pose.robot, pose.node))
    full = f"{node.namespace.rstrip('/')}/{node.name}"
    data = {full: {"ros__parameters": dict(pose.values)}}
    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    return str(yaml.dump(data, None, dumper, sort_keys=False)).encode()
