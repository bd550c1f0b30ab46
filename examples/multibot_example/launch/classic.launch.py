"""Every robot of a fleet file in Gazebo Classic: ros2 launch multibot_example classic.launch.py

The way for any launch script: load_fleet gives plain values, so nothing here but load_fleet is ours.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

from multibot_rewrite import load_fleet


def share(package, *path):
    """Return the path of a package's file."""
    return PathJoinSubstitution([FindPackageShare(package), *path])


def robots(context):
    """Return what each robot needs; the name of the fleet file is known only now."""
    for robot in load_fleet(LaunchConfiguration("fleet").perform(context)).robots:
        yield Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            namespace=robot.namespace,
            name=robot.table.name("robot_state_publisher"),
            remappings=robot.table.for_node("robot_state_publisher"),
            parameters=[
                robot.params("params.yaml", "robot_state_publisher"),
                {"robot_description": robot.description},
            ],
        )
        yield Node(
            package="gazebo_ros",
            executable="spawn_entity.py",
            arguments=robot.classic_arguments,
        )
        if robot.transform_arguments:
            yield Node(
                package="tf2_ros",
                executable="static_transform_publisher",
                arguments=robot.transform_arguments,
            )


def generate_launch_description():
    """Return the simulator, then robot by robot."""
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "fleet", default_value=share("multibot_example", "config", "fleet.yaml")
            ),
            IncludeLaunchDescription(share("gazebo_ros", "launch", "gazebo.launch.py")),
            OpaqueFunction(function=robots),
        ]
    )
