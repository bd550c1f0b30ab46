# SPDX-License-Identifier: Apache-2.0
"""Values below ``<gazebo>`` and parameters of plugins: what is found, and what is left alone.

What libsdformat makes of a value was tried with libsdformat 12.3 (``sdf::Root::Load``,
``Element::Get`` of a plugin's parameters).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from lint_calls import Settings, lint_data

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.description.rewriters.plugin_definitions import load_definitions
from multibot_rewrite.rules.schema.described import chunks, described

NEW = Settings(select=("MB11", "MB120", "MB124", "MB125", "MB15", "MB16", "MB17"))
LINK = (
    '<link name="a"><inertial><mass value="1"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>'
    '<link name="b"/><joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>'
)


def codes(inside: str, distro: str = "jazzy") -> list[str]:
    """Return the codes of what is found in a robot of two links and a joint."""
    text = f'<robot name="r">{LINK}{inside}</robot>'
    found = lint_data("r.urdf", text.encode(), NEW._replace(distro=distro))
    return [it.code for it in found]


def linted(inside: str, _folder: Path) -> set[str]:
    """Return what all rules find in it."""
    text = f'<robot name="r">{LINK}{inside}</robot>'
    return {it.code for it in lint_data("r.urdf", text.encode(), Settings(distro="jazzy"))}


def defects() -> Iterator[tuple[str, str, str]]:
    """Each planted defect, the same without it, and its code."""
    return ((it, "", code) for code, texts in PLANTED.items() for it in texts.values())


def in_link(inside: str) -> str:
    return f'<gazebo reference="a">{inside}</gazebo>'


def sensor(type_: str, inside: str = "") -> str:
    return in_link(f'<sensor name="s" type="{type_}">{inside}</sensor>')


def system(library: str, class_: str, inside: str = "") -> str:
    name = f'name="gz::sim::systems::{class_}" filename="gz-sim-{library}-system"'
    return f"<gazebo><plugin {name}>{inside}</plugin></gazebo>"


def classic(library: str, inside: str = "") -> str:
    return f'<gazebo><plugin name="p" filename="lib{library}.so">{inside}</plugin></gazebo>'


def a_plugin(name: str, library: str) -> str:
    return f'<gazebo><plugin name="{name}" filename="{library}"/></gazebo>'


def hardware(class_: str, inside: str = "") -> str:
    inside = f"<hardware><plugin>{class_}</plugin>{inside}</hardware>"
    return f'<ros2_control name="s" type="system">{inside}</ros2_control>'


def camera(inside: str) -> str:
    return sensor("camera", f"<camera>{inside}</camera>")


DRIVE = ("diff-drive", "DiffDrive")
MOTOR = ("multicopter-motor-model", "MulticopterMotorModel")
ROS_1_SPACE = "<robotNamespace>a</robotNamespace>"
OF_ROS_1 = f"{ROS_1_SPACE}<bodyName>a</bodyName><topicName>a</topicName><frameName>a</frameName>"
CONTROL = (
    '<plugin name="gz_ros2_control::GazeboSimROS2ControlPlugin" filename="gz_ros2_control-system">'
    "<parameters>a.yaml</parameters>"
)
PLANTED: dict[str, dict[str, str]] = {
    "MB124": {
        "type of a sensor": sensor("camra"),
        "type in capitals": sensor("Camera"),
        "image format": camera("<image><format>R8G8B</format></image>"),
        "image format of ROS": camera("<image><format>rgb8</format></image>"),
        "type of a light": in_link('<light name="l" type="spott"/>'),
        "type of a noise": camera("<noise><type>gausian</type></noise>"),
        "a turning direction": system(
            "multicopter-motor-model",
            "MulticopterMotorModel",
            "<turningDirection>ccww</turningDirection>",
        ),
        "a turning direction of Classic": classic(
            "ArduCopterPlugin", "<rotor><turningDirection>ccww</turningDirection></rotor>"
        ),
    },
    "MB125": {
        "field of view in degrees": camera("<horizontal_fov>60</horizontal_fov>"),
        "a negative deviation": sensor(
            "air_pressure",
            '<air_pressure><pressure><noise type="gaussian">'
            "<stddev>-1</stddev></noise></pressure></air_pressure>",
        ),
        "no radius": system(*DRIVE, "<wheel_radius>0</wheel_radius>"),
        "a negative rate": system(*DRIVE, "<odom_publish_frequency>-1</odom_publish_frequency>"),
        "a label above 255": system("label", "Label", "<label>256</label>"),
        "a latitude beyond the pole": classic(
            "hector_gazebo_ros_gps", "<referenceLatitude>151.2</referenceLatitude>"
        ),
    },
    "MB120": {
        "rate in words": sensor("imu", "<update_rate>fast</update_rate>"),
        "rate with a decimal comma": sensor("imu", "<update_rate>0,5</update_rate>"),
        "rate with a unit": sensor("imu", "<update_rate>30 Hz</update_rate>"),
        "yes for true": sensor("imu", "<always_on>yes</always_on>"),
        "1.0 for true": sensor("imu", "<visualize>1.0</visualize>"),
        "five numbers in a pose": sensor("imu", "<pose>0 0 0 0 0</pose>"),
        "two numbers in a direction": in_link(
            '<light name="l" type="spot"><direction>1 0</direction></light>'
        ),
        "a colour of 255": in_link(
            '<light name="l" type="spot"><diffuse>255 0 0 1</diffuse></light>'
        ),
        "friction in words": in_link("<mu1>high</mu1>"),
        "self collision": in_link("<selfCollide>maybe</selfCollide>"),
        "gravity off": in_link("<gravity>off</gravity>"),
        "a pixel and a half": camera("<image><width>640.5</width></image>"),
        "negative samples": sensor(
            "ray", "<ray><scan><horizontal><samples>-5</samples></horizontal></scan></ray>"
        ),
        "a rate in words in ROS 1": classic(
            "gazebo_ros_p3d", f"{OF_ROS_1}<updateRate>fast</updateRate>"
        ),
        "a radius of a block in words": system(
            "wheel-slip",
            "WheelSlip",
            '<wheel link_name="a"><wheel_radius>ten</wheel_radius></wheel>',
        ),
        "a radius in words": system(*DRIVE, "<wheel_radius>ten cm</wheel_radius>"),
        "a radius with a comma": system(*DRIVE, "<wheel_radius>0,1</wheel_radius>"),
        "on for true": classic("gazebo_ros_diff_drive", "<ros/><publish_odom>on</publish_odom>"),
        "two numbers of a centre of pressure": classic("LiftDragPlugin", "<cp>1 2</cp>"),
        "one number for three axes": classic(
            "hector_gazebo_ros_imu", f"{ROS_1_SPACE}<accelDrift>0.5</accelDrift>"
        ),
        "a rate of hector in words": classic(
            "hector_gazebo_ros_sonar", f"{ROS_1_SPACE}<updateRate>ten</updateRate>"
        ),
        "a parameter of one joint of a trajectory": system(
            "joint-trajectory-controller",
            "JointTrajectoryController",
            "<position_p_gain>high</position_p_gain>",
        ),
    },
    "MB115": {
        "a sensor without name": in_link('<sensor type="imu"/>'),
        "a sensor with an empty name": in_link('<sensor name="" type="imu"/>'),
        "a sensor without type": in_link('<sensor name="s"/>'),
        "a plugin without library": '<gazebo><plugin name="p"/></gazebo>',
        "no topic of p3d in ROS 1": classic(
            "gazebo_ros_p3d", "<robotNamespace>a</robotNamespace><bodyName>a</bodyName>"
        ),
        "no joint of a thruster": system("thruster", "Thruster"),
        "no link of p3d": classic("gazebo_ros_p3d", "<ros/>"),
        "no link of Classic's battery": classic(
            "LinearBatteryPlugin", "<battery_name>b</battery_name>"
        ),
    },
    "MB110": {
        "updateRate": sensor("imu", "<updateRate>9</updateRate>"),
        "horizontal_fow": camera("<horizontal_fow>1</horizontal_fow>"),
        "provide_feedback of a joint": (
            '<gazebo reference="j"><provide_feedback>true</provide_feedback></gazebo>'
        ),
        "max_contacts of a link": in_link("<max_contacts>9</max_contacts>"),
        "a library": a_plugin("gz::sim::systems::X", "gz-sim-dif-drive-system"),
        "a library of Classic": classic("gazebo_ros_dif_drive"),
        "a class of hardware": hardware("mock_components/GenericSytem"),
        "hardware with another case": hardware("gz_ros2_control/GazeboSimsystem"),
        "a parameter": system(*DRIVE, "<wheel_seperation>1</wheel_seperation>"),
        "a parameter in camel case": system(
            "thruster", "Thruster", "<joint_name>j</joint_name><fluidDensity>1</fluidDensity>"
        ),
        "a parameter of a plugin of ROS 1": classic(
            "gazebo_ros_p3d", f"{OF_ROS_1}<xyzOffsets>0 0 0</xyzOffsets>"
        ),
        "a parameter of a sensor's plugin": sensor(
            "ray", classic("gazebo_ros_ray_sensor", "<ros/><output_typ>a</output_typ>")[8:-9]
        ),
        "a parameter of hardware": hardware(
            "kortex_driver/KortexMultiInterfaceHardware", '<param name="robot_ipp">1</param>'
        ),
        "a parameter of a block": system(
            "wheel-slip", "WheelSlip", '<wheel link_name="a"><wheel_radus>1</wheel_radus></wheel>'
        ),
        "a block of a block": classic(
            "gazebo_ros_p3d", "<body_name>a</body_name><ros><namespac>a</namespac></ros>"
        ),
        "a parameter of Classic's own plugin": classic(
            "LiftDragPlugin", "<alpha_stal>0.3</alpha_stal>"
        ),
        "a block of Classic's own plugin": classic("LinkPlot3DPlugin", "<plot><lnk>a</lnk></plot>"),
        "a parameter that a helper reads": classic(
            "hector_gazebo_ros_imu", "<rateGausianNoise>0 0 0</rateGausianNoise>"
        ),
    },
    "MB112": {
        "rate in the camera": camera("<update_rate>9</update_rate>"),
        "friction without reference": "<gazebo><mu1>1</mu1></gazebo>",
        "friction of a joint": '<gazebo reference="j"><mu1>1</mu1></gazebo>',
        "feedback of a link": in_link("<provideFeedback>true</provideFeedback>"),
        "a remapping beside its block": (
            f"<gazebo>{CONTROL}<ros><namespace>a</namespace></ros>"
            "<remapping>a:=b</remapping></plugin></gazebo>"
        ),
        "a namespace beside its block": classic(
            "gazebo_ros_p3d", "<ros/><body_name>a</body_name><namespace>a</namespace>"
        ),
    },
    "MB170": {
        "a scan in degrees": sensor(
            "ray", "<ray><scan><horizontal><max_angle>180</max_angle></horizontal></scan></ray>"
        ),
        "a pose in degrees": sensor("imu", "<pose>0 0 0 0 0 -90</pose>"),
        "a steering limit in degrees": system(
            "ackermann-steering", "AckermannSteering", "<steering_limit>30</steering_limit>"
        ),
        "a stall in degrees": classic("LiftDragPlugin", "<alpha_stall>15</alpha_stall>"),
    },
    "MB160": {
        "a class in capitals": system("imu", "IMU"),
        "a class of another library": system("imu", "DiffDrive"),
        "a class for a library": a_plugin("gz-sim-imu-system", "gz::sim::systems::Imu"),
        "a label for a class": a_plugin("drive", "gz-sim-diff-drive-system"),
    },
    "MB163": {
        "a parameter of ROS 1": classic(
            "gazebo_ros_diff_drive", "<ros/><robotBaseFrame>a</robotBaseFrame>"
        ),
        "a parameter of ROS 2 in ROS 1": classic(
            "gazebo_ros_p3d", f"{OF_ROS_1}<update_rate>9</update_rate>"
        ),
        "Classic's parameter in gz": system(*DRIVE, "<wheel_diameter>1</wheel_diameter>"),
        "gz's parameter in Classic": classic(
            "gazebo_ros_diff_drive", "<ros/><wheel_radius>1</wheel_radius>"
        ),
        "gz's parameter in Classic's own plugin": classic(
            "DiffDrivePlugin", "<left_joint>j</left_joint><wheel_separation>1</wheel_separation>"
        ),
        "the parameter of Classic's own plugin in gz": system(
            "elevator", "Elevator", "<lift_joint>j</lift_joint>"
        ),
    },
    "MB111": {
        "a parameter no node reads in ROS 1": classic(
            "gazebo_ros_p3d", f"{OF_ROS_1}<alwaysOn>true</alwaysOn>"
        ),
        "an element of the sensor in a plugin of ROS 1": classic(
            "gazebo_ros_imu", f"{OF_ROS_1}<imu/>"
        ),
        "a name of a block that no node reads": (
            f"<gazebo>{CONTROL}<ros><controlPeriod>1</controlPeriod></ros></plugin></gazebo>"
        ),
        "a parameter no node reads": system(*DRIVE, "<use_sim_time>true</use_sim_time>"),
    },
}


@pytest.mark.parametrize(("code", "defect"), [(it, name) for it in PLANTED for name in PLANTED[it]])
def test_a_planted_defect_is_found_by_its_rule_alone(code: str, defect: str) -> None:
    assert codes(PLANTED[code][defect]) == [code]


HEALTHY = {
    # `ign sdf -k` of sdformat 12: Valid; SDF 1.5 and 1.6 alone have it, with a name.
    "a frame that only an older SDF has there": sensor("air_pressure", "<frame>a</frame>"),
    "a wing of Classic": classic(
        "LiftDragPlugin", "<a0>0.05</a0><cp>0 0 0</cp><link_name>a</link_name>"
    ),
    "an engine of Classic whose joints are in a list": classic(
        "CessnaPlugin", "<propeller_max_rpm>2500</propeller_max_rpm><rudder>j</rudder>"
    ),
    "tracks of Classic, read by the class below": classic(
        "SimpleTrackedVehiclePlugin",
        "<body>a</body><left_track>a</left_track><right_track>b</right_track>"
        "<tracks_separation>0.4</tracks_separation>",
    ),
    "noise of hector by what it is of": classic(
        "hector_gazebo_ros_gps",
        "<updateRate>4.0</updateRate><bodyName>a</bodyName><velocityDrift>0 0 0</velocityDrift>"
        "<gaussianNoise>0.01 0.01 0.01</gaussianNoise>",
    ),
    "a namespace for hector in ROS 2": classic(
        "hector_gazebo_ros_imu", "<ros><namespace>r</namespace></ros><yawDrift>0.1</yawDrift>"
    ),
    "coefficients whose names are put together": system(
        "hydrodynamics", "Hydrodynamics", "<link_name>a</link_name><xDotU>-4</xDotU><yVabsV>-9</yVabsV>"
    ),
    # srmainwaring/asv_wave_sim Hydrodynamics.cc: it reads <enable> and no <link_name>.
    "a class that another library has, called as one of gz-sim": (
        '<gazebo><plugin filename="gz-waves1-hydrodynamics-system"'
        ' name="gz::sim::systems::Hydrodynamics"><enable>m::a</enable></plugin></gazebo>'
    ),
    # Nobody knows it; its name does not make it that of gz-sim, which needs a link.
    "a class of a library that is not known, called as one of gz-sim": (
        '<gazebo><plugin filename="own_water" name="gz::sim::systems::Hydrodynamics"/></gazebo>'
    ),
    "limits of tracks": system(
        "tracked-vehicle", "TrackedVehicle",
        "<linear_velocity><max_velocity>1</max_velocity></linear_velocity>",
    ),
    "a type of SDF 1.6": sensor("ray"),
    "a type of Gazebo Classic": sensor("depth"),
    "a type with a dash of its own": sensor("custom", "<topic>dvl</topic>"),
    "true in capitals": sensor("imu", "<always_on>TRUE</always_on>"),
    "1 for true": sensor("imu", "<always_on>1</always_on>"),
    "a rate of a whole number": sensor("imu", "<update_rate>30</update_rate>"),
    "a rate with an exponent": sensor("imu", "<update_rate>3e1</update_rate>"),
    "a rate behind a comment": sensor("imu", "<update_rate><!-- Hz -->30</update_rate>"),
    "an empty rate": sensor("imu", "<update_rate/>"),
    "pixels with a point": camera("<image><width>640.0</width></image>"),
    "a pose over lines": sensor("imu", "<pose>0 0 0\n  0 0 1.57</pose>"),
    "a pose relative to a link": sensor("imu", '<pose relative_to="b">0 0 0 0 0 0</pose>'),
    "a pose that says degrees": sensor("imu", '<pose degrees="true">0 0 0 0 0 90</pose>'),
    "a quaternion": sensor("imu", '<pose rotation_format="quat_xyzw">0 0 0 0 0 0 1</pose>'),
    "a pose far away": sensor("imu", "<pose>100 0 0 0 0 0</pose>"),
    "a whole turn": camera("<horizontal_fov>6.283186</horizontal_fov>"),
    "no pose": sensor("imu", "<pose></pose>"),
    "a colour of three": in_link('<light name="l" type="spot"><diffuse>1 0 0</diffuse></light>'),
    "a light in the old way": in_link('<light name="l" type="directional"/>'),
    "an old image format": camera("<image><format>R8G8B8</format></image>"),
    "a new image format": camera("<image><format>RGB_INT8</format></image>"),
    "a mask of all bits": camera("<visibility_mask>-1</visibility_mask>"),
    "kd with an exponent": in_link("<kp>1e+13</kp><kd>1.0</kd>"),
    "a value as an attribute": in_link('<mu1 value="0.2"/>'),
    "yes where the converter takes it": in_link("<selfCollide>yes</selfCollide>"),
    "a material of Classic": in_link("<material>Gazebo/Blue</material>"),
    "a material for the visual": in_link(
        "<visual><material><ambient>1 0 0 1</ambient></material></visual>"
    ),
    "a frame of gz-sensors": sensor("imu", "<gz_frame_id>a</gz_frame_id>"),
    "an element in a namespace": sensor("imu", '<gz:frame xmlns:gz="gz">a</gz:frame>'),
    "a value that xacro fills in": sensor("imu", "<update_rate>$(arg rate)</update_rate>"),
    "a reference that is not there": '<gazebo reference="x"><mu1>high</mu1></gazebo>',
    "a plugin of our own": classic("our_drive", "<wheel_seperation>x</wheel_seperation>"),
    **{
        f"a plugin of our own beside those of Classic, {it}": classic(f"gazebo_ros_{it}")
        for it in ("gp", "fan", "rate")
    },
    "a plugin of our own among systems": a_plugin("our::Drive", "gz-sim-our-drive-system"),
    "a versioned library": a_plugin("gz::sim::systems::Imu", "libgz-sim8-imu-system.so"),
    "joints named twice": system(*DRIVE, "<left_joint>j</left_joint><left_joint>k</left_joint>"),
    "a negative limit": system(*DRIVE, "<min_velocity>-1</min_velocity>"),
    "a plugin of ROS 1": classic(
        "gazebo_ros_diff_drive", "<robotNamespace>/a</robotNamespace><publishTf>1</publishTf>"
    ),
    "a namespace and no block": classic(
        "gazebo_ros_p3d", "<body_name>a</body_name><namespace>a</namespace>"
    ),
    "a block that is given away as a whole": system(
        "advanced-lift-drag", "AdvancedLiftDrag",
        "<link_name>a</link_name><control_surface><whatever>1</whatever></control_surface>",
    ),
    "a block of gazebo_ros": classic(
        "gazebo_ros_p3d",
        "<body_name>a</body_name><ros><namespace>a</namespace><remapping>a:=b</remapping>"
        "<argument>--ros-args</argument><parameter name='p' type='int'>1</parameter><qos>"
        "<topic name='t'><publisher><reliability>reliable</reliability></publisher></topic></qos>"
        "</ros>",
    ),
    "a block of a block as the plugin has it": system(
        "wind-effects", "WindEffects",
        "<horizontal><magnitude><time_for_rise>1</time_for_rise><noise type='gaussian'><mean>0</mean>"
        "<stddev>1</stddev></noise></magnitude></horizontal>",
    ),
    "a camera of ROS 1": sensor(
        "camera",
        classic(
            "gazebo_ros_camera",
            "<robotNamespace>a</robotNamespace><imageTopicName>a</imageTopicName>"
            "<hackBaseline>0</hackBaseline><cameraName>a</cameraName>",
        )[8:-9],
    ),
    "hardware of our own": hardware("our_driver/System", '<param name="robot_ipp">1</param>'),
    "a parameter of a base class": hardware(
        "husarion_ugv_hardware_interfaces/PantherSystem", '<param name="gear_ratio">30</param>'
    ),
    "a plugin without name in jazzy": '<gazebo><plugin filename="gz-sim-imu-system"/></gazebo>',
    "a mode of a motor": system(*MOTOR, "<motorType>velocity</motorType>"),
}  # fmt: skip


@pytest.mark.parametrize("oddity", HEALTHY)
def test_a_healthy_oddity_is_left_alone(oddity: str) -> None:
    assert codes(HEALTHY[oddity]) == []


NUMBERS = "write plain numbers with a decimal point, separated by spaces, as many as the place has"
TAKEN = "write a number that its reader takes, in metres, kilograms and radians"
MOVE = "delete it, or move it to where it is read; make a remark a comment"
ADD = "add what is missing, or delete the element that needs it"
RATE, FORMAT = "<update_rate>9</update_rate>", "<image><format>{}</format></image>"
OF_CLASSIC = '<plugin name="p" filename="libgazebo_ros_camera.so"/>'
SCAN = "<lidar><scan><horizontal>{}</horizontal></scan></lidar>"
NO_EFFECT = (
    "<{}> in the <gazebo> of a {} has no effect; name a {} with reference=, where it is read"
)


def check_said(inside: str, said: str, distro: str = "jazzy") -> None:
    """Code, level, what is at its place, message and hint."""
    text = f'<robot name="r">{LINK}{inside}</robot>'
    found = lint_data("r.urdf", text.encode(), NEW._replace(distro=distro))
    place = said.split(" ")[2] if said else ""
    assert [f"{it.code} {it.level} {place} {it.message}; {it.hint}" for it in found] == (
        [said] * bool(said)
    )
    assert all(text[it.column - 1 :].startswith(place.rstrip(":")) for it in found)


@pytest.mark.parametrize(
    "row",
    [
        (
            sensor("imu", "<updateRate>9</updateRate>"),
            "MB110 warning <updateRate>: Gazebo reads no <updateRate> in <sensor>; did you mean"
            " <update_rate>?",
        ),
        # What it may be meant to be is there already.
        (
            sensor("imu", RATE + "<updateRate>9</updateRate>"),
            f"MB111 note <updateRate>: Gazebo reads no <updateRate> in <sensor>; {MOVE}",
        ),
        (
            "<gazebo><whatever/></gazebo>",
            f"MB111 note <whatever/>: Gazebo reads no <whatever> in <model>; {MOVE}",
        ),
        (
            camera(RATE),
            "MB112 warning <update_rate>: Gazebo reads no <update_rate> in <camera>; move it into"
            " <sensor>",
        ),
        (
            sensor("camera", "<horizontal_fov>1</horizontal_fov>"),
            "MB112 warning <horizontal_fov>: Gazebo reads no <horizontal_fov> in <sensor>; move it"
            " into <camera> or <logical_camera>",
        ),
        (
            sensor("imu", '<pose relativeto="b">0 0 0 0 0 0</pose>'),
            "MB110 warning relativeto=: Gazebo reads no attribute 'relativeto' of <pose>; did you"
            " mean 'relative_to'?",
        ),
        (in_link('<sensor name="s" type="imu" whatever="1"/>'), ""),
        # The name is there.
        (in_link('<sensor name="s" type="imu" names="1"/>'), ""),
        (
            in_link('<sensor name=" " type="imu"/>'),
            f"MB115 error <sensor: <sensor> has no 'name'; {ADD}",
        ),
        (in_link('<sensor name="s"/>'), f"MB115 error <sensor: <sensor> has no 'type'; {ADD}"),
        (
            sensor("imu", "<pose>0 0 0 7 -90 8</pose>"),
            "MB170 warning 0: <pose> '0 0 0 7 -90 8' is more than a turn: it is in radians; -90"
            " degrees are -1.571",
        ),
        (sensor("imu", '<pose degrees="1">0 0 0 0 0 90</pose>'), ""),
        (
            sensor("imu", '<pose degrees="0">0 0 0 0 0 90</pose>'),
            "MB170 warning 0: <pose> '0 0 0 0 0 90' is more than a turn: it is in radians; 90"
            " degrees are 1.571",
        ),
        (
            sensor("imu", '<pose rotation_format="quat_xyzw">0 0 0 0 0 0</pose>'),
            f"MB120 error 0: <pose> '0 0 0 0 0 0' has 6 numbers of 7; {NUMBERS}",
        ),
        (
            sensor("imu", '<pose rotation_format="euler_rpy">0 0 0 0 0</pose>'),
            f"MB120 error 0: <pose> '0 0 0 0 0' has 5 numbers of 6; {NUMBERS}",
        ),
        (
            sensor("gpu_lidar", SCAN.format("<min_angle>-180</min_angle>")),
            "MB170 warning -180</min_angle>: <min_angle> '-180' is more than a turn: it is in"
            " radians; -180 degrees are -3.142",
        ),
        (
            sensor("gpu_lidar", SCAN.format("<samples>-5</samples>")),
            "MB120 warning -5</samples>: <samples> '-5' is below 0, and is read as a number above 4"
            f" billion; {NUMBERS}",
        ),
        (
            sensor("imu", "<update_rate>fast</update_rate>"),
            f"MB120 error fast</update_rate>: <update_rate> 'fast' is not a number; {NUMBERS}",
        ),
        # libsdformat 9 goes on.
        (
            sensor("imu", "<update_rate>fast</update_rate>"),
            f"MB120 warning fast</update_rate>: <update_rate> 'fast' is not a number; {NUMBERS}",
            "humble",
        ),
        (
            sensor("imu", "<update_rate>30 Hz</update_rate>"),
            f"MB120 warning 30: <update_rate> '30 Hz' is read as 30; {NUMBERS}",
        ),
        (
            camera("<horizontal_fov>60</horizontal_fov>"),
            "MB125 error 60</horizontal_fov>: <horizontal_fov> '60' is above 6.283186, the most"
            " that SDF allows; 60 degrees are 1.047 radians",
        ),
        (
            camera("<horizontal_fov>60</horizontal_fov>"),
            "MB125 note 60</horizontal_fov>: <horizontal_fov> '60' is above 6.283186, the most"
            " that SDF allows; 60 degrees are 1.047 radians",
            "humble",
        ),
        (
            camera(FORMAT.format("rgb8")),
            "MB124 error rgb8</format>: <format> is 'rgb8', which SDF does not know; SDF knows"
            " B8G8R8, BAYER_BGGR8, BAYER_GBRG8 and 19 more",
        ),
        (
            camera(FORMAT.format("FLOAT32")),
            "MB124 error FLOAT32</format>: <format> is 'FLOAT32', which SDF does not know; did you"
            " mean 'R_FLOAT32'?",
        ),
        (
            camera(FORMAT.format("FLOAT32")),
            "MB124 warning FLOAT32</format>: <format> is 'FLOAT32', which SDF does not know; did"
            " you mean 'R_FLOAT32'?",
            "humble",
        ),
        *(
            (sensor("camera", f"<camera>{FORMAT.format(it)}</camera>{OF_CLASSIC}"), "")
            for it in ("FLOAT16", "FLOAT32")
        ),
        (
            sensor("Camera"),
            "MB124 error type=\"Camera\">: sensor@type is 'Camera', which SDF does not know; did you"
            " mean 'camera'?",
        ),
        (
            in_link("<mu1>high</mu1>"),
            f"MB120 error high</mu1>: mu1 'high' is not a number; {NUMBERS}",
        ),
        (
            in_link('<mu1 value="high"/>'),
            f"MB120 error value=: mu1 'high' is not a number; {NUMBERS}",
        ),
        (
            in_link("<mu1>1.5x</mu1>"),
            f"MB120 warning 1.5x</mu1>: mu1 '1.5x' is read as 1.5; {NUMBERS}",
        ),
        (
            in_link("<selfCollide>maybe</selfCollide>"),
            "MB120 warning maybe</selfCollide>: selfCollide 'maybe' is neither true nor false;"
            f" {NUMBERS}",
        ),
        (
            "<gazebo><mu1>1</mu1></gazebo>",
            "MB112 warning <mu1>1</mu1>: " + NO_EFFECT.format("mu1", "model", "link"),
        ),
        (
            in_link("<fudgeFactor>1</fudgeFactor>"),
            "MB112 warning <fudgeFactor>: " + NO_EFFECT.format("fudgeFactor", "link", "joint"),
        ),
        (
            "<gazebo><dampingFactor>1</dampingFactor></gazebo>",
            "MB112 warning <dampingFactor>: "
            + NO_EFFECT.format("dampingFactor", "model", "link or joint"),
        ),
        (
            sensor("imu", "<frame_id>a</frame_id>"),
            "MB157 note <frame_id>: <frame_id> in <sensor> is of SDF 1.12; leave it out: "
            "Gazebo of this release reads up to SDF 1.11",
        ),
    ],
)
def test_what_is_said_of_a_block_of_gazebo(row: tuple[str, ...]) -> None:
    check_said(*row)


GZ_DRIVE, P3D = "gz-sim-diff-drive-system", "<body_name>a</body_name>"
MOCK = "mock_components/GenericSystem"
SPEED_IS = "MB110 warning <wheel_seperation>: " + GZ_DRIVE + " does not read 'wheel_seperation'; "
RADIUS_IS = (
    "MB125 warning {0}</wheel_radius>: wheel_radius '{0}' has to be above 0 (DiffDrive.cc:631);"
)


@pytest.mark.parametrize(
    ("inside", "said"),
    [
        (
            system(*DRIVE, "<wheel_seperation>1</wheel_seperation>"),
            f"{SPEED_IS}did you mean 'wheel_separation'?",
        ),
        # What it may be meant to be is there already.
        (
            system(
                *DRIVE,
                "<wheel_separation>1</wheel_separation><wheel_seperation>1</wheel_seperation>",
            ),
            f"{SPEED_IS.replace('MB110 warning', 'MB111 note')}{MOVE}",
        ),
        (
            system(*DRIVE, "<wheel_diameter>1</wheel_diameter>"),
            f"MB163 warning <wheel_diameter>: {GZ_DRIVE} does not read 'wheel_diameter';"
            " gazebo_ros_diff_drive does",
        ),
        (
            classic("gazebo_ros_diff_drive", "<wheel_radius>1</wheel_radius>"),
            "MB163 warning <wheel_radius>: gazebo_ros_diff_drive does not read 'wheel_radius';"
            f" {GZ_DRIVE} does",
        ),
        (
            system(*DRIVE, "<wheel_radius>ten</wheel_radius>"),
            "MB120 warning ten</wheel_radius>: wheel_radius 'ten' is not a number, and counts as 0;"
            f" {NUMBERS}",
        ),
        (
            system(*DRIVE, "<wheel_radius>0,1</wheel_radius>"),
            f"MB120 warning 0,1</wheel_radius>: wheel_radius '0,1' is read as 0; {NUMBERS}",
        ),
        *(
            (
                system(*DRIVE, f"<wheel_radius>{it}</wheel_radius>"),
                f"{RADIUS_IS.format(it)} {TAKEN}",
            )
            for it in ("0", "-1")
        ),
        (
            system(*DRIVE, "<odom_publish_frequency>-1</odom_publish_frequency>"),
            "MB125 warning -1</odom_publish_frequency>: odom_publish_frequency '-1' has to be at"
            f" least 0 (DiffDrive.cc:324); {TAKEN}",
        ),
        (system(*DRIVE, "<odom_publish_frequency>0</odom_publish_frequency>"), ""),
        (
            system("label", "Label", "<label>256</label>"),
            f"MB125 warning 256</label>: label '256' may be 255 at most (Label.cc:59); {TAKEN}",
        ),
        (system("label", "Label", "<label>255</label>"), ""),
        (
            system("thruster", "Thruster"),
            "MB115 error <plugin: gz-sim-thruster-system needs 'joint_name'; add it: it is not"
            " loaded without (Thruster.cc:242)",
        ),
        (
            system(*MOTOR, "<turningDirection>ccww</turningDirection>"),
            "MB124 warning ccww</turningDirection>: turningDirection 'ccww' is not a word that"
            " gz-sim-multicopter-motor-model-system knows; did you mean 'ccw'?",
        ),
        # "Please only use 'cw' or 'ccw' as turningDirection" (MulticopterMotorModel.cc:312).
        (
            system(*MOTOR, "<turningDirection>zzz</turningDirection>"),
            "MB124 warning zzz</turningDirection>: turningDirection 'zzz' is not a word that"
            " gz-sim-multicopter-motor-model-system knows; write cw or ccw",
        ),
        (
            system(
                "ackermann-steering", "AckermannSteering", "<steering_limit>30</steering_limit>"
            ),
            "MB170 warning 30</steering_limit>: steering_limit '30' is more than a turn: it is in"
            " radians; 30 degrees are 0.5236",
        ),
        (
            system(
                "joint-position-controller",
                "JointPositionController",
                "<joint_name>j</joint_name><joint_index>3</joint_index>",
            ),
            "MB125 warning 3</joint_index>: joint_index '3' may be 2 at most"
            " (JointPositionController.cc:582); write a number that its reader takes, in metres,"
            " kilograms and radians",
        ),
        (
            classic("gazebo_ros_p3d", f"{P3D}<remapping>odom:=a</remapping><ros/>"),
            "MB112 warning <remapping>odom:=a</remapping>: gazebo_ros_p3d reads 'remapping' in"
            " <ros>, not outside of it; move it into <ros>",
        ),
        (classic("gazebo_ros_p3d", f"{P3D}<remapping>odom:=a</remapping>"), ""),
        (
            classic("gazebo_ros_p3d", f"{P3D}<ros><remaping>a:=b</remaping></ros>"),
            "MB110 warning <remaping>a:=b</remaping>: gazebo_ros_p3d does not read 'remaping' in"
            " <ros>; did you mean 'remapping'?",
        ),
        (
            classic("gazebo_ros_p3d", "<ros/>"),
            "MB115 error <plugin: gazebo_ros_p3d needs 'body_name'; add it: it is not loaded without"
            " (gazebo_ros_p3d.cpp:115)",
        ),
        (
            classic("gazebo_ros_diff_drive", "<publish_odom>on</publish_odom>"),
            "MB120 warning on</publish_odom>: publish_odom 'on' is neither true nor false, and"
            f" counts as false; {NUMBERS}",
        ),
        (
            hardware(MOCK, '<param name="calculate_dynamic">true</param>'),
            f"MB110 warning <param: {MOCK} does not read 'calculate_dynamic'; did you mean"
            " 'calculate_dynamics'?",
        ),
        # The names of its parameters may be where nobody looked.
        (hardware(MOCK, '<param name="acme">true</param>'), ""),
    ],
)
def test_what_is_said_of_a_plugin(inside: str, said: str) -> None:
    check_said(inside, said)


def test_a_name_is_required_in_humble_alone() -> None:
    plugin = '<gazebo><plugin filename="gz-sim-imu-system"/></gazebo>'
    assert codes(plugin, "humble") == ["MB115"]


def test_a_release_has_its_own_elements_and_parameters() -> None:
    frame = sensor("imu", "<frame_id>a</frame_id>")
    assert [codes(frame, it) for it in ("humble", "jazzy", "kilted")] == [["MB157"], ["MB157"], []]


def test_a_type_that_a_plugin_of_classic_adds_is_left_alone_in_humble() -> None:
    """Gazebo of later releases refuses it; whether the robot is for that one is not known."""
    assert codes(sensor("dsros_dvl"), "humble") == []
    assert codes(sensor("dsros_dvl")) == ["MB124"]
    for simulated, level in ((False, WARNING), (True, ERROR)):
        settings = NEW._replace(simulated=simulated)
        text = f'<robot name="r">{LINK}{sensor("dsros_dvl")}</robot>'
        (found,) = lint_data("r.urdf", text.encode(), settings)
        said = "sensor@type 'dsros_dvl' is not in lyrical, only in humble"
        assert (found.level, found.message) == (level, said)


def test_a_class_of_hardware_in_a_model_is_no_plugin_of_gazebo() -> None:
    inside = hardware("gz_ros2_control/GazeboSimSystem")
    text = f'<sdf version="1.9"><model name="m"><link name="l"/>{inside}</model></sdf>'
    assert [it.code for it in lint_data("model.sdf", text.encode(), NEW)] == ["MB111"]


def test_every_row_of_sdf_has_a_source() -> None:
    for name in chunks():
        section = described(name)
        assert section is not None
        assert section.words, f"{name} says not where it was read"
        for row in (row for rows in section.rows.values() for row in rows):
            line = row.line.rpartition(":")[2]
            assert line.isdigit(), f"{name}/{row.name} has no line"
            assert int(line) > 0


@pytest.mark.more
def test_every_value_of_a_plugin_has_a_source() -> None:
    definitions = load_definitions((), "", packages=False)
    places = [
        (name, row.name, it)
        for name, of_ros_1 in definitions.valued()
        for values in filter(None, [definitions.values(name, of_ros_1)])
        for row in values.rows.values()
        for it in (row.place, row.checked)
    ]
    assert len(places) > 4000
    assert [it for it in places if not re.fullmatch(r"[\w/.+-]+:[1-9]\d*", it[2])] == []


# Where sdformat's parser_urdf.cc reads each tag of a <gazebo>: of a joint, a link or both.
READ_IN = {
    "joint": "stopCfm stopErp fudgeFactor provideFeedback springReference springStiffness "
    "implicitSpringDamper cfmDamping",
    "link": "mu1 mu2 kp kd maxVel minDepth maxContacts selfCollide laserRetro",
    "": "dampingFactor preserveFixedJoint disableFixedJointLumping static canonicalBody",
}


def test_a_tag_of_a_joint_has_no_effect_in_a_link_and_the_reverse() -> None:
    for home, reference in (("link", "a"), ("joint", "j")):
        for belongs, tags in READ_IN.items():
            inside = "".join(f"<{it}>1</{it}>\n" for it in tags.split())
            text = (
                f'<robot name="r">{LINK}<gazebo reference="{reference}">{inside}</gazebo></robot>'
            )
            seen = lint_data("r.urdf", text.encode(), NEW._replace(distro="jazzy"))
            told = [it for it in seen if it.message.endswith("has no effect")]
            assert len(told) == (len(tags.split()) if belongs not in ("", home) else 0), told


# The parameters by which each plugin is told the joints that it turns, from their sources.
DRIVEN = {
    "gz-sim-diff-drive-system": "left_joint right_joint",
    "gz-sim-ackermann-steering-system": "left_joint right_joint left_steering_joint "
    "right_steering_joint",
    "gz-sim-mecanum-drive-system": "front_left_joint front_right_joint back_left_joint "
    "back_right_joint",
    "gz-sim-joint-controller-system": "joint_name",
    "gz-sim-joint-position-controller-system": "joint_name",
    "gz-sim-joint-trajectory-controller-system": "joint_name",
    "libgazebo_ros_diff_drive.so": "left_joint right_joint",
    "libgazebo_ros_ackermann_drive.so": "front_left_joint front_right_joint rear_left_joint "
    "rear_right_joint left_steering_joint right_steering_joint",
    "libgazebo_ros_tricycle_drive.so": "steering_joint actuated_wheel_joint",
}


def test_a_joint_that_a_plugin_turns_needs_an_effort() -> None:
    """Of 0 it has no force in a simulator: a warning, and a note for a joint that nothing turns."""
    joint = (
        '<link name="l_{0}"/><joint name="{0}" type="continuous"><parent link="b"/>'
        '<child link="l_{0}"/><limit effort="0" velocity="1"/></joint>'
    )
    for library, tags in DRIVEN.items():
        names = [*tags.split(), "other"]
        plugin = "".join(f"<{it}>{it}</{it}>" for it in names)
        text = (
            f'<robot name="r"><link name="b"/>{"".join(map(joint.format, names))}'
            f'<gazebo><plugin name="p" filename="{library}">{plugin}</plugin></gazebo></robot>'
        )
        found = lint_data("r.urdf", text.encode(), Settings(select=("MB515",), distro="jazzy"))
        assert [it.level for it in found] == ["warning"] * (len(names) - 1) + ["note"], library


MODEL = '<sdf version="{}"><model name="m"><link name="l">{}</link></model></sdf>'
FAST = '<sensor name="s" type="imu"><update_rate>x</update_rate></sensor>'
SYSTEM = '<plugin name="p" filename="{}"/>'


@pytest.mark.parametrize(
    ("version", "inside", "distro", "level"),
    [
        # Gazebo Classic wrote SDF up to 1.7, and goes on with what it cannot read.
        ("1.6", FAST, "jazzy", "warning"),
        ("1.7", FAST, "jazzy", "warning"),
        ("1.8", FAST, "jazzy", "error"),
        ("1.8", FAST, "humble", "warning"),
        *(
            ("1.6", FAST + SYSTEM.format(it), "humble", "error")
            for it in ("ignition-gazebo-imu-system", "gz-sim-imu-system", "libgz_ros2_control.so")
        ),
        ("1.6", FAST + SYSTEM.format("ign_ros2_control-system"), "humble", "error"),
        ("1.6", FAST + SYSTEM.format("libgazebo_ros_imu.so"), "humble", "warning"),
    ],
)
def test_a_model_that_may_be_of_gazebo_classic(
    version: str, inside: str, distro: str, level: str
) -> None:
    text = MODEL.format(version, inside)
    settings = Settings(select=("MB120",), distro=distro)
    assert [it.level for it in lint_data("m.sdf", text.encode(), settings)] == [level]


def test_the_version_of_a_urdf_is_none_of_gazebo_classic() -> None:
    text = f'<robot name="r" version="1.0">{LINK}{in_link("<mu1>high</mu1>")}</robot>'
    settings = Settings(select=("MB120",), distro="jazzy")
    assert [it.level for it in lint_data("r.urdf", text.encode(), settings)] == ["error"]


ABOVE_0 = "which has to be above 0"


@pytest.mark.parametrize(
    ("inside", "said"),
    [
        (sensor("imu", "<update_rate>-1</update_rate>"), "update_rate is -1, which is below 0"),
        (sensor("imu", "<update_rate>0</update_rate>"), ""),
        (camera("<image><width>0</width></image>"), f"width is 0, {ABOVE_0}"),
        (camera("<image><height>0</height></image>"), f"height is 0, {ABOVE_0}"),
        (camera("<image><height>1</height></image>"), ""),
        (camera("<clip><near>0</near></clip>"), f"near is 0, {ABOVE_0}"),
        *(
            (
                sensor(type_, f"<{tag}><range><max>0</max></range></{tag}>"),
                f"max is 0, {ABOVE_0}",
            )
            for type_, tag in (("gpu_lidar", "lidar"), ("gpu_ray", "ray"), ("ray", "ray"))
        ),
        (
            sensor("gpu_lidar", SCAN.format("<samples>0</samples>")),
            f"samples is 0, {ABOVE_0}",
        ),
        # What is no lidar has no rays.
        (sensor("imu", "<ray><range><max>0</max></range></ray>"), ""),
        (
            sensor("gpu_lidar", "<lidar><range><min>20</min><max>2000</max></range></lidar>"),
            "max is 2000, which is a length in metres",
        ),
        (sensor("gpu_lidar", "<lidar><range><min>19</min><max>2000</max></range></lidar>"), ""),
        (sensor("gpu_lidar", "<lidar><range><min>20</min><max>1999</max></range></lidar>"), ""),
        (
            "<transmission><actuator><mechanicalReduction>0</mechanicalReduction></actuator>"
            "</transmission>",
            "mechanicalReduction is 0, by which is divided",
        ),
        (
            classic("ours", "<min_speed>3</min_speed><max_speed>2</max_speed>"),
            "min_speed is 3, above max_speed (2)",
        ),
        (classic("ours", "<min_speed>2</min_speed><max_speed>2</max_speed>"), ""),
    ],
)
def test_numbers_with_which_nothing_is_seen(inside: str, said: str) -> None:
    text = f'<robot name="r">{LINK}{inside}</robot>'
    settings = Settings(select=("MB125",), distro="jazzy")
    found = [it for it in lint_data("r.urdf", text.encode(), settings) if it.level == "warning"]
    assert [it.message for it in found] == [said] * bool(said)
