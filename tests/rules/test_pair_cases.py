# SPDX-License-Identifier: Apache-2.0
"""Small plans beside small graphs: what is said of them, and what is right and stays unsaid.

Of ``rules/system``: what asks a plan.
"""

from __future__ import annotations

import pytest
from graph_calls import check
from graph_examples import read_example

from multibot_rewrite.system.records import Edge

TWIST, TEXT = "geometry_msgs/msg/Twist", "std_msgs/msg/String"


ORDER = f"/robot1/driver subscribes /robot1/cmd_vel {TWIST}"
SCAN = "/robot1/driver publishes {} sensor_msgs/msg/LaserScan"
ALONE = """\
planned: frames of robot1 on /robot1/tf: robot1/base_link, {}robot1/odom
as planned: /robot1/amcl publishes /robot1/tf tf2_msgs/msg/TFMessage
as planned: transform map -> robot1/odom on /robot1/tf by /robot1/amcl
"""
# robot_state_publisher by another name.
DESCRIBED = "as planned: /robot1/driver publishes /robot1/robot_description std_msgs/msg/String\n"
FRAMES = (
    "planned: frames of robot1 on /robot1/tf: robot1/base_link, robot1/laser\n"
    "as planned: /robot1/robot_state_publisher publishes /robot1/tf_static tf2_msgs/msg/TFMessage\n"
    "running: transform {} -> {} on /robot1/tf_static by /robot1/robot_state_publisher"
)
TWO = "planned: /robot1/arm\nplanned: /robot1/driver\nplanned: /robot2/driver\n"


@pytest.mark.parametrize(
    "row",
    [
        (f"planned: {ORDER}\nrunning: {ORDER}Stamped",
         f"MG306 uses /robot1/cmd_vel as {TWIST}Stamped, but the plan has it as {TWIST};"
         " velocities are stamped on one side? If this type is right, correct the plan"),
        (f"planned: {ORDER}Stamped\nrunning: {ORDER}",
         f"MG306 uses /robot1/cmd_vel as {TWIST}, but the plan has it as {TWIST}Stamped;"
         " velocities are stamped on one side? If this type is right, correct the plan"),
        (f"planned: {ORDER}\nrunning: {ORDER}X",
         f"MG306 uses /robot1/cmd_vel as {TWIST}X, but the plan has it as {TWIST};"
         " another version or setting of the node? If this type is right, correct the plan"),
        (FRAMES.format("robot1/base_link", "robot1/laser"),),
        (FRAMES.format("robot1/base_link", "robot1/lasr"),
         "MG204 frame robot1/lasr is not in the description of robot1; did you mean"
         " robot1/laser? Otherwise add it to other_frames of the plan"),
        (FRAMES.format("robot1/base_link", "robot1/tool"),
         "MG208 frame robot1/laser of robot1 is in no transform: robot1/laser; has"
         " /robot1/robot_state_publisher the description of robot1, or that of another robot?",
         "MG204 frame robot1/tool is not in the description of robot1; a sensor's own frame?"
         " Then add it to other_frames of the plan"),
        # A description of one link has no transform: its frame comes with the odometry.
        (ALONE.format(""),),
        (ALONE.format("robot1/laser, "),
         "MG208 2 of the 3 frames of robot1 are in no transform: robot1/base_link, robot1/laser;"
         " no planned node publishes its description: is the node that does it running?"),
        (ALONE.format("robot1/laser, ") + DESCRIBED,
         "MG208 2 of the 3 frames of robot1 are in no transform: robot1/base_link, robot1/laser;"
         " has robot_state_publisher the description of robot1, or that of another robot?"),
        (FRAMES.format("base_link", "laser"),
         "MG207 frames base_link, laser on /robot1/tf do not have the name of robot1; expected"
         " robot1/base_link: load the rewritten description in /robot1/robot_state_publisher"),
        (TWO + "running: /robot1/arm\nrunning: /robot1/driver",
         "MG109 none of the 1 nodes of robot2 is in the graph; is the robot started, and with"
         " this ROS_DOMAIN_ID? Only this machine is checked: range LOCALHOST, no"
         " ROS_STATIC_PEERS"),
        (TWO + "running: /arm\nrunning: /robot1/driver\nrunning: /robot2/driver",
         "MG101 node /robot1/arm is in the plan, but not in the graph; /arm is running: it was"
         " started without the robot's namespace; use namespace='robot1' in the launch file, or"
         " --ros-args -r __ns:=/robot1"),
        (f"planned: {SCAN.format('/robot1/scan')}\nrunning: {SCAN.format('/robot1/scn')}",
         "MG102 should publish topic /robot1/scan, but does not; it publishes /robot1/scn"
         " instead: is the name misspelled in a remap rule or parameter?"),
        (f"planned: {SCAN.format('/robot1/scan')}\nrunning: {SCAN.format('/robot1/laser')}",
         "MG102 should publish topic /robot1/scan, but does not; it publishes /robot1/laser of"
         " that type: is that meant?"),
    ],
)  # fmt: skip
def test_what_is_other_than_planned_and_why(row: tuple[str, ...]) -> None:
    lines, *said = row
    plan, graph = read_example(lines)
    assert [f"{it.code} {it.message}; {it.hint}" for it in check(plan, graph)] == said


def test_a_link_alone_is_missed_where_a_node_is_planned_to_send_it() -> None:
    plan, graph = read_example(ALONE.format(""))
    odometry = Edge("robot1/base_link", "robot1/odom", "/robot1/tf", False, ("/robot1/amcl",))
    found = check(plan._replace(edges=(odometry,)), graph)
    assert ("MG208", ("robot1/base_link",)) in {(it.code, it.names) for it in found}


AMCL = "as planned: /robot1/amcl\nas planned: /robot2/amcl\n"
HAS = AMCL + "planned: parameter {} of /robot1/amcl: {}\nrunning: /robot1/amcl has {} {}\n"
SET = "planned: parameter a of /robot2/amcl: {}\n"
CHANGE = "change it, or states of the plan"
LIDAR = "planned: host of /robot{0}/lidar: {1}\nrunning: /robot{0}/lidar on machine {2}\n"
CAMERA = LIDAR.replace("lidar", "camera")


@pytest.mark.parametrize(
    "row",
    [
        (HAS.format("a", "x", "a", "x"),),
        (HAS.format("a", "1", "a", "2"), f"MG132 a is 2, planned is 1; {CHANGE}"),
        (HAS.format("a", "1", "a", "true"), f"MG132 a is true, planned is 1; {CHANGE}"),
        (HAS.format("a", "false", "a", "0"), f"MG132 a is 0, planned is false; {CHANGE}"),
        # It does not have the parameter: not known.
        (HAS.format("a", "x", "b", "y"),),
        (HAS.format("a", "x", "a", "y") + SET.format("y"),
         f"MG132 a is \"y\", planned is \"x\"; has it the parameters of robot2? {CHANGE}"),
        (HAS.format("a", "x", "a", "y") + SET.format("z"),
         f"MG132 a is \"y\", planned is \"x\"; {CHANGE}"),
        (LIDAR.format(1, "a", 1) + CAMERA.format(1, "a", 1),),
        (LIDAR.format(1, "a", 1) + LIDAR.format(2, "b", 2),),
        (LIDAR.format(1, "a", 1) + LIDAR.format(2, "b", 1),
         "MG133 hosts a, b are one machine; is this a simulation? Then leave out host"),
        (LIDAR.format(1, "a", 1) + LIDAR.format(2, "a", 1) + CAMERA.format(1, "a", 2),
         "MG133 not on a, where /robot1/lidar, /robot2/lidar runs: /robot1/camera; start it"
         " there, or change host in the plan"),
        ("planned: state of /robot1/amcl: active\n" + AMCL + "running: /robot1/amcl is inactive",
         "MG511 /robot1/amcl is inactive, not active; see the log of its lifecycle manager; ros2"
         " lifecycle get /robot1/amcl"),
        ("planned: state of /robot1/amcl: active\n" + AMCL + "running: /robot1/amcl is active",),
        ("planned: state of /robot1/amcl: active\n" + AMCL,),
    ],
)  # fmt: skip
def test_states_parameters_and_machines(row: tuple[str, ...]) -> None:
    lines, *said = row
    plan, graph = read_example(lines)
    found = [it for it in check(plan, graph) if it.code in ("MG511", "MG132", "MG133")]
    assert [f"{it.code} {it.message}; {it.hint}" for it in found] == said


@pytest.mark.parametrize(("value", "count"), [("1.0", 0), ("1", 0), ("1.5", 1), ("true", 1)])
def test_people_write_a_whole_number_either_way(value: str, count: int) -> None:
    plan, graph = read_example(HAS.format("a", "1", "a", "1"))
    (it,) = graph.parameters
    graph = graph._replace(parameters=(it._replace(value=value),))
    assert [it.code for it in check(plan, graph)].count("MG132") == count


NODES = "as planned: /robot1/a\nas planned: /robot2/a\n"
USES = "running: /robot1/a {} {} {}\n"
NOT_SHARED = ", and is not in shared_topics: robots that do the same use one topic"


@pytest.mark.parametrize(
    "row",
    [
        (USES.format("publishes", "/robot1/x", TEXT),),
        (USES.format("publishes", "/x", TEXT),
         f"uses /x, which is not a name of robot1{NOT_SHARED}; an absolute name in its"
         " code or parameters; pass /x:=/robot1/x with --ros-args -r /x:=/robot1/x, or with"
         " remappings=[('/x', '/robot1/x')] in the launch file"),
        ("planned: shared topic /x\n" + USES.format("publishes", "/x", TEXT),),
        # Everybody's.
        (USES.format("publishes", "/rosout", "rcl_interfaces/msg/Log"),),
        (USES.format("publishes", "/robot2/x", TEXT),
         "publishes /robot2/x, a name of robot2; correct the remap rule or parameter of"
         " robot1 that names robot2"),
        (USES.format("subscribes", "/robot2/x", TEXT),
         "subscribes to /robot2/x, a name of robot2; correct the remap rule or parameter of"
         " robot1 that names robot2"),
        (USES.format("calls", "/robot2/x", "std_srvs/srv/Trigger"),
         "has a client for /robot2/x, a name of robot2; correct the remap rule or parameter of"
         " robot1 that names robot2"),
        (f"planned: /robot1/a publishes /robot1/x {TEXT} as /x\n"
         + USES.format("publishes", "/x", TEXT),
         "should publish topic /robot1/x, but does not; it publishes /x instead: the remap rule"
         " /x:=x is not applied; pass it with --ros-args -r /x:=x, or with"
         " remappings=[('/x', 'x')] in the launch file"),
    ],
)  # fmt: skip
def test_names_of_the_wrong_robot(row: tuple[str, ...]) -> None:
    lines, *said = row
    plan, graph = read_example(NODES + lines)
    found = [it for it in check(plan, graph) if it.code.startswith("MG3")]
    assert [f"{it.message}; {it.hint}" for it in found] == said


def test_a_name_that_the_plan_has_for_several_robots() -> None:
    line = f"as planned: /robot{{}}/a publishes /x {TEXT}"
    plan, graph = read_example("\n".join(line.format(it) for it in (1, 2)))
    cause = "no remap rule changes it: set the node's parameter, or add it to shared_topics"
    said = "uses /x, which the plan has for several robots: robot1, robot2"
    found = [it for it in check(plan, graph) if it.message == said]
    assert [(it.node, it.hint) for it in found] == [("/robot1/a", cause)]


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("/scan", "/robot1/scan, /robot2/scan"),
        # Of a robot that is called otherwise.
        ("/bot1/scan", "/robot1/scan, /robot2/scan"),
        ("/scan/bot1", "/robot1/scan, /robot2/scan"),
        ("/odom", ""),
        ("/robot1/scan", ""),
        ("/shared", ""),
        ("/rosout", ""),
        # A service is no topic.
        ("/srv", ""),
    ],
)
def test_a_topic_of_no_robot_where_no_nodes_are_known(name: str, meant: str) -> None:
    line = f"planned: /robot{{0}}/a publishes /robot{{0}}/scan {TEXT}\n"
    line += "planned: /robot{0}/a serves /robot{0}/srv std_srvs/srv/Trigger\n"
    plan, graph = read_example(
        f"{line.format(1)}{line.format(2)}planned: shared topic /shared\n"
        f"running: /x publishes {name} {TEXT}"
    )
    ends = tuple(it._replace(node="") for it in graph.ends)
    found = check(plan, graph._replace(nodes=(), ends=ends))
    cause = "start its node in its robot's namespace, with the rules of multibot plan"
    said = [f"{it.message}; {it.hint}" for it in found if "is of no robot" in it.message]
    assert said == [f"{name} is of no robot; planned: {meant}; {cause}"] * bool(meant)


@pytest.mark.parametrize(
    ("lines", "level"),
    [
        (ALONE.format("robot1/laser, "), "inconclusive"),
        (ALONE.format("robot1/laser, ") + DESCRIBED, "error"),
        # It has a topic of that name and reads it: the transforms come from another one.
        (
            ALONE.format("robot1/laser, ") + DESCRIBED.replace("publishes", "subscribes"),
            "inconclusive",
        ),
        (ALONE.format("robot1/laser, ") + DESCRIBED.replace("robot1", "robot2"), "inconclusive"),
        # Something sends its description, and one frame of it is missing.
        (FRAMES.format("robot1/base_link", "robot1/tool"), "error"),
        (
            ALONE.format("robot1/laser, ")
            + "running: transform robot1/odom -> robot1/laser on /robot1/tf by /robot1/amcl\n",
            "error",
        ),
    ],
)
def test_frames_of_a_description_that_no_planned_node_sends(lines: str, level: str) -> None:
    found = check(*read_example(lines))
    assert {it.level for it in found if it.code == "MG208"} == {level}


def test_how_many_robots_use_a_name_of_none() -> None:
    lines = NODES + USES.format("publishes", "/x", TEXT)
    two = lines + USES.format("subscribes", "/x", TEXT).replace("robot1", "robot2")
    said = {it.message for it in check(*read_example(two)) if "which is not" in it.message}
    assert said == {f"uses /x, which is not a name of robot{it}: 2 robots use it" for it in (1, 2)}


STATE_TF = "/robot1/robot_state_publisher publishes /robot1/tf_static tf2_msgs/msg/TFMessage"
STATIC = "running: transform {} -> {} on {} by /robot1/robot_state_publisher\n"
TREE = (
    "planned: frames of robot1 on /robot1/tf: robot1/base_link, robot1/laser, robot1/tool\n"
    f"as planned: {STATE_TF}\n"
)
OWN_TF = "/robot1/tf_static"
LASER = STATIC.format("robot1/base_link", "robot1/laser", OWN_TF)
SENT = LASER + STATIC.format("{}", "robot1/tool", OWN_TF)
PIECES = "MG406 the tf tree of robot1 on /robot1/tf has 2 roots: {}; "
ON_TF = (
    "/robot1/robot_state_publisher sends tf on /tf, but the tf of robot1 is on /robot1/tf; pass -r"
    " /tf:=tf -r /tf_static:=tf_static to each node; if it shares a process, to the whole process"
)


@pytest.mark.parametrize(
    "row",
    [
        (TREE + SENT.format("robot1/base_link"),),
        # A frame that is like none but for the robot's name is no slip.
        (TREE + SENT.format("robot1/arm"),
         PIECES.format("robot1/arm, robot1/base_link") + "a transform between them is missing:"
         " joint states of a moving joint, odometry or localization"),
        (TREE + SENT.format("robot1/base_lnk"),
         PIECES.format("robot1/base_link, robot1/base_lnk") + "robot1/tool is sent below"
         " robot1/base_lnk, but nothing sends that: did you mean robot1/base_link?"),
        (TREE + SENT.format("base_link"),
         PIECES.format("base_link, robot1/base_link") + "base_link and robot1/base_link are one"
         " frame with two names: by the plan /robot1/robot_state_publisher sends the second,"
         " robot1/base_link"),
        (TREE.replace(", robot1/tool", "")
         + LASER + STATIC.format("robot1/laser", "robot1/base_link", OWN_TF),
         "MG403 the transforms on /robot1/tf go round in a circle: robot1/laser ->"
         " robot1/base_link -> robot1/laser; the node that sends on /robot1/tf:"
         " /robot1/robot_state_publisher"),
        (TREE + SENT.format("robot1/base_link").replace(OWN_TF, "/tf_static"), f"MG405 {ON_TF}"),
        (TREE.replace(", robot1/tool", "") + LASER.replace(OWN_TF, "/tf_static"), f"MG405 {ON_TF}"),
        (TREE.replace(", robot1/tool", "").replace("/robot1/tf", "/tf").replace("as p", "p")
         + f"planned: frames of robot2 on /tf: robot2/base_link\nrunning: {STATE_TF}\n" + LASER,
         "MG405 /robot1/robot_state_publisher sends tf on /robot1/tf, but the tf of robot1 is on"
         " /tf; by the plan it should publish topic /tf_static, but does not: it publishes"
         " /robot1/tf_static instead: the node resolves a relative name in its own namespace:"
         " write /tf_static in its parameters"),
    ],
)  # fmt: skip
def test_why_a_tree_is_not_as_planned(row: tuple[str, ...]) -> None:
    lines, *said = row
    plan, graph = read_example(lines)
    assert [f"{it.code} {it.message}; {it.hint}" for it in check(plan, graph)] == said


ALIKE = "".join(
    f"{word}: /robot{robot}/{node} publishes /robot{robot}/{node}/x {TEXT}\n"
    for word in ("planned", "running")
    for robot in (1, 2, 3)
    for node in ("a", "b", "c", "d")
    if (robot, node) != (3, "d")
)


@pytest.mark.parametrize(("more", "is_told"), [("", False), ("planned: /robot3/d\n", True)])
def test_a_robot_that_is_planned_without_what_others_have(more: str, is_told: bool) -> None:
    plan, graph = read_example(ALIKE + more)
    codes = {it.code for it in check(plan, graph)}
    assert "MG327" not in codes or is_told
    assert ("MG101" in codes) is is_told


@pytest.mark.parametrize(("frame", "level"), [("robot1/lasr", "error"), ("robot1/tool", "warning")])
def test_a_frame_in_place_of_a_planned_one_is_an_error(frame: str, level: str) -> None:
    found = check(*read_example(FRAMES.format("robot1/base_link", frame)))
    assert [it.level for it in found if it.code == "MG204"] == [level]


def test_each_robot_that_lacks_a_name_is_told() -> None:
    """Both send on one topic in place of their own: who waits for robot2's is no matter of robot1."""
    sent = (
        f"planned: /robot{{0}}/a publishes /robot{{0}}/x {TEXT} as /x\n"
        f"running: /robot{{0}}/a publishes /x {TEXT}\n"
        f"as planned: /robot{{0}}/b subscribes /robot{{0}}/x {TEXT}\n"
    )
    found = check(*read_example(sent.format(1) + sent.format(2)))
    assert [(it.code, it.node) for it in found] == [("MG303", "/robot1/b"), ("MG303", "/robot2/b")]
    assert all(
        f"by the plan /robot{at}/a should publish" in it.hint for at, it in enumerate(found, 1)
    )


TF = "tf2_msgs/msg/TFMessage"
ELSEWHERE = f"""\
planned: frames of robot1 on /robot1/tf: robot1/foot, robot1/wheel, robot1/mast, robot1/laser
as planned: /robot1/robot_state_publisher publishes /robot1/tf {TF}
running: transform robot1/foot -> robot1/wheel on /robot1/tf
running: transform robot1/mast -> robot1/laser on /robot1/tf
running: /ros_gz_bridge publishes /gz/tf {TF}
running: transform robot1/foot -> robot1/mast on /gz/tf
"""


@pytest.mark.parametrize("topic", ["/gz/tf", "/gz/others"])
def test_frames_on_another_topic_are_meant_where_a_row_brings_them_there(topic: str) -> None:
    """Where nothing says who sent them, a plan alone tells where they belong."""
    row = f"planned: topic {topic} over a bridge that publishes {TF}"
    found = [it.names for it in check(*read_example(ELSEWHERE + row)) if it.code == "MG405"]
    odd = [("robot1/mast", "/gz/tf", "/robot1/tf")]
    assert found == ([] if topic == "/gz/tf" else odd)


def test_a_tree_lacks_what_a_row_brings_elsewhere() -> None:
    """What is on another topic because of a slip is a finding of its own, this is not."""
    row = f"planned: topic /gz/tf over a bridge that publishes {TF}"
    for text, codes in ((row, {"MG406"}), ("planned: shared topic /x", {"MG405"})):
        found = check(*read_example(ELSEWHERE + text))
        assert {it.code for it in found} & {"MG405", "MG406"} == codes


@pytest.mark.parametrize(
    ("sender", "reader"),
    [
        ("publishes /clock rosgraph_msgs/msg/Clock", "subscribes /clock rosgraph_msgs/msg/Clock"),
        ("serves /reset std_srvs/srv/Empty", "calls /reset std_srvs/srv/Empty"),
    ],
)
def test_who_has_to_give_what_all_robots_wait_for_is_the_cause(sender: str, reader: str) -> None:
    """One node of the robot that waits for it has to."""
    found = check(
        *read_example(
            f"planned: shared topic {sender.split()[1]}\n"
            f"planned: /robot1/giver {sender}\nrunning: /robot1/giver\n"
            f"as planned: /robot1/ekf_node {reader}\nas planned: /robot2/ekf_node {reader}"
        )
    )
    assert [(it.code, it.node) for it in found] == [("MG102", "/robot1/giver")]
