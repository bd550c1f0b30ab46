# SPDX-License-Identifier: Apache-2.0
"""What is seen -> files to begin a fleet with: fleet file, nodes, description of frames, plan. Pure."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from xml.sax.saxutils import quoteattr

from multibot_rewrite.base import editors
from multibot_rewrite.base.conventions import BODY_FRAMES, WORLD_FRAMES
from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.knowledge.node_library import NodeLibrary
from multibot_rewrite.live.diagnose import Diagnosis
from multibot_rewrite.live.learning.learn import learn
from multibot_rewrite.live.learning.nodes_file import to_yaml as nodes_to_yaml
from multibot_rewrite.live.seen_plan import NAMELESS, robots_to_plan, seen_plan
from multibot_rewrite.planning.plan import to_yaml as plan_to_yaml
from multibot_rewrite.planning.transforms import STATE_PUBLISHER
from multibot_rewrite.rules.system.tf_trees import root_of
from multibot_rewrite.system.guess import GuessedRobot
from multibot_rewrite.system.words import is_tool

NODE_SET = "seen"
FILES = ("fleet.yaml", "nodes.yaml", "robot.urdf", "plan.yaml")
FLEET_FILE, NODES_FILE, DESCRIPTION, PLAN_FILE = FILES
# What an editor is told of them.
SCHEMAS = {FLEET_FILE: editors.FLEET, NODES_FILE: editors.NODES, PLAN_FILE: editors.PLAN}
HEAD = """\
# A first fleet file, from what was seen in the running graph. Before you use it:
# - put your robot's own URDF or xacro in place of robot.urdf, which has only the frames heard
# - see whether these are the robots and the layout that you want: multibot build --help
# Then: multibot build fleet.yaml -o out/, and multibot check fleet.yaml while it runs
"""


def suggestion(seen: Diagnosis, library: NodeLibrary) -> dict[str, str]:
    """Return a first fleet file, and the files that it names, as texts by file name."""
    robot, *_ = robots_to_plan(seen)
    # The nodes of the first robot, as far as their names show the code's: not behind a word.
    mine, above = "" if robot is NAMELESS else robot.name, f"{robot.namespace}/"
    times = Counter(node.name for node in seen.graph.nodes)
    own = (it for it in times if times[it] == 1 and seen.whose.robot(it) == mine)
    shown = sorted(it for it in own if it.startswith(above) and not is_tool(it))
    nodes = shown if robot.namespace or not mine else []
    learned = [it for it in nodes if not it.endswith(f"/{STATE_PUBLISHER}")]
    files = {
        FLEET_FILE: HEAD + "".join(f"{it}\n" for it in _fleet_lines(seen, nodes, bool(learned))),
        DESCRIPTION: "".join(f"{it}\n" for it in _description_lines(seen, robot)),
        PLAN_FILE: plan_to_yaml(seen_plan(seen)),
    }
    if learned:
        found = learn(seen.graph, learned, robot.namespace or "/", library)
        files[NODES_FILE] = nodes_to_yaml(found, NODE_SET, library)
    return files


def _fleet_lines(seen: Diagnosis, nodes: Sequence[str], learned: bool) -> Iterator[str]:
    robots = robots_to_plan(seen)
    namespaced = any(robot.namespace for robot in robots)
    fallback = LAYOUTS[0] if namespaced else LAYOUTS[-1]
    yield f"layout: {(seen.layout or fallback).name}"
    if any(robot.before for robot in robots):
        yield "affix: prefix"
    between = {it.before[-1:] or it.behind[:1] for it in robots} - {""}
    if len(between) == 1 and not between & {"/"}:
        separator = between.pop()
        yield f"separators: {{link: '{separator}', frame: '{separator}'}}"
    yield f"description: {DESCRIPTION}"
    if learned:
        yield f"nodes: {NODES_FILE}"
    publisher = any(it.endswith(f"/{STATE_PUBLISHER}") for it in nodes)
    node_sets = [*[NODE_SET] * learned, *["no_robot_state_publisher"] * (learned and not publisher)]
    if node_sets:
        yield f"node_sets: [{', '.join(node_sets)}]"
    yield "robots:"
    for robot in robots:
        yield f"  - {{name: {robot.name.replace('/', '_')}}}"


def _description_lines(seen: Diagnosis, robot: GuessedRobot) -> Iterator[str]:
    """Yield the lines of a description with the frames of a robot below its base."""
    whose, plain = seen.whose, seen.whose.plain_frame
    # Those with the robot's name; where frames have none, those on its topic or on all.
    named = [it for it in seen.graph.edges if whose.frame_robot(it.child) == robot.name]
    bare = [it for it in seen.graph.edges if not whose.frame_robot(it.child)]
    own = [it for it in bare if whose.robot(it.topic) == robot.name]
    found = (it for it in named or own or bare if plain(it.parent) not in WORLD_FRAMES)
    edges = {plain(it.child): it for it in found}
    edges = {child: it for child, it in edges.items() if plain(it.parent) != "odom"}
    parents = {child: plain(it.parent) for child, it in edges.items()}
    # The root of the tree that has a usual base, else any root.
    known = {*parents, *parents.values()}
    base = next((it for it in BODY_FRAMES if it in known), "")
    root = root_of(base, parents) if base else ""
    root = root or min((it for it in known if it not in parents), default=BODY_FRAMES[1])
    yield '<?xml version="1.0"?>'
    yield "<!-- The frames that were heard on tf: put your own description in its place. -->"
    yield '<robot name="seen">'
    yield f"  <link name={quoteattr(root)}/>"
    # The frames below one, parents first, each once.
    frames = [root]
    for frame in frames:  # grows
        frames += [it for it, above in parents.items() if above == frame and it not in frames]
    for child in frames[1:]:
        yield f"  <link name={quoteattr(child)}/>"
        kind = "fixed" if edges[child].static else "continuous"
        yield f'  <joint name={quoteattr(child + "_joint")} type="{kind}">'
        yield f"    <parent link={quoteattr(parents[child])}/><child link={quoteattr(child)}/>"
        yield "  </joint>"
    yield "</robot>"
