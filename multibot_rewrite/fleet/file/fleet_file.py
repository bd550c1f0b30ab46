# SPDX-License-Identifier: Apache-2.0
"""The fleet file: YAML -> records, or one line that says what is wrong and where."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple, cast

from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.naming import Naming, Policy, make_naming
from multibot_rewrite.base.releases import chosen_release, why_release
from multibot_rewrite.description.sources.release_said import SaidRelease, release_of_all
from multibot_rewrite.fleet.file.domains import TOGETHER, Apart, Cell, apart_of, cell_of, with_cell
from multibot_rewrite.fleet.file.fleet_data import (
    FleetData,
    FleetSource,
    listed,
    nodl_files,
    read_data,
)
from multibot_rewrite.fleet.file.robot_choice import ALL, Choice, with_robots
from multibot_rewrite.fleet.file.robot_spec import WORLD_LINK, RobotSpec, is_simulated, robot_spec
from multibot_rewrite.fleet.outputs.zenoh_configuration import Setup, zenoh_of

KINDS = ("params", "rviz", "moveit", "bridge", "behavior_trees", "lua")
LISTS = ("include", "node_sets", "nodl", "definitions", "shared_frames", "shared_topics")
POLICY = tuple(Policy.__annotations__)
# What ``params_style`` says of parameter files for nav2_bringup.
BRINGUP = "bringup"
# What says the release, where the fleet file does.
IN_FILE = "the fleet file says so"


class FleetFile(NamedTuple):
    """A fleet file with its includes.

    ``policy`` are the options of ``make_naming`` that it sets, ``files`` all files of the fleet
    except the robots' own. ``shared_nodes`` run once for all robots, ``own_nodes`` for each
    robot though others of the kind run once. ``relayed`` asks for each robot's tf on /tf as
    well, ``cell`` for one move_group for all robots, ``shape`` for outputs as a vendor's launch
    files take them. ``apart`` are the domains, ``why`` is the reason for the release.
    ``installed`` is where the results are used, empty for where they are written.
    ``world_place`` and ``shared_places`` (by key) are file and line of what is set there."""

    file: str
    policy: Policy
    world: str
    distro: str
    installed: str
    nodes: str
    nodl: tuple[str, ...]
    definitions: tuple[str, ...]
    robots: tuple[RobotSpec, ...]
    files: tuple[str, ...] = ()
    shared_nodes: tuple[str, ...] = ()
    sros2: bool = False
    params_style: str = ""
    relayed: bool = False
    cell: Cell | None = None
    shape: str = ""
    zenoh: Setup | None = None
    simulator_world: str = ""
    world_place: tuple[str, int] = ("", 1)
    apart: Apart = TOGETHER
    why: str = ""
    shared_places: tuple[tuple[str, tuple[str, int]], ...] = ()
    own_nodes: tuple[str, ...] = ()


def read_fleet(
    source: FleetSource, distro: str, environment: Mapping[str, str], choice: Choice = ALL
) -> FleetFile:
    """Read a fleet file, dict or text with its includes; raises InputError with file and line.

    The release is ``distro``, else that of the file, of the environment, or of the robots'
    descriptions. ``choice`` says which robots there are if that is decided later than the file."""
    read = with_cell(with_robots(read_data(source), choice))
    data = read.data
    release, why = _release(data, distro, environment)
    policy, naming = _policy(read)
    definitions, nodl = (tuple(listed(data.get(it, []))) for it in ("definitions", "nodl"))
    documents = nodl_files(nodl, read.places)
    named = (data.get("nodes", ""), data.get("simulator_world", ""), *documents)
    robots = tuple(robot_spec(read, naming, at, release) for at in range(len(data["robots"])))
    _check_robots_differ(robots)
    _check_world(read, naming)
    return FleetFile(
        read.file,
        policy,
        data.get("world", ""),
        release,
        data.get("installed", ""),
        data.get("nodes", ""),
        nodl,
        definitions,
        robots,
        tuple(filter(None, (*read.files, *named, *definitions))),
        _node_names(data, "shared_nodes"),
        data.get("sros2", False),
        data.get("params_style", ""),
        data.get("relayed", False),
        cell_of(read, naming),
        data.get("shape", ""),
        zenoh_of(read),
        data.get("simulator_world", ""),
        read.places.get(("simulator_world",), (read.file, 1)),
        apart_of(read, [it.name for it in robots]),
        why,
        tuple((it, read.places[it,]) for it in LISTS if (it,) in read.places),
        _node_names(data, "own_nodes"),
    )


def _policy(read: FleetData) -> tuple[Policy, Naming]:
    """Return the options of ``make_naming`` in a fleet file, and the naming; raises InputError."""
    data = read.data
    given = {key: data[key] for key in POLICY if key in data}
    lists = {key: tuple(listed(given[key])) for key in LISTS if key in given}
    if "shared_frames" in lists and any(is_simulated(data, own) for own in data["robots"]):
        # sdformat fixes a robot to the link of this name and to no other (parser_urdf.cc).
        lists["shared_frames"] = tuple(dict.fromkeys((*lists["shared_frames"], WORLD_LINK)))
    policy = cast(Policy, given | lists)
    try:
        return policy, make_naming(**policy)
    except UsageError as error:
        # The schema covers everything except separators.
        file, line = read.places.get(("separators",), (read.file, 1))
        raise InputError(f"{file}:{line}: {error}") from None


def _check_world(read: FleetData, naming: Naming) -> None:
    """Raise InputError for a world that is no frame of all robots."""
    world = read.data.get("world", "")
    if world and world not in naming.shared_frames:
        file, line = read.places["world",]
        shared = ", ".join(sorted(naming.shared_frames)) or "none"
        hint = "add it to shared_frames"
        raise InputError(f"{file}:{line}: world {world!r} is not a shared frame ({shared}); {hint}")


def _node_names(data: Mapping[str, Any], key: str) -> tuple[str, ...]:
    """Return the node names below a key, also a single one, without slashes at their ends."""
    return tuple(it.strip("/") for it in listed(data.get(key, [])))


def _release(data: Mapping[str, Any], given: str, environment: Mapping[str, str]) -> SaidRelease:
    """Return the release, and what it comes from."""
    asked = given or data.get("distro", "")
    chosen = chosen_release(asked, environment)
    if why := why_release(asked, environment):
        return SaidRelease(chosen, IN_FILE if asked and not given else why)
    named = (it.get("description") or data.get("description") for it in data["robots"])
    said = release_of_all("", dict.fromkeys(it for it in named if isinstance(it, str)))
    return said if said.why else said._replace(why="the newest LTS")


def input_files(fleet: FleetFile) -> Iterator[str]:
    """Yield every file that the fleet file names, and itself."""
    yield from fleet.files
    for robot in fleet.robots:
        yield from robot.files


def _check_robots_differ(robots: Sequence[RobotSpec]) -> None:
    """Refuse two robots with the same name, namespace, prefix or postfix, model or pose."""
    for what in ("name", "namespace", "tag", "model", "pose"):
        seen: dict[object, RobotSpec] = {}
        for robot in robots:
            value = getattr(robot, what) or robot.name
            first = seen.setdefault(value, robot)
            if first is robot:
                continue
            word = {"tag": "prefix or postfix"}.get(what, what)
            shown = "the pose" if what == "pose" else f"the {word} {value!r}"
            both = f"{robot.name!r} has {shown} of {first.name!r} (line {first.line})"
            both = (
                f"robot {robot.name!r} is repeated, first in line {first.line}"
                if what == "name"
                else both
            )
            raise InputError(f"{robot.file}:{robot.line}: {both}; every robot needs its own")
