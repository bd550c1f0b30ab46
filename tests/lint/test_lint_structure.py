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


# What is in the robot -> codes and lines of what is found.
CASES = {
    # the tree
    "the smaller tree is the odd one -> MB501:1": links("abc") + joint("j", "bc"),
    "an undeclared parent has its rule": '<link name="x"/>' + joint("j", "yx"),
    "empty -> MB502:1": "",
    "macros": '<xacro:macro xmlns:xacro="http://www.ros.org/wiki/xacro"/>',
    "no root at all -> MB503:3": links("ab") + joint("j", "ab") + joint("k", "ba"),
    "loop beside the root -> MB503:4": links("abcd")
    + joint("j", "bc")
    + joint("k", "cd")
    + joint("l", "db"),
    "loop on the tree -> MB503:4 MB504:4": links("abc")
    + joint("j", "ab")
    + joint("k", "bc")
    + joint("l", "cb"),
    "a joint twice is MB201": links("ab") + joint("j", "ab") + joint("j", "ab"),
    "two parents are told once -> MB504:3": links("ab") + joint("j", "ab") + joint("k", "ab"),
    "each parent too many is told -> MB504:3 MB504:4": links("ab")
    + joint("j", "ab")
    + joint("k", "ab")
    + joint("l", "ab"),
    "below a joint to itself -> MB505:1 MB506:2": links("abc")
    + joint("j", "bb")
    + joint("k", "bc"),
    "no ends -> MB115:1 MB115:1 MB502:1": '<joint name="j" type="fixed"/>',
    "child without link -> MB115:3": links("a")
    + '\n<joint name="j" type="fixed"><parent link="a"/>\n<child/></joint>',
    # types and limits
    "capitals -> MB124:2": links("ab") + joint("j", "ab", "FIXED"),
    "empty type -> MB124:2": links("ab") + joint("j", "ab", ""),
    "prismatic, no limit -> MB509:2": links("ab") + joint("j", "ab", "prismatic"),
    "continuous needs none": links("ab") + joint("j", "ab", "continuous"),
    "limit of a fixed joint -> MB509:2 MB522:2": limited("fixed", 'effort="1"'),
    "wheel": limited("continuous", 'effort="1" velocity="1"'),
    "inverted -> MB511:2": limited("revolute", reach("0.1", "0.0")),
    "not a number: another rule": limited("revolute", reach("abc", "0")),
    "not finite": limited("revolute", reach("nan", "1e400")),
    "zero and minus zero -> MB512:2": limited("revolute", reach("0", "-0.0")),
    "zeros of a wheel": limited("continuous", reach("0", "0")),
    "no bounds -> MB509:2": limited("prismatic", 'effort="1" velocity="1"'),
    "both negative -> MB125:2 MB125:2": limited(
        "revolute", 'lower="0" upper="1" effort="-1" velocity="-2"'
    ),
    "an effort of -0 -> MB515:2": limited(
        "revolute", 'lower="0" upper="1" effort="-0" velocity="1"'
    ),
    "a whole turn": limited("continuous", reach("-3.14159", "3.14159")),
    "less than a turn -> MB516:2": limited("continuous", reach("-3", "3")),
    "a rail": limited("prismatic", reach("0", "20")),
    "a virtual base": limited("prismatic", reach("-100", "100")),
    "a gripper in mm -> MB517:2": limited("prismatic", reach("0", "85")),
    "dial": limited("prismatic", reach("0", "80")).replace('"a"/>', f'"a">{BODY}</link>', 1),
    "one and a half turns": limited("revolute", reach("-9.42", "9.42")),
    "two turns": limited("revolute", reach("-12.566", "12.566")),
    "a hundred means no limit": limited("revolute", reach("-100", "100")),
    "endless": limited("revolute", reach("-1e16", "1e16")),
    "ten pi": limited("revolute", reach("-31.4", "31.4")),
    "degrees -> MB170:2": limited("revolute", reach("0", "180")),
    "a lost point -> MB170:2": limited("revolute", reach("-94", "4.69")),
    # axis
    "SolidWorks": links("ab") + joint("j", "ab", "fixed", '<axis xyz="0 0 0"/>'),
    "no xyz -> MB519:2": links("ab") + joint("j", "ab", "continuous", "<axis/>"),
    "three digits are enough": links("ab")
    + joint("j", "ab", "continuous", '<axis xyz="0.577 0.577 0.577"/>'),
    "two numbers": links("ab") + joint("j", "ab", "continuous", '<axis xyz="0 0"/>'),
    "long -> MB520:2": links("ab") + joint("j", "ab", "continuous", '<axis xyz="0 0 -3"/>'),
    "a long axis of a slide -> MB520:2": links("ab")
    + joint("j", "ab", "prismatic", LIMIT + '<axis xyz="0 0 -3"/>'),
    "planar -> MB523:2": links("ab") + joint("j", "ab", "planar"),
    "far -> MB524:2": links("ab") + joint("j", "ab", "fixed", '<origin xyz="-60 0 0"/>'),
    "a rail's end": links("ab") + joint("j", "ab", "fixed", '<origin xyz="15 0 0"/>'),
    # mimic
    "mimic of a floating joint -> MB523:2 MB529:3": links("abc")
    + joint("f", "ab", "floating")
    + joint("j", "bc", "revolute", LIMIT + '<mimic joint="f"/>'),
    "mimic of a fixed joint in a fixed joint -> MB522:3": links("abc")
    + joint("f", "ab")
    + joint("j", "bc", "fixed", '<mimic joint="f"/>'),
    "an unknown leader is MB2": links("ab")
    + joint("j", "ab", "revolute", LIMIT + '<mimic joint="nobody"/>'),
    "circle of three -> MB526:2": links("abcd")
    + joint("j", "ab", "revolute", LIMIT + '<mimic joint="k"/>')
    + joint("k", "bc", "revolute", LIMIT + '<mimic joint="l"/>')
    + joint("l", "cd", "revolute", LIMIT + '<mimic joint="j"/>'),
    "itself, no times -> MB526:2 MB530:2": links("ab")
    + joint("j", "ab", "revolute", LIMIT + '<mimic joint="j" multiplier="0.0"/>'),
    "chain of three -> MB528:2": links("abcd")
    + joint("j", "ab", "revolute", LIMIT + '<mimic joint="k"/>')
    + joint("k", "bc", "revolute", LIMIT + '<mimic joint="l"/>')
    + joint("l", "cd", "revolute", LIMIT),
    # safety controller, dynamics
    "soft limits of 0 -> MB532:2": limited(
        "revolute", reach("0", "1"), '<safety_controller k_velocity="1"/>'
    ),
    "a wheel needs no soft limits": links("ab")
    + joint("j", "ab", "continuous", '<safety_controller k_velocity="1"/>'),
    "rounding": limited(
        "revolute",
        reach("0", "1"),
        '<safety_controller soft_lower_limit="-0.0005" soft_upper_limit="1" k_velocity="1"/>',
    ),
    "friction is enough": links("ab") + joint("j", "ab", "fixed", '<dynamics friction="0"/>'),
}


@pytest.mark.parametrize("name", CASES)
def test_what_is_found_and_what_is_not(name: str, tmp_path: Path) -> None:
    said = sorted(f"{it.code}:{it.line}" for it in found(CASES[name], tmp_path))
    assert said == name.partition(" -> ")[2].split()


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
    reported = {it for name in CASES for it in name.split() if it[:3] == "MB5"}
    examples = {"MB532", "MB534", "MB509", "MB538"}  # their examples say all there is
    geometry = {"MB536", "MB537"}  # test_lint_geometry.py
    known = {it[:5] for it in reported} | examples | geometry
    assert known == {it for it in RULES if it.startswith("MB5")}
