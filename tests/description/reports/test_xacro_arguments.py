# SPDX-License-Identifier: Apache-2.0
"""``multibot inspect FILE.xacro``: expanding with another word shows what an argument goes into."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from description_calls import NEWEST_LTS, builtin_tree
from paths import FIXTURES

from multibot_rewrite import rewrite_all
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.reports import xacro_arguments
from multibot_rewrite.description.reports.xacro_arguments import (
    Argument,
    Use,
    XacroArguments,
    find_arguments,
)

XACROS = FIXTURES / "xacros"
SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
TWO_NAMES = """\
<xacro:arg name="p" default="{}"/>
<link name="{}"/><link name="plain"/>
"""


def found(path: Path, **given: str) -> XacroArguments:
    return find_arguments(str(path), given, builtin_tree((), NEWEST_LTS))


def by_name(path: Path, **given: str) -> dict[str, Argument]:
    return {it.name: it for it in found(path, **given).arguments}


@pytest.fixture
def write(tmp_path: Path) -> Path:
    return tmp_path / "made.urdf.xacro"


def written(path: Path, body: str) -> Path:
    path.write_text(f'<robot name="made" {SPACE}>{body}</robot>')
    return path


@pytest.mark.more
def test_an_argument_of_an_included_file_that_names_one_link() -> None:
    tool = by_name(XACROS / "arm.urdf.xacro")["tool"]
    assert tool == Argument("tool", "gripper", (Use("link", "whole", "", 1, 4, "{robot}"),), 0, "")
    assert tool.value == ""


def test_xacro_goes_by_the_prefix_whatever_it_is_bound_to(write: Path) -> None:
    write.write_text(
        written(write, TWO_NAMES.format("a", "$(arg p)")).read_text().replace("wiki/xacro", "")
    )
    assert set(by_name(write)) == {"p"}


@pytest.mark.more
def test_numbers_switches_and_words_of_a_table_take_no_name() -> None:
    arm, base = by_name(XACROS / "arm.urdf.xacro"), by_name(XACROS / "base.urdf.xacro")
    assert {it.name for it in (*arm.values(), *base.values()) if it.fault} == {
        "length",
        "sim",
        "wheel",
    }
    assert "not a boolean" in arm["sim"].fault or "sim" in arm["sim"].fault


@pytest.mark.more
def test_a_path_goes_into_no_name() -> None:
    meshes = by_name(XACROS / "arm.urdf.xacro")["meshes"]
    assert (meshes.uses, meshes.others, meshes.fault) == ((), 1, "")


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("default", "name", "use", "value"),
    [
        ("", "$(arg p)base", Use("link", "prefix", "", 1, 2, "{robot}base"), "{robot}_"),
        ("", "$(arg p)_base", Use("link", "prefix", "_", 1, 2, "{robot}_base"), "{robot}"),
        ("", "$(arg p)/base", Use("link", "prefix", "/", 1, 2, "{robot}/base"), "{robot}"),
        ("", "base$(arg p)", Use("link", "postfix", "", 1, 2, "base{robot}"), "_{robot}"),
        ("", "base-$(arg p)", Use("link", "postfix", "-", 1, 2, "base-{robot}"), "{robot}"),
        ("", "a_$(arg p)_b", Use("link", "inside", "", 1, 2, "a_{robot}_b"), ""),
        ("arm", "$(arg p)_base", Use("link", "prefix", "_", 1, 2, "{robot}_base"), ""),
        ("base", "$(arg p)", Use("link", "whole", "", 1, 2, "{robot}"), ""),
    ],
)
def test_where_in_a_name(write: Path, default: str, name: str, use: Use, value: str) -> None:
    (argument,) = found(written(write, TWO_NAMES.format(default, name))).arguments
    assert (argument.uses, argument.value) == ((use,), value)


@pytest.mark.more
def test_the_command_that_is_advised_gives_every_robot_names_of_its_own(tmp_path: Path) -> None:
    for file in ("arm.urdf.xacro", "base.urdf.xacro"):
        words = [word.partition(":=") for word in found(XACROS / file).words]
        given = {name: value for name, _, value in words}
        one, two = rewrite_all(XACROS / file, ["r1", "r2"], layout="both", xacro_args=given)
        assert one.data != two.data
        assert one.data.replace(b"r1", b"r2") == two.data
        assert one.prepared.job.naming.own


@pytest.mark.more
def test_what_is_too_much_is_not_tried(write: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    many = "".join(f'<xacro:arg name="a{at}" default=""/>' for at in range(5))
    path = written(write, f'{many}<link name="x"/>')
    monkeypatch.setattr(xacro_arguments, "MOST", 3)
    assert found(path).untried == ("a3", "a4")
    # The clock is asked once at the start, then before each argument.
    hours = iter([0.0, 1.0, 2.0, 3600.0])
    late = find_arguments(str(path), {}, builtin_tree((), NEWEST_LTS), lambda: next(hours))
    assert [it.name for it in late.arguments] == ["a0", "a1"]
    assert late.untried == ("a2", "a3", "a4")


@pytest.mark.more
def test_the_table(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(XACROS / "arm.urdf.xacro")]) == 0
    out = capfd.readouterr().out.splitlines()
    assert out[0].split() == ["argument", "default", "goes", "into", "as", "count", "example"]
    assert out[1].split() == ["tf_prefix", "link", "prefix", "3", "of", "4", "{robot}base_link"]
    assert "go into no names: meshes" in out
    assert "take no name of a robot: length, sim" in out
    assert out[-1].endswith("robot1 robot2 -o 'out/{robot}.urdf' 'tf_prefix:={robot}_'")


def test_a_file_without_such_an_argument(write: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(written(write, '<link name="x"/>'))]) == 0
    out = capfd.readouterr().out.splitlines()
    assert out[:2] == [
        "no argument gives each robot its own names; the rewrite does it:",
        f"  urdf-postfix {write} robot1 robot2 -o 'out/{{robot}}.urdf'",
    ]


def test_json(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(XACROS / "base.urdf.xacro"), "--output-kind", "json"]) == 0
    made = json.loads(capfd.readouterr().out)["xacro"]
    assert made["for_robots"] == ["namespace:={robot}"]
    first, second = made["arguments"]
    assert first == {
        "name": "namespace",
        "default": "",
        "uses": [
            {
                "kind": "namespace",
                "how": "whole",
                "separator": "",
                "names": 2,
                "total": 2,
                "example": "{robot}",
            }
        ],
        "others": 0,
        "fault": "",
        "for_robots": "{robot}",
    }
    assert (second["name"], second["uses"]) == ("wheel", [])
    assert second["fault"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["a.xacro", "b.xacro"], "a.xacro: there is no such file"),
        (["missing.xacro"], "missing.xacro: there is no such file"),
        ([str(XACROS / "arm.urdf.xacro"), "p:={robot}"], "no robot is named to fill it in for"),
    ],
)
def test_wrong_use_is_one_line(
    words: list[str], said: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert main(["inspect", *words]) == 2
    err = capfd.readouterr().err
    assert said in err
    assert err.count("\n") == 1
