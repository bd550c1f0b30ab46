"""Every robot of a fleet file in gz-sim: ros2 launch multibot_example gz.launch.py fleet:=FILE"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

from multibot_rewrite.launch import bridge_config, each_robot, params_file, rviz_config

FLEET = LaunchConfiguration("fleet")
SIM = {"use_sim_time": True}


def share(package, *path):
    """Return the path of a package's file."""
    return PathJoinSubstitution([FindPackageShare(package), *path])


def bridge(namespace, file):
    """Return the node that carries topics between gz-sim and ROS."""
    return Node(
        package="ros_gz_bridge",
        executable="parameter_bridge",
        namespace=namespace,
        parameters=[{"config_file": file, **SIM}],
    )


def actions(robot):
    """Return the actions that one robot needs."""
    its_node = robot.node("robot_state_publisher")
    its_node["parameters"] = [
        params_file("params.yaml"),
        {"robot_description": robot.description},
    ]
    yield Node(package="robot_state_publisher", executable="robot_state_publisher", **its_node)
    yield Node(package="ros_gz_sim", executable="create", arguments=robot.spawn_arguments)
    yield bridge(robot.namespace, bridge_config())
    if robot.transform_arguments:
        yield Node(
            package="tf2_ros",
            executable="static_transform_publisher",
            arguments=robot.transform_arguments,
        )


def generate_launch_description():
    """Return the simulator, then robot by robot, then one window for all of them."""
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "fleet", default_value=share("multibot_example", "config", "fleet_gz.yaml")
            ),
            DeclareLaunchArgument(
                "robots", default_value="", description="only these: robot1,robot2"
            ),
            DeclareLaunchArgument("world", default_value="empty.sdf"),
            IncludeLaunchDescription(
                share("ros_gz_sim", "launch", "gz_sim.launch.py"),
                launch_arguments=[("gz_args", ["-r ", LaunchConfiguration("world")])],
            ),
            each_robot(FLEET, actions, robots=LaunchConfiguration("robots")),
            bridge("/", bridge_config(fleet=FLEET)),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", rviz_config("rover.rviz", fleet=FLEET)],
                parameters=[SIM],
            ),
        ]
    )
