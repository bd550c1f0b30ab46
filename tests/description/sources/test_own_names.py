# SPDX-License-Identifier: Apache-2.0
"""Arguments of a xacro that put a robot's name into names: filled for each robot, never doubled."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import pytest
from lxml import etree
from paths import FIXTURES

from multibot_rewrite import RewriteRefused, UsageError, explain, rewrite, rewrite_all, strip
from multibot_rewrite.description.sources.expand import expand
from multibot_rewrite.description.sources.own_names import filled

ARM = FIXTURES / "xacros" / "arm.urdf.xacro"
BASE = FIXTURES / "xacros" / "base.urdf.xacro"
PREFIX = {"tf_prefix": "{robot}_"}


def names(text: str, tag: str) -> list[str]:
    """Return the names of the elements of that tag, below the root."""
    return [str(it.get("name")) for it in etree.fromstring(text.encode()).findall(tag)]


def texts(text: str, tag: str) -> list[str]:
    return [it.text or "" for it in etree.fromstring(text.encode()).iter(tag)]


def made(head: str, body: str, folder: Path) -> Path:
    """Return a xacro file."""
    path = folder / "made.urdf.xacro"
    space = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    path.write_text(f'<robot name="made" {space}>{head}{body}</robot>')
    return path


@pytest.mark.more
def test_each_robot_is_an_expansion_of_its_own() -> None:
    made = list(rewrite_all(ARM, ["a", "b", "c"], xacro_args=PREFIX))
    assert [it.robot for it in made] == ["a", "b", "c"]
    for it in made:
        assert names(it.text, "link")[:2] == [f"{it.robot}_base_link", f"{it.robot}_tool0"]
        assert it.text == rewrite(ARM, it.robot, xacro_args=PREFIX).text


@pytest.mark.sample(1)
@pytest.mark.parametrize("value", ["{robot}/arm", "fleet/{robot}"])
def test_a_namespace_of_several_parts_is_the_robots_own(value: str) -> None:
    made = rewrite(BASE, "robot1", layout="both", xacro_args={"namespace": value}).text
    own = value.replace("{robot}", "robot1")
    assert texts(made, "namespace") == [own, f"/{own}"]


@pytest.mark.more
def test_an_argument_that_takes_only_known_words_does_not_hide_the_others() -> None:
    given = {"namespace": "{robot}", "wheel": "small"}
    made = rewrite(BASE, "small", layout="both", xacro_args=given).text
    assert texts(made, "namespace") == ["small", "/small"]


@pytest.mark.parametrize("value", ["{ns}_", "{robot_name}_", "{robot}_{tf}_"])
def test_an_unknown_placeholder_is_refused(value: str) -> None:
    for call in (
        lambda: rewrite(ARM, "left", xacro_args={"tf_prefix": value}),
        lambda: list(rewrite_all(ARM, ["left", "right"], xacro_args={"tf_prefix": value})),
        lambda: explain(ARM, 3, xacro_args={"tf_prefix": value}),
    ):
        with pytest.raises(UsageError, match=r"tf_prefix:=.*unknown placeholder"):
            call()


@pytest.mark.parametrize(
    ("text", "becomes"),
    [
        ("{robot}_", "r1_"),
        ("a{robot}b{robot}", "ar1br1"),
        ("{x: 1}", "{x: 1}"),
        ("{}", "{}"),
        ("${robot}{robot}", "${robot}r1"),
        ("plain", "plain"),
    ],
)
def test_what_is_filled(text: str, becomes: str) -> None:
    assert filled({"it": text}, "r1") == {"it": becomes}


def test_the_advice_leaves_the_name_of_the_argument_alone(tmp_path: Path) -> None:
    path = made('<xacro:arg name="arm_p" default=""/>', '<link name="$(arg arm_p)a"/>', tmp_path)
    with pytest.raises(UsageError, match=r"; write arm_p:=\{robot\}_x_$"):
        list(rewrite_all(path, ["arm", "cart"], xacro_args={"arm_p": "arm_x_"}))


@pytest.mark.more
def test_a_value_that_names_a_robot_by_accident_is_for_all() -> None:
    given = {"meshes": "package://left/meshes"}
    made = list(rewrite_all(ARM, ["a", "left", "b"], xacro_args=given))
    assert [it.robot for it in made] == ["a", "left", "b"]
    assert [names(it.text, "link")[0] for it in made] == [
        "base_link/a",
        "base_link/left",
        "base_link/b",
    ]


def test_names_of_two_robots_do_not_meet(tmp_path: Path) -> None:
    head = '<xacro:arg name="p" default=""/>'
    body = '<link name="$(arg p)b_x"/><link name="$(arg p)x"/>'
    with pytest.raises(RewriteRefused) as refused:
        list(rewrite_all(made(head, body, tmp_path), ["a", "a_b"], xacro_args={"p": "{robot}_"}))
    assert [it.code for it in refused.value.findings] == ["MB421"]
    assert "a and a_b would both have the link 'a_b_x'" in refused.value.findings[0].message


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("affix", ["prefix", "postfix"])
@pytest.mark.parametrize("separator", ["/", "_"])
def test_strip_gives_the_expansion_back(affix: str, separator: str) -> None:
    policy = {"affix": affix, "separators": {"link": separator}}
    made = rewrite(ARM, "left", xacro_args=PREFIX, **policy)
    back = strip(made.data, "left", xacro=ARM, xacro_args=PREFIX, **policy)
    assert back == expand(str(ARM), {"tf_prefix": "left_"})


@pytest.mark.more
def test_strip_without_the_xacro_is_refused() -> None:
    made = rewrite(ARM, "left", xacro_args=PREFIX)
    with pytest.raises(RewriteRefused) as refused:
        strip(made.data, "left")
    assert [it.code for it in refused.value.findings] == ["MB107"]
    assert "xacro" in refused.value.findings[0].hint


@pytest.mark.more
def test_an_srdf_keeps_what_its_urdf_names(tmp_path: Path) -> None:
    srdf = made(
        '<xacro:arg name="tf_prefix" default=""/>',
        '<group name="arm"><chain base_link="$(arg tf_prefix)base_link" tip_link="camera_link"/>'
        '</group><disable_collisions link1="$(arg tf_prefix)tool0" link2="camera_link" reason="x"/>',
        tmp_path,
    )
    done = rewrite(srdf, "left", urdf=ARM, xacro_args=PREFIX).text
    chain = etree.fromstring(done.encode()).find("group/chain")
    assert chain is not None
    assert chain.attrib == {"base_link": "left_base_link", "tip_link": "camera_link/left"}
    assert 'link1="left_tool0"' in done


@pytest.mark.more
def test_a_result_can_be_pickled() -> None:
    made = rewrite(ARM, "left", xacro_args=PREFIX)
    copy = pickle.loads(pickle.dumps(made))
    assert copy == made
    assert copy.changes == made.changes


@pytest.mark.more
def test_an_explanation_says_where_the_name_is_from() -> None:
    lines = Path(ARM).read_text().splitlines()
    line = next(at for at, it in enumerate(lines, 1) if 'tool0"' in it and "<link" in it)
    found, *_ = explain(ARM, line, "left", xacro_args=PREFIX)
    assert found.new == found.value == "left_tool0"
    assert "the xacro's arguments have put the robot's name into it" in found.reason


@pytest.mark.more
def test_two_arguments_of_one_name_are_refused(tmp_path: Path) -> None:
    head = '<xacro:arg name="p" default=""/><xacro:arg name="q" default="arm"/>'
    path = made(head, '<link name="$(arg p)$(arg q)"/>', tmp_path)
    with pytest.raises(UsageError, match="would make 'left_left_arm' of a link; give one argument"):
        rewrite(path, "left", xacro_args={"p": "{robot}_", "q": "left_arm"})
    done = rewrite(path, "left", xacro_args={"p": "{robot}_", "q": "arm_{robot}"}).text
    assert names(done, "link") == ["left_arm_left"]


PLAIN_SRDF = """\
<robot name="arm">
  <group name="arm"><chain base_link="base_link" tip_link="tool0"/></group>
  <group_state name="home" group="arm"><joint name="elbow" value="0"/></group_state>
  <disable_collisions link1="base_link" link2="camera_link" reason="Never"/>
</robot>
"""


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("layout", ["postfix", "tf-per-robot"])
def test_an_srdf_that_knows_nothing_of_the_argument(layout: str) -> None:
    done = rewrite(PLAIN_SRDF, "left", urdf=ARM, xacro_args=PREFIX, layout=layout)
    camera = "camera_link/left" if layout == "postfix" else "camera_link"
    model = "arm_left" if layout == "postfix" else "arm"
    expected = (
        PLAIN_SRDF.replace('"base_link"', '"left_base_link"')
        .replace('"tool0"', '"left_tool0"')
        .replace('"elbow"', '"left_elbow"')
        .replace('"camera_link"', f'"{camera}"')
        .replace('<robot name="arm"', f'<robot name="{model}"')
    )
    assert done.text == expected
    assert done.findings == ()
    urdf = rewrite(ARM, "left", xacro_args=PREFIX, layout=layout).data
    back = strip(done.data, "left", urdf=urdf, xacro=ARM, xacro_args=PREFIX, layout=layout)
    assert back.decode() == PLAIN_SRDF


@pytest.mark.more
def test_a_reference_without_the_argument_is_a_warning(tmp_path: Path) -> None:
    body = (
        '<link name="$(arg p)base_link"/><gazebo>'
        '<plugin name="drive" filename="libgazebo_ros_diff_drive.so">'
        "<robot_base_frame>{}base_link</robot_base_frame></plugin></gazebo>"
    )
    head = '<xacro:arg name="p" default=""/>'
    path = made(head, body.format(""), tmp_path)
    done = rewrite(path, "left", layout="both", xacro_args={"p": "{robot}_"})
    assert [it.code for it in done.findings] == ["MB143"]
    assert "frame 'base_link' is the link 'left_base_link'" in done.findings[0].message
    assert rewrite(path, "left", layout="both").findings == ()
    right = made(head, body.format("$(arg p)"), tmp_path)
    assert rewrite(right, "left", layout="both", xacro_args={"p": "{robot}_"}).findings == ()


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("policy", "codes"),
    [
        ({"layout": "frames-per-robot", "affix": "prefix"}, []),
        ({"layout": "frames-per-robot"}, ["MB143"]),
        ({"layout": "frames-per-robot", "affix": "prefix", "separators": {"link": "_"}}, ["MB143"]),
        ({"layout": "tf-per-robot"}, ["MB143"]),
    ],
)
def test_a_frame_with_the_argument_and_its_link_without_it(
    tmp_path: Path, policy: dict[str, Any], codes: list[str]
) -> None:
    body = (
        '<link name="base_link"/><gazebo>'
        '<plugin name="drive" filename="libgazebo_ros_diff_drive.so">'
        "<robot_base_frame>$(arg p)/base_link</robot_base_frame></plugin></gazebo>"
    )
    path = made('<xacro:arg name="p" default=""/>', body, tmp_path)
    given = {"p": "{robot}"}
    done = rewrite(path, "left", xacro_args=given, **policy)
    assert [it.code for it in done.findings] == codes
    # The frame is as it was, also where the rewrite gives the link the same name.
    back = strip(done.data, "left", xacro=path, xacro_args=given, **policy)
    assert back == expand(str(path), {"p": "left"})


def test_an_srdf_for_a_default_that_is_replaced_is_not_followed(tmp_path: Path) -> None:
    body = '<link name="$(arg p)base"/><link name="$(arg p)tip"/>'
    path = made('<xacro:arg name="p" default="arm_"/>', body, tmp_path)
    srdf = '<robot name="made"><disable_collisions link1="arm_base" link2="arm_tip"/></robot>'
    done = rewrite(srdf, "left", urdf=path, xacro_args={"p": "{robot}_"})
    # What is not an insertion cannot be taken out again: the names are reported, and stay.
    assert done.findings != ()
    assert '"arm_base"' in done.text


@pytest.mark.more
def test_an_srdf_of_an_argument_behind_names(tmp_path: Path) -> None:
    body = '<link name="base$(arg p)"/><link name="tip"/><joint name="base" type="fixed">'
    body += '<parent link="base$(arg p)"/><child link="tip"/></joint>'
    path = made('<xacro:arg name="p" default=""/>', body, tmp_path)
    srdf = '<robot name="made"><disable_collisions link1="base" link2="tip"/>'
    srdf += '<passive_joint name="base"/></robot>'
    given = {"p": "_{robot}"}
    done = rewrite(srdf, "left", urdf=path, xacro_args=given)
    assert 'link1="base_left" link2="tip/left"' in done.text
    assert 'passive_joint name="base_left"' in done.text
    urdf = rewrite(path, "left", xacro_args=given).data
    back = strip(done.data, "left", urdf=urdf, xacro=path, xacro_args=given)
    assert back.decode() == srdf
