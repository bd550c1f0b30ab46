from pathlib import Path

from launch import LaunchDescription
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

HERE = Path(__file__).parent


def generate_launch_description():
    text = (HERE / "rover.urdf").read_text()
    return LaunchDescription(
        [
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(text, value_type=str)}],
            ),
            Node(package="joint_state_publisher", executable="joint_state_publisher"),
            Node(
                package="ros_gz_sim",
                executable="create",
                arguments=["-name", "rover", "-topic", "robot_description"],
            ),
            Node(package="rviz2", executable="rviz2", arguments=["-d", str(HERE / "rover.rviz")]),
        ]
    )
