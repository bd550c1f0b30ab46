# SPDX-License-Identifier: Apache-2.0
"""Keys of a drawn fleet file that are for the whole fleet, and the files that they name: what all
robots share, how files are written, other programs beside, and joined robots.

Each is drawn as docs/fleet-file.md and the schema have it, beside whatever else was drawn.
"""

from __future__ import annotations

from collections.abc import Iterator

from drawn_spellings import Data
from hypothesis import strategies as st
from paths import fixture_text

USUAL_TOPICS = ["/clock", "/rosout", "/parameter_events", "/diagnostics"]
USUAL_FRAMES = ["map", "world", "earth", "utm"]
# The layouts that a vendor's launch files start, and the styles of parameter files that they take.
SHAPES = {
    "clearpath": (("tf-per-robot",), "full"),
    "husarion": (("frame-prefix",), "full"),
    "nav2": (("tf-per-robot", "both"), "bringup"),
    "turtlebot4": (("tf-per-robot",), "bringup"),
}
# nav2_bringup starts its nodes in a namespace, with tf there.
BRINGUP = ("tf-per-robot", "both")
WITH_MAP, MAPPING = ("nav2", "localization"), ("slam_toolbox", "nav2_slam")
# What navigates, as the adapter of Open-RMF asks for it.
NAVIGATING = ("nav2", "nav2_composed", "navigation", "nav2_slam")
WORLD = """\
<sdf version="1.9"><world name="lake">
<model name="ground"><static>true</static><link name="ground_link"><collision name="c">
<geometry><plane><normal>0 0 1</normal></plane></geometry></collision></link></model>
</world></sdf>
"""
VOCABULARY = """\
[plugin acme_winch AcmeWinch]
about: winds a rope between two links
source: acme_robots src/winch.cpp
@name                       declares node
rope/from                   uses link
status_topic                uses topic default=winch/status
"""
NODES = fixture_text("drawn_keys_nodes.yaml")
TREE = """\
<root main_tree_to_execute="MainTree">
  <BehaviorTree ID="MainTree"><Spin spin_dist="1.57" server_name="spin"/></BehaviorTree>
</root>
"""
LAUNCH = """\
<launch>
  <node pkg="robot_state_publisher" exec="robot_state_publisher" name="robot_state_publisher"/>
  <node pkg="rviz2" exec="rviz2" name="rviz2"/>
</launch>
"""
LUA = """\
include "map_builder.lua"
options = {
  map_frame = "map", tracking_frame = "base_link", published_frame = "odom", odom_frame = "odom",
}
return options
"""


def maybe(draw: st.DrawFn, of_ten: int = 3) -> bool:
    """Draw True so many times of ten; what is left out is simpler."""
    return draw(st.integers(0, 9)) >= 10 - of_ten


def add_keys(draw: st.DrawFn, data: Data, files: dict[str, str]) -> None:
    """Put keys of the whole fleet into a fleet file, each with a small chance."""
    for add in (_shared, _written, _known, _beside):
        if maybe(draw):
            add(draw, data, files)


def sets_of(data: Data) -> Iterator[tuple[Data, list[str]]]:
    """Each robot with its node sets."""
    for row in data["robots"]:
        yield row, row.get("node_sets", [])


def _shared(draw: st.DrawFn, data: Data, _: dict[str, str]) -> None:
    """Frames, topics and nodes that all robots share, and the frame that places are in."""
    every = {it for _, own in sets_of(data) for it in own}
    # Who maps sends a map as well, and there would be two of them.
    with_map = not every.isdisjoint(WITH_MAP) and every.isdisjoint(MAPPING)
    if maybe(draw, 4):
        more = draw(st.sampled_from((["map"], ["map", "world"], [*USUAL_FRAMES, "site"])))
        data["shared_frames"] = more
    if maybe(draw, 4):
        data["world"] = draw(st.sampled_from(data.get("shared_frames", USUAL_FRAMES)))
    if maybe(draw, 6) and with_map:
        data["shared_nodes"] = ["map_server"]
        data["shared_topics"] = ["/map", *USUAL_TOPICS]
        if "domains" in data and "shared_nodes" not in data["domains"] and maybe(draw, 5):
            data["domains"]["shared_nodes"] = 9
    elif maybe(draw, 3):
        data["shared_topics"] = [*USUAL_TOPICS, draw(st.sampled_from(("/map", "/fleet_state")))]


def _written(draw: st.DrawFn, data: Data, _: dict[str, str]) -> None:
    """How files are written, and for whom."""
    shapes = [name for name, (layouts, _) in SHAPES.items() if data["layout"] in layouts]
    if maybe(draw, 5) and shapes:
        data["shape"] = draw(st.sampled_from(shapes))
        if maybe(draw, 3):
            data["params_style"] = SHAPES[data["shape"]][1]
    elif maybe(draw, 4) and data["layout"] in BRINGUP and "shared_nodes" not in data:
        data["params_style"] = draw(st.sampled_from(("bringup", "full")))
    if "shared_nodes" in data and is_bringup(data):
        del data["shared_nodes"]
    if maybe(draw, 3):
        data["installed"] = "/opt/fleet"
    if maybe(draw, 4):
        # The arms of a cell have groups of their own.
        data["groups"] = (
            draw(st.sampled_from(("keep", "rename"))) if "cell" not in data else "rename"
        )


def style(data: Data) -> str:
    """Return the style of parameter files that the shape of a fleet wants."""
    return SHAPES[data["shape"]][1] if "shape" in data else ""


def _known(draw: st.DrawFn, data: Data, files: dict[str, str]) -> None:
    """Files that describe the user's own nodes, plugins and world."""
    if maybe(draw, 4):
        data["nodl"] = "none"
    if maybe(draw, 4):
        files["config/acme.vocab"] = VOCABULARY
        data["definitions"] = draw(st.sampled_from(("config/acme.vocab", ["config/acme.vocab"])))
    if maybe(draw, 4):
        files["config/our_nodes.yaml"] = NODES
        data["nodes"] = "config/our_nodes.yaml"
        for row in data["robots"]:
            if draw(st.booleans()):
                row["node_sets"] = [*row.get("node_sets", ()), "our_gripper"]
    if maybe(draw, 4):
        files["worlds/lake.sdf"] = WORLD
        data["simulator_world"] = "worlds/lake.sdf"
    for row, own in sets_of(data):
        if not own and "cell" not in data and maybe(draw, 3):
            files["launch/bringup.launch.xml"] = LAUNCH
            row["launch"] = ["launch/bringup.launch.xml"]
            data |= {"own_nodes": ["rviz2"]} if maybe(draw) else {}
            data |= {"launch_roots": ["launch"]} if maybe(draw, 7) else {}


def _beside(draw: st.DrawFn, data: Data, files: dict[str, str]) -> None:
    """Other programs beside, as Zenoh and the adapter of Open-RMF; and files that few robots have."""
    if "zenoh" in data or maybe(draw, 3):
        own: Data = {"router": draw(st.sampled_from(("tcp/10.0.0.1:7447", "tls/router.lan:7447")))}
        if draw(st.booleans()):
            own["keystore"] = "/etc/sros2"
            own |= {"operators": ["/operator"]} if draw(st.booleans()) else {}
        own |= {"own_routers": True} if maybe(draw, 4) else {}
        own |= {"domain": 5} if maybe(draw, 3) and "domains" not in data else {}
        data["zenoh"] = own
    all_navigate = all({*NAVIGATING} & {*own} for _, own in sets_of(data))
    if all_navigate and data["layout"] in BRINGUP and data.get("domains") and maybe(draw, 8):
        data["free_fleet"] = {"router": "tcp/10.0.0.1:7447", "map": "L1"}
        if draw(st.booleans()):
            data["free_fleet"]["charger"] = "{robot}_dock"
    for row, own in sets_of(data):
        related_files = row.get("related_files", {})
        if {"nav2", "navigation"} & {*own} and maybe(draw, 4):
            files["trees/main.xml"] = TREE
            related_files = {**related_files, "behavior_trees": ["trees/main.xml"]}
        if maybe(draw, 1) and row.get("simulator") == "gazebo":
            row["use_sim_time"] = True
        if maybe(draw, 1):
            files["config/cartographer.lua"] = LUA
            related_files = {**related_files, "lua": ["config/cartographer.lua"]}
        row.update({"related_files": related_files} if related_files else {})
        if related_files.get("bridge") and draw(st.booleans()):
            row["bridge_namespace"] = "sensors"
        row.update({"fill_arguments": draw(st.booleans())} if maybe(draw, 1) else {})


# ---------------------------------------------------------------- joined robots


def parts(base: str, other: str, at: str, draw: st.DrawFn) -> list[Data]:
    """Return a list of parts: a robot, and another one behind a prefix that is fixed to it."""
    fixed: Data = {"parent": at}
    if draw(st.booleans()):
        fixed["pose"] = draw(st.sampled_from(({"x": -0.6}, {"z": 0.2, "yaw": 1.57})))
    part: Data = {"description": other, "prefix": "up_", "at": fixed}
    part |= {"name": "upper"} if maybe(draw, 3) else {}
    return [{"description": base}, part]


# ---------------------------------------------------------------- causes of errors


def in_other_layout(data: Data) -> bool:
    """Is there something that the layout of the fleet has not?"""
    layout = data["layout"]
    shaped = "shape" in data and layout not in SHAPES[data["shape"]][0]
    return shaped or (data.get("params_style") == "bringup" and layout not in BRINGUP)


def in_other_style(data: Data) -> bool:
    """Return whether a fleet wants another style than its shape."""
    return "shape" in data and data.get("params_style", style(data)) != style(data)


def has_no_such_world(data: Data) -> bool:
    return data.get("world", "map") not in data.get("shared_frames", USUAL_FRAMES)


def shares_no_such_node(data: Data) -> bool:
    """Is a node shared that no robot runs?"""
    names = {it for it in data.get("shared_nodes", ()) if it != "map_server"}
    with_map = any({*WITH_MAP} & {*own} for _, own in sets_of(data))
    return bool(names) or ("map_server" in data.get("shared_nodes", ()) and not with_map)


def started_for_each(data: Data) -> bool:
    """Return whether nav2_bringup starts a node for each robot that all should share."""
    return is_bringup(data) and "map_server" in data.get("shared_nodes", ())


def is_bringup(data: Data) -> bool:
    """Are the parameters of a robot in the one file that nav2_bringup takes?"""
    return "bringup" in (style(data), data.get("params_style"))


def has_no_adapter(data: Data) -> bool:
    """Has the adapter of Open-RMF nothing to ask? It reads each robot's own tf and sends goals, by a
    bridge in the domain of each."""
    navigate = all({*NAVIGATING} & {*own} for _, own in sets_of(data))
    served = navigate and data["layout"] in BRINGUP and "domains" in data
    return "free_fleet" in data and not served


def has_no_certificates(data: Data) -> bool:
    given = data.get("zenoh", {})
    return "operators" in given and "keystore" not in given
