from pathlib import Path

from launch import LaunchDescription
from launch_ros.actions import Node

from multibot_rewrite.launch import bridge_config, each_robot, node, place, rviz_config, spawn

HERE = Path(__file__).parent
FLEET = str(HERE / "fleet.yaml")


def actions(robot):
    return [
        node(
            "robot_state_publisher",
            describe=True,
            package="robot_state_publisher",
            executable="robot_state_publisher",
        ),
        node(
            "joint_state_publisher",
            package="joint_state_publisher",
            executable="joint_state_publisher",
        ),
        spawn("gz"),
        place(),
        Node(
            package="ros_gz_bridge",
            executable="parameter_bridge",
            namespace=robot.namespace,
            parameters=[{"config_file": bridge_config()}],
        ),
    ]


def generate_launch_description():
    return LaunchDescription(
        [
            each_robot(FLEET, actions),
            # What all share is bridged once: the clock, and tf.
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                name="shared_bridge",
                parameters=[{"config_file": bridge_config(fleet=FLEET)}],
            ),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", rviz_config("rover.rviz", fleet=FLEET)],
            ),
        ]
    )
