# SPDX-License-Identifier: Apache-2.0
"""What is known of nodes of public packages: one entry a node, by family in ``nodes/*.yaml``.

A file of a user has the same form. The whole of it:

    sent: [FRAME...]           frames that nodes publish, beside the usual ones
    guesses: {KIND: [WORD...]} last words of parameters that no entry lists, and what they suggest
    parts: {NAME: ...}         endpoints that many nodes have; a node has them by ``with``
    nodes: {NAME: ...}         a node by its usual name, ``above/name`` in a namespace of its own
    stacks: {NAME: ...}        nodes that are started together (``stacks.yaml``)

A node:

    package    the ROS package that has it
    note       what else a reader of the page should know
    host       the node whose process it always runs in
    plugin     that of the simulator that makes it
    programs   the executables that run it, the usual one first, its own name if empty; those of other
               packages as package/executable. A NoDL file may have their names
    component  its class as a component
    shared     true: one node serves all robots
    apart      true: its code sets its name, or that of a node below it, so it keeps its name and
               has its robot's namespace in every layout
    when       the condition under which it is started (``conditions.py``)
    with       the parts it has
    publishes, subscribes, serves, calls   its endpoints by name; /msg/ is a topic, /srv/ a service,
               /action/ an action. A node with parameters and nothing of a graph (none of these, nor
               host, plugin, with, claims, frames) is known by its parameters alone
    fixed      what else no remap rule reaches
    frames     parameters of no section that hold frames: name -> default, or a list of {default,
               releases, source}; those under ``params`` are taken from there
    sends      the parameter of the parent -> that of the child in a transform it sends, or {child,
               if}, or a list of these
    claims     command or state -> the interfaces that a controller claims, as templates over its
               parameters (``producers/evidence/hardware.py``)
    ids        a word in <> -> the parameter that lists what it stands for; the type of a list of
               names and types is list/msg/Type, list/srv/Type or list/action/Type
    aliases    other usual names; ``types``: of controllers, as a controller manager loads them;
               ``deprecated_types``: type -> releases; ``known_by``: a section under any other name
               that sets all of these is this node
    absolute   releases in which a relative topic in it is not resolved in the robot's namespace, so
               that it is made absolute; ``strips``: those in which it takes off a slash that a
               frame starts with
    declared_in   packages besides its own whose classes declare parameters on it
    params     its parameters by path; those that hold no names are in ``declared.schema``

An endpoint is a type or {...}: type, also (other types, by parameter or release), types (condition
-> the one of them that it has), parameter (sets the name), transport (an image topic, with its
image_transport siblings), remapped (its name after the rule of the usual launch files), when (the
condition under which it exists), if (the condition on the node's parameters, for where these are
known: ``conditions.py``), helper (a helper node has it, which only rules for the whole process
reach), by (that node's name behind its node's; * is made at run time: _private_*), above (releases
in which a relative name from its parameter is resolved in the namespace above the node's own),
fixed (why no rule reaches it), beside (the endpoint whose name it takes, but for the last word),
note; a list of {...} where it differs from release to release. A name in <> is made at run time; a
stack sets it under ``names``.

A parameter is a kind or {...}: kind, default (of the code), list (an array of strings), absolute
(as above), deprecated (releases), own (true: a frame that the node makes), note; a list of {...}
where it differs from release to release. A path is the dotted name; <joint>, <sensor>, <gpio>,
<frame>, <interface>, <controller>, <group> stand for one such name, <id> for an id of the node's
own, * for any word, <index> for digits (odom<index> = odom0). Where a file sets a parameter that
the release lacks, it is renamed all the same; only its default is not inserted. Kinds:

    frame, link, joint, sensor, gpio, hardware, group, interface (elbow/position), component (joint,
               sensor or gpio), topic, service, node, controller, namespace: names
    stem       the beginning of frames (camera of camera_link)
    link_prefix, joint_prefix, gpio_prefix   put before names of the description by the node
    joint_stem the same, with _ behind it if it is not empty
    words      text with names of the description in it; ``text``, ``pattern``: names may be in it,
               but are not rewritten
    doubles    put before frames with a slash between, which adds the robot's name a second time
               where they have it; ``doubles_as_is``: the same without a slash
    off        must be false
    no_prefix  puts a prefix before frames, ~ is the namespace; must be /, which is no prefix
    port       a number that one node on a computer can have: further robots get a higher one
    output     a file or folder that the node writes: it gets the robot's name
    exclusive  two robots cannot have the same
    keep       not a name of a robot, whatever it looks like

Every fact may have releases (the only ones that have it, with commas between: jazzy; kilted+ for it
and all later; <=jazzy for it and all earlier; "jazzy 1.3.9+" for jazzy from that version of the
package on, which makes it conditional there) and source (one or a list of OWNER/NAME@TAG-OR-COMMIT
PATH[:LINE]).

Read, where no source is named: navigation2 jazzy f4108e5b1 (kilted 71a1d84f4, main a3a97043e),
slam_toolbox a3442d2, robot_localization 1cb9533, ros2_control jazzy 9ffbf97fd, ros2_controllers
jazzy ed360c97d, gz_ros2_control jazzy fa9ced4, moveit2 jazzy 4d8410635, rviz jazzy 591594ee, ros_gz
jazzy 739cb42, geometry2 jazzy 646342c6, image_common jazzy d04d2c8, twist_mux d929f1b, teleop_tools
99d16d7, joystick_drivers 881f3a5, cartographer_ros d4c62f7, rtabmap_ros aec4f91f, imu_tools
c8a27cd, laser_filters 905f5e9, velodyne 04a7ca7, ouster-ros eaaf35d, realsense-ros ee94dc92,
pointcloud_to_laserscan d71ed2e, sick_scan_xd a562c5d, image_pipeline 30b982af, rplidar_ros 1597018,
sllidar_ros2 3430009, urg_node 369ee4d, depthai-ros b39899f, usb_cam 772b25f, ros-foxglove-bridge
4e801bb, rosbridge_suite c1bfc2f, nmea_navsat_driver 548c84a, ublox 577ef65, apriltag_ros beffb4c,
m-explore-ros2 926033f, depthimage_to_laserscan 79b60bf, Universal_Robots_ROS2_Driver 696e1a7b
(humble eca2357c, jazzy a16a2687, kilted 3252ef56, lyrical dcf9d0d1), franka_ros2 humble 43357d1 and
jazzy 29cb85a, xarm_ros2 jazzy 0417b0f, ros2_robotiq_gripper 3b6cf8f, picknik_controllers c605b68,
husarion_controllers jazzy 9916ab4. ros2_kortex, xarm_ros2 and ros2_robotiq_gripper have no more
controllers or nodes of their own than are listed.
"""
