# SPDX-License-Identifier: Apache-2.0
"""Arguments that are given and that no file of a xacro knows: xacro itself says nothing of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite import rewrite
from multibot_rewrite.description.sources.known_arguments import known_arguments
from multibot_rewrite.lint.run import lint_files
from multibot_rewrite.rules.settings import EVERY_FILE, ArgumentSet, Settings

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
ARM = f"""{HEAD}
  <xacro:arg name="with_gripper" default="false"/>
  <xacro:include filename="parts.xacro"/>
  <link name="$(arg tf_prefix)base_link"/>
</robot>
"""
PARTS = f"""{HEAD}
  <xacro:arg default="" name='tf_prefix'/>
  <link name="mount$(arg only_read)"/>
</robot>
"""


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ('<xacro:arg name="a" default="x > y"/>', ("a",)),
        ("<xacro:arg\n  default='1'\n  name = 'a'/>", ("a",)),
        ('<link name="$(arg  a)b"/>', ("a",)),
        ("<link name=\"${xacro.arg('a')}\"/>", ("a",)),
        ("<xacro:if value=\"$(eval arg('a') == 1)\">", ("arg", "a", "1")),
        ('<!-- <xacro:arg name="old"/> --><xacro:arg name="a"/>', ("a",)),
        ("<!-- $(arg a) --> <!-- $(arg b)", ()),
        ('<xacro:property name="a" value="1"/><link name="a"/>', ()),
        ('<xacro:args name="a"/>', ()),
    ],
)
def test_what_a_text_declares_and_reads(text: str, names: tuple[str, ...]) -> None:
    assert known_arguments([text.encode()]) == (names, False)


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    (tmp_path / "parts.xacro").write_text(PARTS)
    (tmp_path / "arm.urdf.xacro").write_text(ARM)
    return tmp_path / "arm.urdf.xacro"


def said(arm: Path, **arguments: str) -> list[str]:
    findings = rewrite(arm, "robot1", xacro_args={"only_read": "", **arguments}).findings
    return [f"{it.level} {it.message} ({it.hint})" for it in findings if it.code == "MB144"]


def test_an_argument_like_no_other_names_those_that_there_are(arm: Path) -> None:
    (line,) = said(arm, colour="red")
    assert line.endswith("(its arguments are with_gripper, tf_prefix, only_read)")


def linted(arm: Path, names: list[str], **arguments: str) -> list[str]:
    given = (ArgumentSet(EVERY_FILE, tuple({"only_read": "", **arguments}.items())),)
    settings = Settings(select=("MB144",), arguments=given)
    found = lint_files([str(arm.parent / it) for it in names], settings, jobs=1)
    return [f"{Path(it.file).name}:{it.line} {it.message.split()[1]}" for it in found]


@pytest.mark.slow
def test_of_several_files_one_that_knows_it_is_enough(arm: Path) -> None:
    (arm.parent / "cart.urdf.xacro").write_text(
        f'{HEAD}<xacro:arg name="prefix" default=""/><link name="$(arg prefix)a"/></robot>'
    )
    both = ["arm.urdf.xacro", "cart.urdf.xacro"]
    assert linted(arm, both, tf_prefix="x_", prefix="y_", with_gripper="true") == []
    # Nothing of the cart is like it: the other file is meant.
    assert linted(arm, both, with_griper="true") == ["arm.urdf.xacro:1 'with_griper'"]
    assert linted(arm, both[1:], with_gripper="true") == [
        "cart.urdf.xacro:1 'only_read'",
        "cart.urdf.xacro:1 'with_gripper'",
    ]
