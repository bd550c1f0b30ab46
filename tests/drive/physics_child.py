# SPDX-License-Identifier: Apache-2.0
"""Robots in one MuJoCo scene, their drives and controllers stood in for, and who sends commands.

``python physics_child.py SPEC``: SPEC is JSON, {"robots": [...], "send": [[topic, kind, values], ...],
"film": a file or ""}; what is sent is sent one after the other. Each robot
has "urdf", "at", "free" (it stands on wheels), "states", and a drive ("commands", "odom", "tf",
"frames", "wheels", "separation", "radius") or a controller ("trajectory", "joints"). It prints where
each began and ended, and the last that each said of itself, as it came through DDS.
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

import mujoco
import rclpy
from film import EVERY, Film
from geometry_msgs.msg import TransformStamped, Twist
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

try:
    from tf2_msgs.msg import TFMessage
except ImportError:
    # There is no wheel of it: one transform goes over the same topic without the list around it.
    TFMessage = TransformStamped
STEPS, TURNS = 20, 200
# Newton metres for a radian a second that a wheel is too slow.
MOTOR = 0.02


def scene(robots: list[dict[str, Any]]) -> Any:
    """All robots in one model; the names of each must be its own, as in a simulator."""
    made = mujoco.MjSpec()
    made.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[20, 20, 0.1])
    for it in robots:
        own = mujoco.MjSpec.from_string(Path(it["urdf"]).read_text())
        own.compiler.boundmass, own.compiler.boundinertia = 0.001, 0.00001
        if it["free"]:
            own.worldbody.first_body().add_freejoint(name="free")
        frame = made.worldbody.add_frame(pos=[*it["at"], 0.001])
        made.attach(own, frame=frame, prefix=f"{it['name']}:")
    model = made.compile()
    for at in range(model.ngeom):
        # What is not a wheel slides, as a caster does.
        wheel = any(word in model.body(model.geom_bodyid[at]).name for word in ("wheel", "world"))
        model.geom_friction[at] = (1, 0.005, 0.0001) if wheel else (0, 0, 0)
        model.geom_priority[at] = 0 if wheel else 1
    return model


class Robot(Node):  # type: ignore[misc]
    """The drive or controller of one robot: it reads joints of the scene, and turns them."""

    def __init__(self, given: dict[str, Any], model: Any, data: Any, context: Context) -> None:
        super().__init__(f"stand_in_{given['name']}", context=context)
        self.given, self.model, self.data = given, model, data
        self.speed, self.goal, self.pose = (0.0, 0.0), {}, [0.0, 0.0, 0.0]
        self.last = [self.angle(it) for it in given.get("wheels", ())]
        if "commands" in given:
            self.create_subscription(Twist, given["commands"], self.heard, 10)
            self.odom = self.create_publisher(Odometry, given["odom"], 10)
            self.tf = self.create_publisher(TFMessage, given["tf"], 10)
        if "trajectory" in given:
            self.create_subscription(JointTrajectory, given["trajectory"], self.told, 10)
        self.states = self.create_publisher(JointState, given["states"], 10)

    def joint(self, name: str) -> Any:
        return self.model.joint(f"{self.given['name']}:{name}")

    def angle(self, name: str) -> float:
        return float(self.data.qpos[self.joint(name).qposadr[0]])

    def heard(self, message: Any) -> None:
        self.speed = (message.linear.x, message.angular.z)

    def told(self, message: Any) -> None:
        self.goal = dict(zip(message.joint_names, message.points[-1].positions, strict=True))

    def push(self) -> None:
        """Hold the wheels' speed, or move the joints to where they are told."""
        if "commands" in self.given:
            forward, turn = self.speed
            half = turn * self.given["separation"] / 2
            for name, speed in zip(
                self.given["wheels"], (forward - half, forward + half), strict=True
            ):
                at = self.joint(name).dofadr[0]
                error = speed / self.given["radius"] - self.data.qvel[at]
                self.data.qfrc_applied[at] = self.given.get("motor", MOTOR) * error
        for name in self.given.get("joints", ()):
            error = self.goal.get(name, 0.0) - self.angle(name)
            self.data.qvel[self.joint(name).dofadr[0]] = max(-1.5, min(1.5, 20 * error))

    def say(self) -> None:
        """Odometry by the wheels, and the joints' states."""
        names = [*self.given.get("wheels", ()), *self.given.get("joints", ())]
        self.states.publish(JointState(name=names, position=[self.angle(it) for it in names]))
        if "commands" not in self.given:
            return
        now = [self.angle(it) for it in self.given["wheels"]]
        left, right = (self.given["radius"] * (b - a) for a, b in zip(self.last, now, strict=True))
        self.last = now
        x, y, yaw = self.pose
        middle = yaw + (right - left) / self.given["separation"] / 2
        step = (left + right) / 2
        self.pose = [
            x + step * math.cos(middle),
            y + step * math.sin(middle),
            yaw + (right - left) / self.given["separation"],
        ]
        said = Odometry()
        said.header.frame_id, said.child_frame_id = self.given["frames"]
        said.pose.pose.position.x, said.pose.pose.position.y = self.pose[:2]
        self.odom.publish(said)
        moved = TransformStamped(header=said.header, child_frame_id=said.child_frame_id)
        moved.transform.translation.x, moved.transform.translation.y = self.pose[:2]
        listed = TFMessage is not TransformStamped
        self.tf.publish(TFMessage(transforms=[moved]) if listed else moved)


TYPES = {"Twist": Twist, "JointTrajectory": JointTrajectory}


def message_of(kind: str, values: Any) -> Any:
    if kind == "Twist":
        made = Twist()
        made.linear.x, made.angular.z = values
        return made
    return JointTrajectory(
        joint_names=list(values), points=[JointTrajectoryPoint(positions=[*values.values()])]
    )


def place(data: Any, model: Any, robot: Robot) -> list[float]:
    """Where a robot is in the scene: its joints, and its place where it has wheels."""
    given = robot.given
    joints = [robot.angle(it) for it in given.get("joints", ())]
    if not given["free"]:
        return joints
    at = robot.joint("free").qposadr[0]
    return [float(it) for it in data.qpos[at : at + 3]] + joints


def listen(node: Node, robots: list[Robot]) -> dict[str, dict[str, Any]]:
    """Return what comes of each robot, in the context of the one who sends."""
    said: dict[str, dict[str, Any]] = {it.given["name"]: {} for it in robots}

    def odom(name: str) -> Any:
        def keep(it: Any) -> None:
            at = it.pose.pose.position
            said[name]["odom"] = [it.header.frame_id, it.child_frame_id, at.x, at.y]

        return keep

    def states(name: str) -> Any:
        def keep(it: Any) -> None:
            said[name]["states"] = dict(zip(it.name, it.position, strict=True))

        return keep

    def tf(name: str) -> Any:
        def keep(it: Any) -> None:
            for moved in getattr(it, "transforms", [it]):
                at, frames = moved.transform.translation, [moved.header.frame_id]
                frames.append(moved.child_frame_id)
                if frames == next(x.given["frames"] for x in robots if x.given["name"] == name):
                    said[name]["tf"] = [*frames, at.x, at.y]

        return keep

    for it in robots:
        name = it.given["name"]
        if "tf" in it.given:
            node.create_subscription(TFMessage, it.given["tf"], tf(name), 10)
        node.create_subscription(JointState, it.given["states"], states(name), 10)
        if "odom" in it.given:
            node.create_subscription(Odometry, it.given["odom"], odom(name), 10)
    return said


def main(given: dict[str, Any]) -> None:
    model = scene(given["robots"])
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    own, other = Context(), Context()
    rclpy.init(context=own)
    rclpy.init(context=other)
    robots = [Robot(it, model, data, own) for it in given["robots"]]
    operator = Node("operator", context=other)
    senders = [
        (topic, message_of(kind, values), operator.create_publisher(TYPES[kind], topic, 10))
        for topic, kind, values in given["send"]
    ]
    film = Film(model, [it["name"] for it in given["robots"]]) if given["film"] else None
    said = listen(operator, robots)
    inside, outside = SingleThreadedExecutor(context=own), SingleThreadedExecutor(context=other)
    for it in robots:
        inside.add_node(it)
    outside.add_node(operator)
    began = [place(data, model, it) for it in robots]
    counted = 0
    for _ in range(5000):
        topic, message, send = senders[min(counted // TURNS, len(senders) - 1)]
        if send.get_subscription_count():
            send.publish(message)
            counted += 1
            if film and counted % EVERY == 0:
                film.take(data, topic)
        for _ in range(STEPS if counted else 0):
            for it in robots:
                it.push()
            mujoco.mj_step(model, data)
        for it in robots:
            it.say()
        inside.spin_once(timeout_sec=0.005)
        outside.spin_once(timeout_sec=0.0)
        if counted > TURNS * len(senders):
            break
    if film:
        film.write(given["film"])
    for turn in range(300):
        # What all robots send on one topic waits for its turn: at the end no more is sent.
        for it in robots if turn < 200 else ():
            it.say()
        outside.spin_once(timeout_sec=0.005)
    ended = [place(data, model, it) for it in robots]
    names = [it["name"] for it in given["robots"]]
    print(
        json.dumps(
            {
                "began": dict(zip(names, began, strict=True)),
                "ended": dict(zip(names, ended, strict=True)),
                "said": said,
            }
        )
    )
    for context in (own, other):
        rclpy.shutdown(context=context)


if __name__ == "__main__":
    main(json.loads(sys.argv[1]))
