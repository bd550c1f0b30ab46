# SPDX-License-Identifier: Apache-2.0
"""MB5 beyond the examples: what must be found, at which line, and what must not."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from lint_calls import RULES, Settings, lint_file
from lxml import etree

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.description.checks.links_and_joints import loops, read_robot

GROUP = Settings(select=("MB5", "MB115", "MB124", "MB125", "MB170"))
BODY = '<visual><geometry><box size="1 1 1"/></geometry></visual>'
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def links(names: str) -> str:
    return "".join(f'<link name="{it}"/>' for it in names)


def joint(name: str, ends: str, kind: str = "fixed", inside: str = "") -> str:
    parent, child = ends
    return (
        f'\n<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f"{inside}</joint>"
    )


def limited(kind: str, attributes: str, inside: str = "") -> str:
    """Two links and a joint with that <limit>, on line 2."""
    return links("ab") + joint("j", "ab", kind, f"<limit {attributes}/>{inside}")


def reach(lower: str, upper: str) -> str:
    return f'lower="{lower}" upper="{upper}" effort="1" velocity="1"'


def found(body: str, folder: Path) -> list[Finding]:
    file = folder / "robot.urdf"
    file.write_text(f'<robot name="r">{body}</robot>')
    return lint_file(str(file), GROUP)


CASES = [
    # the tree
    pytest.param(links("abc") + joint("j", "bc"), "MB501:1", id="the smaller tree is the odd one"),
    pytest.param('<link name="x"/>' + joint("j", "yx"), "", id="an undeclared parent has its rule"),
    pytest.param("", "MB502:1", id="empty"),
    pytest.param('<xacro:macro xmlns:xacro="http://www.ros.org/wiki/xacro"/>', "", id="macros"),
    pytest.param(links("ab") + joint("j", "ab") + joint("k", "ba"), "MB503:3", id="no root at all"),
    pytest.param(
        links("abcd") + joint("j", "bc") + joint("k", "cd") + joint("l", "db"),
        "MB503:4",
        id="loop beside the root",
    ),
    pytest.param(
        links("abc") + joint("j", "ab") + joint("k", "bc") + joint("l", "cb"),
        "MB503:4 MB504:4",
        id="loop on the tree",
    ),
    pytest.param(
        links("ab") + joint("j", "ab") + joint("j", "ab"), "", id="a joint twice is MB201"
    ),
    pytest.param(
        links("ab") + joint("j", "ab") + joint("k", "ab"), "MB504:3", id="two parents are told once"
    ),
    pytest.param(
        links("ab") + joint("j", "ab") + joint("k", "ab") + joint("l", "ab"),
        "MB504:3 MB504:4",
        id="each parent too many is told",
    ),
    pytest.param(
        links("abc") + joint("j", "bb") + joint("k", "bc"),
        "MB505:1 MB506:2",
        id="below a joint to itself",
    ),
    pytest.param('<joint name="j" type="fixed"/>', "MB115:1 MB115:1 MB502:1", id="no ends"),
    pytest.param(
        links("a") + '\n<joint name="j" type="fixed"><parent link="a"/>\n<child/></joint>',
        "MB115:3",
        id="child without link",
    ),
    # types and limits
    pytest.param(links("ab") + joint("j", "ab", "FIXED"), "MB124:2", id="capitals"),
    pytest.param(links("ab") + joint("j", "ab", ""), "MB124:2", id="empty type"),
    pytest.param(links("ab") + joint("j", "ab", "prismatic"), "MB509:2", id="prismatic, no limit"),
    pytest.param(links("ab") + joint("j", "ab", "continuous"), "", id="continuous needs none"),
    pytest.param(limited("fixed", 'effort="1"'), "MB509:2 MB522:2", id="limit of a fixed joint"),
    pytest.param(limited("continuous", 'effort="1" velocity="1"'), "", id="wheel"),
    pytest.param(limited("revolute", reach("0.1", "0.0")), "MB511:2", id="inverted"),
    pytest.param(limited("revolute", reach("abc", "0")), "", id="not a number: another rule"),
    pytest.param(limited("revolute", reach("nan", "1e400")), "", id="not finite"),
    pytest.param(limited("revolute", reach("0", "-0.0")), "MB512:2", id="zero and minus zero"),
    pytest.param(limited("continuous", reach("0", "0")), "", id="zeros of a wheel"),
    pytest.param(limited("prismatic", 'effort="1" velocity="1"'), "MB509:2", id="no bounds"),
    pytest.param(
        limited("revolute", 'lower="0" upper="1" effort="-1" velocity="-2"'),
        "MB125:2 MB125:2",
        id="both negative",
    ),
    pytest.param(limited("revolute", 'lower="0" upper="1" effort="-0" velocity="1"'), "MB515:2"),
    pytest.param(limited("continuous", reach("-3.14159", "3.14159")), "", id="a whole turn"),
    pytest.param(limited("continuous", reach("-3", "3")), "MB516:2", id="less than a turn"),
    pytest.param(limited("prismatic", reach("0", "20")), "", id="a rail"),
    pytest.param(limited("prismatic", reach("-100", "100")), "", id="a virtual base"),
    pytest.param(limited("prismatic", reach("0", "85")), "MB517:2", id="a gripper in mm"),
    pytest.param(
        limited("prismatic", reach("0", "80")).replace('"a"/>', f'"a">{BODY}</link>', 1),
        "",
        id="dial",
    ),
    pytest.param(limited("revolute", reach("-9.42", "9.42")), "", id="one and a half turns"),
    pytest.param(limited("revolute", reach("-12.566", "12.566")), "", id="two turns"),
    pytest.param(limited("revolute", reach("-100", "100")), "", id="a hundred means no limit"),
    pytest.param(limited("revolute", reach("-1e16", "1e16")), "", id="endless"),
    pytest.param(limited("revolute", reach("-31.4", "31.4")), "", id="ten pi"),
    pytest.param(limited("revolute", reach("0", "180")), "MB170:2", id="degrees"),
    pytest.param(limited("revolute", reach("-94", "4.69")), "MB170:2", id="a lost point"),
    # axis
    pytest.param(
        links("ab") + joint("j", "ab", "fixed", '<axis xyz="0 0 0"/>'), "", id="SolidWorks"
    ),
    pytest.param(links("ab") + joint("j", "ab", "continuous", "<axis/>"), "MB519:2", id="no xyz"),
    pytest.param(
        links("ab") + joint("j", "ab", "continuous", '<axis xyz="0.577 0.577 0.577"/>'),
        "",
        id="three digits are enough",
    ),
    pytest.param(
        links("ab") + joint("j", "ab", "continuous", '<axis xyz="0 0"/>'), "", id="two numbers"
    ),
    pytest.param(
        links("ab") + joint("j", "ab", "continuous", '<axis xyz="0 0 -3"/>'), "MB520:2", id="long"
    ),
    pytest.param(
        links("ab") + joint("j", "ab", "prismatic", LIMIT + '<axis xyz="0 0 -3"/>'), "MB520:2"
    ),
    pytest.param(links("ab") + joint("j", "ab", "planar"), "MB523:2", id="planar"),
    pytest.param(
        links("ab") + joint("j", "ab", "fixed", '<origin xyz="-60 0 0"/>'), "MB524:2", id="far"
    ),
    pytest.param(
        links("ab") + joint("j", "ab", "fixed", '<origin xyz="15 0 0"/>'), "", id="a rail's end"
    ),
    # mimic
    pytest.param(
        links("abc")
        + joint("f", "ab", "floating")
        + joint("j", "bc", "revolute", LIMIT + '<mimic joint="f"/>'),
        "MB523:2 MB529:3",
        id="mimic of a floating joint",
    ),
    pytest.param(
        links("abc") + joint("f", "ab") + joint("j", "bc", "fixed", '<mimic joint="f"/>'),
        "MB522:3",
        id="mimic of a fixed joint in a fixed joint",
    ),
    pytest.param(
        links("ab") + joint("j", "ab", "revolute", LIMIT + '<mimic joint="nobody"/>'),
        "",
        id="an unknown leader is MB2",
    ),
    pytest.param(
        links("abcd")
        + joint("j", "ab", "revolute", LIMIT + '<mimic joint="k"/>')
        + joint("k", "bc", "revolute", LIMIT + '<mimic joint="l"/>')
        + joint("l", "cd", "revolute", LIMIT + '<mimic joint="j"/>'),
        "MB526:2",
        id="circle of three",
    ),
    pytest.param(
        links("ab") + joint("j", "ab", "revolute", LIMIT + '<mimic joint="j" multiplier="0.0"/>'),
        "MB526:2 MB530:2",
        id="itself, no times",
    ),
    pytest.param(
        links("abcd")
        + joint("j", "ab", "revolute", LIMIT + '<mimic joint="k"/>')
        + joint("k", "bc", "revolute", LIMIT + '<mimic joint="l"/>')
        + joint("l", "cd", "revolute", LIMIT),
        "MB528:2",
        id="chain of three",
    ),
    # safety controller, dynamics
    pytest.param(
        limited("revolute", reach("0", "1"), '<safety_controller k_velocity="1"/>'),
        "MB532:2",
        id="soft limits of 0",
    ),
    pytest.param(
        links("ab") + joint("j", "ab", "continuous", '<safety_controller k_velocity="1"/>'),
        "",
        id="a wheel needs no soft limits",
    ),
    pytest.param(
        limited(
            "revolute",
            reach("0", "1"),
            '<safety_controller soft_lower_limit="-0.0005" soft_upper_limit="1" k_velocity="1"/>',
        ),
        "",
        id="rounding",
    ),
    pytest.param(
        links("ab") + joint("j", "ab", "fixed", '<dynamics friction="0"/>'),
        "",
        id="friction is enough",
    ),
]


@pytest.mark.parametrize(("body", "expected"), CASES)
def test_what_is_found_and_what_is_not(body: str, expected: str, tmp_path: Path) -> None:
    assert " ".join(sorted(f"{it.code}:{it.line}" for it in found(body, tmp_path))) == expected


@pytest.mark.parametrize(
    ("ends", "lines"),
    [
        (("ab", "ab"), [3]),
        (("ac", "bc"), [3]),
        (("ad", "bd", "cd"), [3, 4]),
        # Its own parent, which is another finding.
        (("ab", "bb"), []),
    ],
)
def test_each_joint_but_the_first_is_told_of_a_child(
    ends: tuple[str, ...], lines: list[int], tmp_path: Path
) -> None:
    names = "".join(sorted({*"".join(ends)}))
    body = links(names) + "".join(joint(f"j{at}", it) for at, it in enumerate(ends))
    told = [it for it in found(body, tmp_path) if it.code == "MB504"]
    assert [it.line for it in told] == lines
    assert all(f"of 'j{at}' and of 'j0'" in it.message for at, it in enumerate(told, 1))


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", ["lower", "upper", "effort", "velocity", "xyz", "multiplier"])
@pytest.mark.parametrize(
    "value", ["", "nan", "inf", "-1e400", "abc", "1 2", "1_0", "9" * 400, "${x}"]
)
def test_odd_values_crash_nothing(name: str, value: str, tmp_path: Path) -> None:
    attributes = " ".join(f'{it}="1"' for it in ("effort", "velocity") if it != name)
    inside = (
        f'<limit {attributes} {name}="{value}"/><axis {name}="{value}"/><mimic {name}="{value}"/>'
        f'<safety_controller {name}="{value}"/><origin {name}="{value}"/><dynamics/>'
    )
    for kind in ("revolute", "prismatic", "continuous", value):
        findings = found(links("ab") + joint("j", "ab", kind, inside), tmp_path)
        assert "MB001" not in {it.code for it in findings}


def chain(size: int) -> str:
    names = "".join(f'<link name="l{it}"/>' for it in range(size))
    return names + "".join(
        f'<joint name="j{it}" type="fixed"><parent link="l{it}"/><child link="l{it + 1}"/></joint>'
        for it in range(size - 1)
    )


def star(size: int) -> str:
    names = "".join(f'<link name="l{it}"/>' for it in range(size))
    return names + "".join(
        f'<joint name="j{it}" type="fixed"><parent link="l0"/><child link="l{it + 1}"/></joint>'
        for it in range(size - 1)
    )


def ring(size: int) -> str:
    end = f'<joint name="e" type="fixed"><parent link="l{size - 1}"/><child link="l0"/></joint>'
    return chain(size) + end


def steps(shape: Callable[[int], str], size: int) -> int:
    """How many lines run; unlike seconds they are the same on every machine."""
    root = etree.fromstring(f'<robot name="r">{shape(size)}</robot>')
    count = 0

    def trace(frame: object, event: str, argument: object) -> object:
        nonlocal count
        count += event == "line"
        return trace

    before = sys.gettrace()
    sys.settrace(trace)  # type: ignore[arg-type]
    try:
        found = loops(read_robot(root))
    finally:
        sys.settrace(before)
    assert len(found) == (shape is ring)
    return count


@pytest.mark.parametrize("shape", [chain, star, ring])
def test_large_robots_take_steps_as_many_as_they_have_links(shape: Callable[[int], str]) -> None:
    assert steps(shape, 800) < 5 * steps(shape, 200)  # linear: 4, quadratic: 16


@pytest.mark.slow
@pytest.mark.parametrize("shape", [chain, star, ring])
def test_no_depth_or_width_is_too_much(shape: Callable[[int], str], tmp_path: Path) -> None:
    assert "MB001" not in {it.code for it in found(shape(2000), tmp_path)}


def test_every_rule_of_the_group_is_in_a_case() -> None:
    reported = {it for case in CASES for it in str(case.values[1]).split() if it[:3] == "MB5"}
    examples = {"MB532", "MB534", "MB509", "MB538"}  # their examples say all there is
    geometry = {"MB536", "MB537"}  # test_lint_geometry.py
    known = {it[:5] for it in reported} | examples | geometry
    assert known == {it for it in RULES if it.startswith("MB5")}
