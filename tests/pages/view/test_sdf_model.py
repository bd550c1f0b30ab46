# SPDX-License-Identifier: Apache-2.0
"""An SDF as the view draws it. Where things are is worked out by hand, from SDFormat."""

from __future__ import annotations

from math import pi
from pathlib import Path

import pytest
from lxml import etree
from paths import fixture_text

from multibot_rewrite.base.model import InputError
from multibot_rewrite.pages.view.models import Joint, Model
from multibot_rewrite.pages.view.sdf_model import load_sdf

SDF = fixture_text("sdf_model_sdf.sdf")


def load(text: str) -> Model:
    return load_sdf(etree.fromstring(text), "m.sdf")


@pytest.fixture
def model() -> Model:
    return load(SDF)


def of(model: Model, name: str) -> Joint:
    (found,) = [it for it in model.joints if it.name == name]
    return found


def at(pose: object) -> list[float]:
    return [pytest.approx(row[3], abs=1e-6) for row in list(pose)[:3]]  # type: ignore[call-overload]


def test_links_are_where_their_poses_say(model: Model) -> None:
    assert list(model.links) == ["__model__", "base", "wheel", "head::base"]
    assert at(of(model, "base in __model__").pose) == [1, 0, 0]
    # The wheel's frame is that of its joint: 0.1 along the wheel's own x, which is base's y.
    assert at(of(model, "turn").pose) == [0, 1.1, 0]
    # From base: the mount is 2 up, the head 1 above it, its link 0.25 more.
    assert at(of(model, "neck").pose) == [0, 0, 3.25]


def test_a_joint_turns_about_its_axis_and_keeps_its_limits(model: Model) -> None:
    turn, neck = of(model, "turn"), of(model, "neck")
    assert (turn.type, turn.parent, turn.child) == ("revolute", "base", "wheel")
    # base's x in a frame that is turned by 90 degrees about z.
    assert turn.axis == pytest.approx((0, -1, 0), abs=1e-9)
    assert (turn.lower, turn.upper) == (-1, 0.5)
    assert (neck.parent, neck.child, neck.axis) == ("base", "head::base", (0, 0, 1))
    assert neck.lower < 0 < neck.upper
    assert not [it for it in model.joints if it.name in ("loop", "to_world")]


@pytest.mark.parametrize(
    ("scale", "size"),
    [("", (1, 1, 1)), ("<scale>2 3 4</scale>", (2, 3, 4)), ("<scale>2 3</scale>", (1, 1, 1))],
)
@pytest.mark.parametrize(
    ("diffuse", "colour"),
    [("1 0 0 0.5", (1, 0, 0, 0.5)), ("1 0 0", (1, 0, 0, 1)), ("1 0", ()), ("", ())],
)
def test_a_mesh_of_the_only_link(
    scale: str, size: object, diffuse: str, colour: object, tmp_path: Path
) -> None:
    """A link that no joint moves and that is where its model is stands alone."""
    (tmp_path / "a.stl").write_bytes(b"")
    text = (
        f'<sdf><model name="m"><link name="a"><pose/><visual name="v"><geometry><mesh>{scale}'
        f"<uri> a.stl </uri></mesh></geometry><material><diffuse>{diffuse}</diffuse></material>"
        "</visual></link></model></sdf>"
    )
    model = load_sdf(etree.fromstring(text), str(tmp_path / "m.sdf"))
    assert (list(model.links), model.joints) == (["a"], ())
    (shape,) = model.links["a"]
    assert (shape.kind, shape.mesh, shape.missing) == ("mesh", str(tmp_path / "a.stl"), "")
    assert (shape.size, shape.colour) == (size, colour)


def test_a_visual_may_be_where_another_frame_is() -> None:
    visual = (
        '<visual name="v"><pose relative_to="f">1 0 0 0 0 0</pose><geometry><box><size>1 1 1</size>'
        "</box></geometry></visual>"
    )
    text = f'<frame name="f"><pose>0 2 0 0 0 0</pose></frame><link name="a">{visual}</link>'
    (shape,) = load(f'<sdf><model name="m">{text}</model></sdf>').links["a"]
    assert at(shape.pose) == [1, 2, 0]


@pytest.mark.parametrize(
    ("kind", "ends"),
    [("revolute", (-pi, pi)), ("continuous", (-pi, pi)), ("prismatic", (-10.0, 10.0))],
)
def test_a_joint_without_limits_makes_one_turn_or_ten_metres(
    kind: str, ends: tuple[float, float]
) -> None:
    joint = f'<joint name="j" type="{kind}"><parent>a</parent><child>b</child></joint>'
    text = (
        f'<sdf version="1.9"><model name="m"><link name="a"/><link name="b"/>{joint}</model></sdf>'
    )
    made = of(load(text), "j")
    assert (made.lower, made.upper) == pytest.approx(ends)
    assert (made.parent, made.child, made.axis, made.mimic) == ("a", "b", (0, 0, 1), None)
    # SDF's own defaults are as far as a number goes.
    wide = "<axis><limit><lower>-1e16</lower><upper>1e16</upper></limit></axis>"
    made = of(load(text.replace("</joint>", f"{wide}</joint>")), "j")
    assert (made.lower, made.upper) == pytest.approx(ends)


def test_a_joint_that_cannot_move_has_no_limits() -> None:
    limit = "<axis><limit><lower>-1</lower><upper>1</upper></limit></axis>"
    joint = f'<joint name="j" type="ball"><parent>a</parent><child>b</child>{limit}</joint>'
    made = of(
        load(f'<sdf><model name="m"><link name="a"/><link name="b"/>{joint}</model></sdf>'), "j"
    )
    assert (made.type, made.lower, made.upper) == ("ball", 0, 0)


def test_shapes_stay_where_their_link_is(model: Model) -> None:
    (box,), (cylinder,) = model.links["base"], model.links["wheel"]
    assert (box.kind, box.size, box.colour) == ("box", (1, 2, 3), (1, 0, 0, 1))
    assert at(box.pose) == [0, 0, 0.5]
    # The visual is where the joint is.
    assert (cylinder.kind, cylinder.size) == ("cylinder", (0.1, 0.4))
    assert at(cylinder.pose) == [0, 0, 0]


@pytest.mark.parametrize(
    ("pose", "turned"),
    [
        ("<pose>0 0 0 0 0 1.5707963267948966</pose>", pi / 2),
        ('<pose degrees="true">0 0 0 0 0 90</pose>', pi / 2),
        ('<pose rotation_format="quat_xyzw">0 0 0 0 0 0.70710678 0.70710678</pose>', pi / 2),
        ("<pose>no number</pose>", 0),
        ("<pose/>", 0),
    ],
)
def test_a_pose_in_every_form(pose: str, turned: float) -> None:
    made = load(
        '<sdf version="1.9"><model name="m"><link name="a"/><link name="b">'
        f"{pose}</link></model></sdf>"
    )
    if not turned:
        assert of(made, "b in __model__").pose[1][:2] == [0, 1]
        return
    assert of(made, "b in __model__").pose[1][:2] == pytest.approx([1, 0], abs=1e-6)


def test_what_cannot_be_shown_is_said() -> None:
    with pytest.raises(InputError, match=r"m\.sdf: it has no <model> to show"):
        load("<sdf/>")
    text = '<link name="{0}"><pose relative_to="{1}"/></link>'
    both = text.format("a", "b") + text.format("b", "a")
    with pytest.raises(InputError, match="the pose of 'a' depends on itself"):
        load(f'<sdf><model name="m">{both}</model></sdf>')


def test_a_shape_is_drawn_where_it_has_its_sizes() -> None:
    for tag, size, kinds in (
        ("sphere", "<radius>2</radius>", ["sphere"]),
        ("sphere", "", []),
        ("cylinder", "<radius>2</radius>", []),
        ("capsule", "<radius>2</radius><length>1</length>", ["cylinder"]),
        ("box", "<size>1 2</size>", []),
        ("plane", "<radius>2</radius>", []),
    ):
        visual = f'<visual name="v"><geometry><{tag}>{size}</{tag}></geometry></visual>'
        made = load(
            f'<sdf version="1.9"><model name="m"><link name="a">{visual}</link></model></sdf>'
        )
        assert [it.kind for shapes in made.links.values() for it in shapes] == kinds, (tag, size)
