# SPDX-License-Identifier: Apache-2.0
"""Measure ``multibot build`` on 100 robots with Nav2's full set, against other ways, in one run.

python benchmarks/bench_build.py            print the table
python benchmarks/bench_build.py --write    and put it into docs/contributing/measurements.md
"""

from __future__ import annotations

import gc
import os
import shutil
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from xml.etree import ElementTree

import yaml
from one_page import write_section
from pairs import HOW, MACHINE, Row, as_installed, child, least_seconds, paired, seconds, table
from robots import robot

from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.checks.build import Outputs, make_outputs
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.checks.read_back import read_back
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.robots.robot_groups import group_robots
from multibot_rewrite.related_files.context import fill_template, make_context
from multibot_rewrite.related_files.params.rewrite import rewrite_params
from multibot_rewrite.related_files.yaml_text import read_yaml

ROBOTS = 100
LINKS = 12
HEAD = "layout: frames-per-robot\naffix: prefix\nnode_sets: nav2\ndescription: rover.urdf\n"
HEAD += "related_files: {params: params.yaml, rviz: nav2.rviz}\nrobots:\n"
COSTMAP = """
{name}:
  {name}:
    ros__parameters:
      update_frequency: 5.0
      publish_frequency: 2.0
      global_frame: {frame}
      robot_base_frame: link_0
      rolling_window: true
      width: 3
      height: 3
      resolution: 0.05
      footprint: "[[0.2, 0.2], [0.2, -0.2], [-0.2, -0.2], [-0.2, 0.2]]"
      plugins: ["voxel_layer", "inflation_layer"]
      inflation_layer:
        plugin: "nav2_costmap_2d::InflationLayer"
        cost_scaling_factor: 3.0
        inflation_radius: 0.7
      voxel_layer:
        plugin: "nav2_costmap_2d::VoxelLayer"
        enabled: True
        publish_voxel_map: True
        origin_z: 0.0
        z_resolution: 0.05
        z_voxels: 16
        max_obstacle_height: 2.0
        mark_threshold: 0
        observation_sources: scan
        scan:
          # what the lidar sees
          topic: /scan
          max_obstacle_height: 2.0
          clearing: True
          marking: True
          data_type: "LaserScan"
          raytrace_max_range: 3.0
          obstacle_max_range: 2.5
      always_send_full_costmap: True
"""
NODES = {
    "amcl": [
        "base_frame_id: link_0",
        "odom_frame_id: odom",
        "global_frame_id: map",
        "max_beams: 60",
    ],
    "bt_navigator": ["global_frame: map", "robot_base_frame: link_0", "odom_topic: odom"],
    "controller_server": ["odom_topic: odom", 'controller_plugins: ["FollowPath"]'],
    "planner_server": ['planner_plugins: ["GridBased"]'],
    "smoother_server": ['smoother_plugins: ["simple_smoother"]', "robot_base_frame: link_0"],
    "behavior_server": ["local_frame: odom", "global_frame: map", "robot_base_frame: link_0"],
    "waypoint_follower": ["loop_rate: 20", "stop_on_failure: false"],
    "velocity_smoother": ["odom_topic: odom", "max_velocity: [0.5, 0.0, 2.0]"],
    "collision_monitor": ["base_frame_id: link_0", "odom_frame_id: odom"],
    "docking_server": ["base_frame: link_0", "fixed_frame: odom"],
    "route_server": ["base_frame: link_0", "route_frame: map"],
    "map_server": ["frame_id: map"],
}
# As many lines as Nav2's own file.
LINES = 600
DISPLAY = """\
    - Class: rviz_default_plugins/{kind}
      Enabled: true
      Name: {name}
      Topic:
        Depth: 5
        Durability Policy: Volatile
        Filter size: 10
        History Policy: Keep Last
        Reliability Policy: Reliable
        Value: {topic}
      Alpha: 0.7
      Color: 255; 255; 255
      Queue Size: 10
      Transform Tolerance: 0
      Value: true
"""


def nav2_params() -> str:
    """Return a parameter file in the shape of Nav2's, made here."""
    parts = [COSTMAP.format(name=f"{it}_costmap", frame=frame) for it, frame in
             (("local", "odom"), ("global", "map"))]  # fmt: skip
    filler = (LINES - "".join(parts).count("\n")) // len(NODES) - 6
    for node, lines in NODES.items():
        parts.append(f"\n{node}:\n  # {node}, for one robot\n  ros__parameters:\n")
        parts += [f"    {line}\n" for line in lines]
        parts += [f"    gain_{at}: {at}.25  # tuned\n" for at in range(filler)]
    return "".join(parts)


def rviz_config() -> str:
    """Return an RViz config of the length of Nav2's."""
    topics = [
        "/scan",
        "/map",
        "/plan",
        "/local_costmap/costmap",
        "/global_costmap/costmap",
        "/odom",
    ]
    kinds = ["LaserScan", "Map", "Path", "Map", "Map", "Odometry"]
    parts = ['Visualization Manager:\n  Class: ""\n  Displays:\n']
    for at in range(LINES // DISPLAY.count("\n")):
        topic, kind = topics[at % len(topics)], kinds[at % len(kinds)]
        parts.append(DISPLAY.format(kind=kind, name=f"{kind} {at}", topic=topic))
    return "".join([*parts, "  Global Options:\n    Fixed Frame: map\n"])


def write_fleets(folder: Path) -> tuple[str, str]:
    """Write the files, a fleet of one robot and one of many; return the paths of the fleet files."""
    (folder / "rover.urdf").write_bytes(robot(LINKS))
    (folder / "params.yaml").write_text(nav2_params())
    (folder / "nav2.rviz").write_text(rviz_config())
    rows = [f"  - {{name: robot{at}, pose: {{x: {at}}}}}\n" for at in range(1, ROBOTS + 1)]
    paths = folder / "one.yaml", folder / "many.yaml"
    for path, count in zip(paths, (1, ROBOTS), strict=True):
        path.write_text(HEAD + "".join(rows[:count]))
    return str(paths[0]), str(paths[1])


def made(fleet: str) -> Outputs:
    """All files of a fleet, in memory."""
    return make_outputs(plan_fleet(read_fleet(fleet, "", {})))


def read_again(fleet: str) -> Callable[[], object]:
    """Return what reads the files of a fleet back before they are written."""
    plan = plan_fleet(read_fleet(fleet, "", {}))
    return partial(read_back, plan, make_outputs(plan, "/out"), "/out")


def write_raw(files: Outputs, folder: str) -> None:
    """Write the same bytes into a fresh folder, and nothing else."""
    shutil.rmtree(folder, ignore_errors=True)
    for path, data, _ in files.files:
        full = os.path.join(folder, path)
        os.makedirs(os.path.dirname(full), exist_ok=True)
        with open(full, "wb") as file:
            file.write(data)


def usual_way(folder: Path, robots: int) -> None:
    """Do what launch files do for every robot: PyYAML loads and dumps the parameters and the RViz
    config with the names replaced in each text, ElementTree renames links and joints."""
    for at in range(1, robots + 1):
        name = f"robot{at}"
        for file in ("params.yaml", "nav2.rviz"):
            text = (folder / file).read_text()
            text = text.replace("link_0", f"{name}/link_0").replace("/scan", f"/{name}/scan")
            yaml.dump({name: yaml.safe_load(text)})
        tree = ElementTree.parse(folder / "rover.urdf")
        for element in tree.iter():
            for key in ("name", "link", "reference"):
                if element.tag in ("link", "joint", "parent", "child") and element.get(key):
                    element.set(key, f"{name}/{element.get(key)}")
        ElementTree.tostring(tree.getroot())


def command(fleet: str, out: str, *more: str) -> None:
    """``multibot build`` in a process of its own."""
    child([sys.executable, "-m", "multibot_rewrite.cli.multibot", "build", fleet, "-o", out, *more])


def fresh(fleet: str, out: str) -> None:
    """Build into a folder that does not exist."""
    shutil.rmtree(out, ignore_errors=True)
    command(fleet, out)


def each_further(one: Callable[[], object], many: Callable[[], object], runs: int = 7) -> float:
    """Return what each robot behind the first costs, as a part of what the first costs."""
    first, all_ = least_seconds(one, many, runs=runs)
    return (all_ - first) / (ROBOTS - 1) / first


def rows(folder: Path) -> list[Row]:
    """All measurements."""
    one, many = write_fleets(folder)
    files, out = made(many), str(folder / "out")
    raw, build = partial(write_raw, files, str(folder / "raw")), partial(fresh, many, out)
    usual = partial(usual_way, folder, ROBOTS // 10)
    ten = folder / "ten.yaml"
    ten.write_text("\n".join(Path(many).read_text().splitlines()[: 6 + ROBOTS // 10]) + "\n")
    command(many, out)
    again, check = partial(command, many, out), partial(command, many, out, "--check")
    single = str(folder / "single")
    return [
        Row("10 robots, in memory", "PyYAML load and dump, ElementTree, per robot",
            paired(partial(made, str(ten)), usual, 7), "0.1"),
        Row("each further robot, in memory", "the first, in memory, knowledge loaded",
            each_further(partial(made, one), partial(made, many)), "0.1"),
        Row("each further robot, `multibot build`", "a build of one, Python's start included",
            each_further(partial(fresh, one, single), build, 5), "0.1"),
        Row(f"reading {ROBOTS} robots back", "making their files, in memory",
            paired(read_again(many), partial(made, many), 5), "0.2"),
        Row("reading one robot back", "making its files, in memory",
            paired(read_again(one), partial(made, one), 5), "0.2"),
        Row(f"{ROBOTS} robots, in memory", "raw writes of the same bytes",
            paired(partial(made, many), raw, 7), ""),
        Row(f"{ROBOTS} robots, `multibot build`", "raw writes of the same bytes",
            paired(build, raw, 5), ""),
        Row("the same again, nothing to write", "the first time", paired(again, build, 5), ""),
        Row("`--check`", "the first time", paired(check, build, 5), ""),
    ]  # fmt: skip


def least(folder: Path, runs: int = 100) -> float:
    """Milliseconds for the parameter file of the first robot, at best."""
    kin = next(iter(group_robots(plan_fleet(read_fleet(str(folder / "one.yaml"), "", {})))))
    data = (folder / "params.yaml").read_bytes()
    context = make_context(
        kin.context.names.declared, kin.context.names.naming, kin.facts, distro=NEWEST_LTS
    )

    def first() -> str:
        return fill_template(
            rewrite_params(read_yaml(data, "params.yaml"), context).template, "robot1", "robot1"
        )

    gc.collect()
    return 1000 * min(seconds(first) for _ in range(runs))


def page() -> str:
    """Return the page as Markdown."""
    with as_installed(), tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        measured = table(rows(folder))
        files = made(str(folder / "many.yaml")).files
        size = sum(len(it.data) for it in files) / 1e6
        best = least(folder)
        whole = min(seconds(partial(made, str(folder / "many.yaml"))) for _ in range(3))
    lines = [text.count("\n") for text in (nav2_params(), rviz_config())]
    return f"""# Benchmark of a whole build

Made by `python benchmarks/bench_build.py --write` in one run: {HOW}.
{ROBOTS} robots with Nav2's full set (parameters of {lines[0]} lines, an RViz config of {lines[1]},
a URDF of {LINKS} links), {len(files)} files, {size:.1f} MB. {MACHINE}.

{measured}
In memory {whole:.2f} s for {ROBOTS} robots at best, and {best:.1f} ms for the parameter file of the
first robot (goal: 3 ms). What the usual way makes has lost its comments, and its frames and topics
are those that somebody thought of.
"""


def main(arguments: list[str]) -> None:
    """Print the page, or write it."""
    text = page()
    print(text)
    if "--write" in arguments:
        write_section(text)


if __name__ == "__main__":
    main(sys.argv[1:])
