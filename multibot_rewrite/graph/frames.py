"""Rules about tf: one parent a frame, one tree a robot, on the topic of the layout."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from multibot_rewrite.graph.comparison import GraphFinding, View, owner
from multibot_rewrite.graph.expectation import Expectation, WantedRobot
from multibot_rewrite.model import ERROR, WARNING


def two_parents(view: View) -> Iterator[GraphFinding]:
    """A tf frame with two parents on one topic: listeners see it jump."""
    parents: dict[tuple[str, str], set[str]] = defaultdict(set)
    for frame in view.graph.frames:
        parents[_tree(frame.topic), frame.child].add(frame.parent)
    for (topic, child), found in parents.items():
        if len(found) > 1:
            message = f"frame {child} on {topic} has the parents {' and '.join(sorted(found))}"
            cause = "two robots share a frame name, or two nodes publish one transform"
            yield GraphFinding("MG201", ERROR, _robot_of_frame(view, child), "", message, cause)


def _tree(topic: str) -> str:
    """tf and tf_static of one robot are one tree."""
    return topic.replace("tf_static", "tf")


def _robot_of_frame(view: View, frame: str) -> str:
    return next((robot.name for robot in view.plan.robots if frame in robot.frames), "")


def wrong_tf_topics(view: View) -> Iterator[GraphFinding]:
    """A robot's frames on a tf topic that is not the one of its layout."""
    for robot in view.plan.robots:
        told: set[str] = set()
        for frame in view.graph.frames:
            topic = _tree(frame.topic)
            if not _is_frame_of(frame.child, robot, view.plan) or topic in (robot.tf, *told):
                continue
            told.add(topic)
            message = (
                f"frame {frame.child} of {robot.name} is on {frame.topic}, expected {robot.tf}"
            )
            cause = "/tf:=tf is missing for " + (", ".join(frame.publishers) or "its publisher")
            yield GraphFinding("MG205", ERROR, robot.name, "", message, cause)


def _is_frame_of(frame: str, robot: WantedRobot, plan: Expectation) -> bool:
    """Bare frames are every robot's alike: then only a topic that is another's tells."""
    others = (other for other in plan.robots if other.name != robot.name)
    return frame in robot.frames and not any(frame in other.frames for other in others)


def undeclared_frames(view: View) -> Iterator[GraphFinding]:
    """A frame under a robot's name that its description does not declare."""
    known = {frame for robot in view.plan.robots for frame in robot.frames}
    for frame in dict.fromkeys(edge.child for edge in view.graph.frames):
        robot = owner(frame, view.plan)
        if frame in known or frame in view.plan.shared_frames or not robot:
            continue
        doubled = next(
            (k for k in known if frame in (f"{robot}/{k}", f"{robot}_{k}", f"{k}/{robot}")), ""
        )
        cause = (
            f"{doubled} with the robot's name twice: frame_prefix on top?"
            if doubled
            else "a sensor's own frame?"
        )
        code, level = ("MG206", ERROR) if doubled else ("MG204", WARNING)
        message = f"frame {frame} is not in the description of {robot}"
        yield GraphFinding(code, level, robot, "", message, cause)


def torn_trees(view: View) -> Iterator[GraphFinding]:
    """A robot's frames that do not hang together on its tf topic."""
    for robot in view.plan.robots:
        edges = [
            frame
            for frame in view.graph.frames
            if _tree(frame.topic) == robot.tf and {frame.child, frame.parent} & set(robot.frames)
        ]
        roots = _roots({edge.child: edge.parent for edge in edges})
        if len(roots) > 1:
            message = (
                f"the tf tree of {robot.name} has {len(roots)} roots: {', '.join(sorted(roots))}"
            )
            cause = "a transform between them is missing, or one side is spelled differently"
            yield GraphFinding("MG203", ERROR, robot.name, "", message, cause)


def _roots(parent_of: dict[str, str]) -> set[str]:
    return {parent for parent in parent_of.values() if parent not in parent_of}
