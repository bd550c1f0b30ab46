# SPDX-License-Identifier: Apache-2.0
"""A xacro's own arguments for a robot's names are filled, where that makes the names of the layout.

Expectations: names as the layouts have them in docs/fleet-file.md, and what Husarion's, Clearpath's and
UR's launch files give to their xacros.
"""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from fleet_folder import built_fleet
from lxml import etree

from multibot_rewrite import InputError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.checks.build import Outputs
from multibot_rewrite.description.reports import xacro_arguments
from multibot_rewrite.fleet.file import simulator_switch

SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
ARM = """
<link name="$(arg tf_prefix)base_link"/><link name="$(arg tf_prefix)tool0"/>
<joint name="$(arg tf_prefix)elbow" type="revolute"><axis xyz="0 0 1"/>
  <parent link="$(arg tf_prefix)base_link"/><child link="$(arg tf_prefix)tool0"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<note for="nobody">$(arg tf_prefix)</note>
"""
# As Husarion's ROSbot has it: without a namespace there is no slash.
BASE = """
<xacro:property name="ns" value="$(arg namespace)"/>
<xacro:property name="above" value="${'' if ns in ('', 'None') else ns + '/'}"/>
<link name="base_link"/>
<ros2_control name="${above}system" type="system">
  <hardware><plugin>acme/System</plugin></hardware>
  <sensor name="${above}imu"><state_interface name="orientation.x"/></sensor>
</ros2_control>
<gazebo reference="base_link"><sensor name="lidar" type="gpu_lidar">
  <topic>${above}scan</topic></sensor></gazebo>
"""
IMU = """\
controller_manager:
  ros__parameters: {imu: {type: imu_sensor_broadcaster/IMUSensorBroadcaster}}
imu: {ros__parameters: {sensor_name: <namespace>/imu, frame_id: base_link}}
"""
WITH_PREFIX = {"layout": "frames-per-robot", "affix": "prefix", "separators": {"link": "_"}}
TF_PER_ROBOT = {"layout": "tf-per-robot"}


def xacro(folder: Path, argument: str, body: str, default: str = "") -> str:
    declared = f'<xacro:arg name="{argument}" default="{default}"/>'
    (folder / "r.urdf.xacro").write_text(f'<robot name="r" {SPACE}>{declared}{body}</robot>')
    return str(folder / "r.urdf.xacro")


def made(description: str, robots: Any = ("robot1", "robot2"), **keys: Any) -> Outputs:
    own = [it if isinstance(it, dict) else {"name": it} for it in robots]
    data = {"description": description, "robots": own, **keys}
    return built_fleet(data, "jazzy")


def root(outputs: Outputs, robot: str, file: str = "r.urdf") -> etree._Element:
    (data,) = (it.data for it in outputs.files if it.path == f"{robot}/{file}")
    return etree.fromstring(data)


def names(outputs: Outputs, robot: str, tag: str) -> list[str]:
    return [it.get("name", "") for it in root(outputs, robot).iter(tag)]


def said(outputs: Outputs) -> list[str]:
    return [it.message for it in outputs.findings if it.code == "MF840"]


def nobodys(outputs: Outputs, robot: str) -> str:
    return root(outputs, robot).findtext("note") or ""


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("separators", "given"), [({"link": "_"}, "robot2_"), ({"link": "/", "joint": "/"}, "robot2/")]
)
def test_a_prefix_is_filled_as_the_layout_separates(
    separators: dict[str, str], given: str, tmp_path: Path
) -> None:
    keys = {**WITH_PREFIX, "separators": separators}
    outputs = made(xacro(tmp_path, "tf_prefix", ARM), **keys)
    assert names(outputs, "robot2", "link") == [f"{given}base_link", f"{given}tool0"]
    assert names(outputs, "robot2", "joint") == [f"{given}elbow"]
    # What no rewrite knows has it, too.
    assert nobodys(outputs, "robot2") == given
    (message,) = said(outputs)
    assert message.endswith(f"tf_prefix of its xacro is filled, it is {given.replace('2', '1')}")


def test_names_that_would_get_different_separators_are_left_to_the_layout(tmp_path: Path) -> None:
    keys = {**WITH_PREFIX, "separators": {}}
    outputs = made(xacro(tmp_path, "tf_prefix", ARM), **keys)
    assert names(outputs, "robot2", "link") == ["robot2/base_link", "robot2/tool0"]
    assert names(outputs, "robot2", "joint") == ["robot2_elbow"]
    assert nobodys(outputs, "robot2") == ""
    (message,) = said(outputs)
    assert "tf_prefix of its xacro is not filled: it makes {robot}base_link of a link" in message


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "keys",
    [
        TF_PER_ROBOT,
        {"layout": "frame-prefix"},
        {"layout": "postfix"},
        {"layout": "frames-per-robot"},
    ],
)
def test_a_prefix_is_left_where_links_get_none(keys: dict[str, Any], tmp_path: Path) -> None:
    outputs = made(xacro(tmp_path, "tf_prefix", ARM), **keys)
    assert nobodys(outputs, "robot1") == ""
    assert said(outputs) == []


@pytest.mark.slow
@pytest.mark.sample(4)
@pytest.mark.parametrize("layout", ["tf-per-robot", "frames-per-robot", "both", "frame-prefix"])
@pytest.mark.parametrize("default", ["", "None"])
def test_a_namespace_is_filled_in_layouts_with_namespaces(
    default: str, layout: str, tmp_path: Path
) -> None:
    path = xacro(tmp_path, "namespace", BASE, default)
    (tmp_path / "p.yaml").write_text(IMU)
    outputs = made(path, layout=layout, related_files={"params": str(tmp_path / "p.yaml")})
    assert [it.text for it in root(outputs, "robot2").iter("topic")] == ["robot2/scan"]
    assert names(outputs, "robot2", "ros2_control") == ["robot2/system"]
    (params,) = (it.data for it in outputs.files if it.path == "robot2/p.yaml")
    assert b"sensor_name: robot2/imu" in params
    assert len(said(outputs)) == 1


def test_a_namespace_is_left_in_a_layout_without(tmp_path: Path) -> None:
    outputs = made(xacro(tmp_path, "namespace", BASE), layout="postfix")
    assert [it.text for it in root(outputs, "robot1").iter("topic")] != ["robot1/scan"]
    assert said(outputs) == []


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "keys",
    [
        {"arguments": {"namespace": ""}},
        {"fill_arguments": False},
        {"robots": [{"name": "robot1", "fill_arguments": False}]},
        {"robots": [{"name": "robot1", "arguments": {"namespace": ""}}]},
    ],
)
def test_the_fleet_file_may_say_otherwise(keys: dict[str, Any], tmp_path: Path) -> None:
    path = xacro(tmp_path, "namespace", BASE)
    outputs = made(path, **{"robots": ["robot1"], **TF_PER_ROBOT, **keys})
    assert names(outputs, "robot1", "ros2_control") == ["system"]
    assert said(outputs) == []


@pytest.mark.slow
def test_a_prefix_that_misses_a_reference_is_not_filled(tmp_path: Path) -> None:
    """Kinova's gripper_joint_name is an argument of its own, with a name without the prefix."""
    hardware = """<ros2_control name="s" type="system"><hardware><plugin>a/B</plugin></hardware>
      <joint name="elbow"><command_interface name="position"/></joint></ros2_control>"""
    outputs = made(xacro(tmp_path, "tf_prefix", ARM + hardware), **WITH_PREFIX)
    assert names(outputs, "robot1", "joint") == ["robot1_elbow", "robot1_elbow"]
    assert nobodys(outputs, "robot1") == ""
    (message,) = said(outputs)
    assert message.endswith(
        "not filled: elbow would be renamed, and something still uses the old name"
    )


@pytest.mark.slow
def test_each_argument_gets_the_word_of_its_names(tmp_path: Path) -> None:
    robots = [{"name": "robot1", "namespace": "n1", "prefix": "p1"}]
    arm = made(xacro(tmp_path, "tf_prefix", ARM), robots, **WITH_PREFIX)
    assert names(arm, "robot1", "link")[0] == "p1_base_link"
    assert nobodys(arm, "robot1") == "p1_"
    body = BASE.replace("${above}system", "system").replace("${above}imu", "imu")
    base = made(xacro(tmp_path, "namespace", body), robots, **WITH_PREFIX)
    assert [it.text for it in root(base, "robot1").iter("topic")] == ["n1/scan"]
    both = made(xacro(tmp_path, "namespace", BASE), robots, **WITH_PREFIX)
    assert ["not filled" in it for it in said(both)] == [True]


def test_a_namespace_of_several_levels_is_not_filled(tmp_path: Path) -> None:
    body = BASE.replace("${above}system", "system").replace("${above}imu", "imu")
    robots = [{"name": "robot1", "namespace": "a/robot1"}]
    outputs = made(xacro(tmp_path, "namespace", body), robots, **TF_PER_ROBOT)
    assert [it.text for it in root(outputs, "robot1").iter("topic")] == ["a/robot1/scan"]
    assert ["not filled" in it for it in said(outputs)] == [True]


def test_what_cannot_be_expanded_is_told_as_ever(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="xacro failed"):
        made(xacro(tmp_path, "namespace", '<link name="$(arg other)"/>'), **TF_PER_ROBOT)


@pytest.mark.slow
def test_one_look_serves_all_robots(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    looked: list[str] = []
    look = xacro_arguments.find_arguments

    def counted(path: str, *more: Any, **keys: Any) -> Any:
        looked.append(path)
        return look(path, *more, **keys)

    monkeypatch.setattr(simulator_switch, "find_arguments", counted)
    robots = [f"robot{at}" for at in range(5)]
    outputs = made(
        xacro(tmp_path, "tf_prefix", ARM), robots, **WITH_PREFIX, arguments={"x": "{robot}"}
    )
    assert nobodys(outputs, "robot4") == "robot4_"
    assert len(looked) == 1


def test_two_examples_of_names_with_different_separators_are_told() -> None:
    """Links have ``/`` in frames-per-robot, joints and groups ``_``."""
    uses = tuple(
        xacro_arguments.Use(kind, "prefix", "", 1, 1, f"{{robot}}{name}")
        for kind, name in (("link", "base"), ("joint", "elbow"), ("joint", "wrist"))
    )
    robot: Any = SimpleNamespace(name="r1", tag="r1", namespace="/r1")
    made = xacro_arguments.Argument("tf_prefix", "", uses, 0, "")
    found = simulator_switch._choice(made, make_naming("frames-per-robot", "prefix"), robot)
    both = "{robot}base of a link and {robot}elbow of a joint"
    said = f"it makes {both}, and these get different separators"
    assert (found.value, found.reason) == ("", said)
