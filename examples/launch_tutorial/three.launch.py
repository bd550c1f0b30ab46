from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from multibot_rewrite.launch import bridge_config, each_robot, node, place, spawn

HERE = Path(__file__).parent
FLEET = str(HERE / "fleet.yaml")


def actions(robot):
    model = spawn("gz")
    bridge = Node(
        package="ros_gz_bridge",
        executable="parameter_bridge",
        namespace=robot.namespace,
        parameters=[{"config_file": bridge_config()}],
    )
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
        place(),
        model,
        # Its topics are there when it has been spawned.
        RegisterEventHandler(OnProcessExit(target_action=model, on_exit=[bridge])),
    ]


def generate_launch_description():
    return LaunchDescription(
        [
            # A name, some names with commas, or robots with their poses in place of those of the file.
            DeclareLaunchArgument("robots", default_value=""),
            each_robot(FLEET, actions, robots=LaunchConfiguration("robots")),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                name="shared_bridge",
                parameters=[{"config_file": bridge_config(fleet=FLEET)}],
            ),
        ]
    )
