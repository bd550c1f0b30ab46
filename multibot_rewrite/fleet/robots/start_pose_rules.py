# SPDX-License-Identifier: Apache-2.0
"""The rules about start poses that are not published."""

from __future__ import annotations

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.findings.rule import declare

_TWO = """\
robots:
  - {name: robot1, description: robot.urdf, pose: {x: 1.0}}
  - {name: robot2, description: robot.urdf}
"""
LOCALISED_ALREADY = declare(
    "MF701",
    "pose-of-localised-robot",
    WARNING,
    what="A robot has a pose, but a node of its stack already publishes where the robot is. The pose "
    "is not published.",
    why="The frame would have two parents, and the robot would jump between two places.",
    fix="Remove the pose of a real robot. In a simulator the robot starts there: this is a note then. "
    "amcl gets the pose in start_pose.yaml.",
    bad=f"stack: slam_toolbox\n{_TWO}",
    good=f"stack: amcl\n{_TWO}",
    line=3,
    formats=("fleet",),
)
NO_SINGLE_ROOT = declare(
    "MF702",
    "pose-without-root-frame",
    WARNING,
    what="A robot has a pose, but no root frame or several. The pose is not published.",
    why="A pose is the transform from the world to the root frame of a robot.",
    fix="Connect the frames to one tree, by a joint or by the base frame of a node.",
    bad="""\
# in two_trees.urdf no joint connects the base with the mast
robots:
  - {name: robot1, description: two_trees.urdf, pose: {x: 1.0}}
  - {name: robot2, description: robot.urdf}
""",
    good=_TWO,
    line=3,
    formats=("fleet",),
    beside={
        "two_trees.urdf": """\
<robot name="rover">
  <link name="base"/><link name="wheel"/><link name="mast"/><link name="lamp"/>
  <joint name="a" type="fixed"><parent link="base"/><child link="wheel"/></joint>
  <joint name="b" type="fixed"><parent link="mast"/><child link="lamp"/></joint>
</robot>
""",
    },
)
POSE_ON_WORLD = declare(
    "MF709",
    "pose-of-robot-on-world",
    ERROR,
    what="A robot has a pose, and a joint of its description holds it on the world already.",
    why="The joint's origin is where tf has the robot, so the pose moves it in the simulator "
    "alone. In tf two arms of one description are at the same place, and plan through each other.",
    fix="Make the joint's origin an argument of the xacro, give it with `arguments`, and remove the "
    "pose. Or let each real robot have a world of its own: write shared_frames: [map], and the pose is "
    "that of robot1/world in map. A simulator fixes robots to a link that is called world and to no "
    "other, so there this is a warning.",
    bad="""\
# arm.urdf has a joint from the link "world" to "base_link"
robots:
  - {name: robot1, description: arm.urdf, pose: {x: 1.0}}
  - {name: robot2, description: robot.urdf}
""",
    good=_TWO,
    line=3,
    formats=("fleet",),
    beside={
        "arm.urdf": """\
<robot name="arm">
  <link name="world"/>
  <link name="base_link"/>
  <joint name="mount" type="fixed"><parent link="world"/><child link="base_link"/></joint>
</robot>
"""
    },
)
NO_SHARED_FRAME = declare(
    "MF704",
    "pose-without-shared-frame",
    WARNING,
    what="A robot has a pose, but no frame is shared by all robots.",
    why="Poses are in a frame that all robots share. Without one the pose is not published, and the "
    "robots are not connected in tf.",
    fix="Name a frame in shared_frames, or the frame of poses in world.",
    bad=f"shared_frames: []\n{_TWO}",
    good=f"shared_frames: [map]\n{_TWO}",
    line=3,
    formats=("fleet",),
)

OWN_ODOMETRY = declare(
    "MF710",
    "pose-beside-own-odometry",
    WARNING,
    what="A robot has a pose, and a parameter file names an odometry frame for a node that nothing is "
    "known of. The pose is not published.",
    why="If that node sends odom -> base, a pose of the base would be its second parent, and the robot "
    "would jump between two places.",
    fix="Describe the node in a file of nodes, with `frames` and, if it sends that, `sends`. The "
    "pose is then that of the odometry frame (docs/stacks.md).",
    bad="""\
robots:
  - {name: robot1, description: robot.urdf, pose: {x: 1.0}}
  - {name: robot2, description: robot.urdf}
companions: {params: own.yaml}
""",
    good="""\
robots:
  - {name: robot1, description: robot.urdf, pose: {x: 1.0}}
  - {name: robot2, description: robot.urdf}
companions: {params: own.yaml}
nodes: nodes.yaml
stack: mine
""",
    line=2,
    formats=("fleet",),
    beside={
        "own.yaml": """\
my_driver:
  ros__parameters: {odom_frame: odom, base_frame: base_link}
""",
        "nodes.yaml": """\
nodes:
  my_driver:
    package: my_driver
    with: [tf_broadcaster]
    frames: {odom_frame: odom, base_frame: base_link}
    sends: {odom_frame: base_frame}
stacks:
  mine: {about: my robot, nodes: [my_driver]}
""",
    },
)
