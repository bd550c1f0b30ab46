# SPDX-License-Identifier: Apache-2.0
"""Spelling: kinds, layouts, separators, shared names, and the way back."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import product
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from multibot_rewrite import UsageError
from multibot_rewrite.base.naming import (
    FRAME_KINDS,
    LAYOUTS,
    NAMESPACE,
    POSTFIX,
    PREFIX,
    SEPARATORS,
    Layout,
    Naming,
    affix,
    is_keyword,
    make_naming,
    overlap,
    removal,
)

KINDS = tuple(SEPARATORS)
STRATEGIES = (None, POSTFIX, PREFIX, NAMESPACE)
ROBOT = "r1"
POLICIES = [
    pytest.param(layout.short, side, topics, id=f"{layout.short}-{side}-{topics}")
    for layout, side, topics in product(LAYOUTS, (POSTFIX, PREFIX), STRATEGIES)
    if side == PREFIX or not layout.at_run_time
]
TEXTS = (
    "a", "arm", "/a", "a/", "/", "", "r1", "/r1", "r1/", "r1/a", "a/r1", "a_r1", "r1_a", "r1/r1",
    "r1_r1", "/r1/a", "/a/r1", "world", "/world", "map", "tf", "/tf", "/clock", "~/a", "~", "{n}/a",
    "$(n)", "a b", "a::b", "ä", "__ns",
)  # fmt: skip


def spelled(naming: Naming, kind: str, text: str, namespaced: bool = False) -> str:
    """The name for the robot; unchanged where it stays."""
    there = affix(naming, kind, text, namespaced)
    return there.spell(text, ROBOT) if there else text


def takes(kind: str, mark: str) -> bool:
    """Is the separator allowed for the kind?"""
    try:
        make_naming(separators={kind: mark})
    except UsageError:
        return False
    return True


def assert_inverse(naming: Naming, kind: str, text: str, robot: str, namespaced: bool) -> None:
    there = affix(naming, kind, text, namespaced)
    if there is None:
        return
    new = there.spell(text, robot)
    span = removal(naming, robot, kind, new, namespaced)
    assert new != text
    assert span is not None, new
    assert new[: span[0]] + new[span[1] :] == text


@pytest.mark.parametrize(("layout", "side", "topics"), POLICIES)
def test_removal_undoes_affix_for_every_kind(layout: str, side: str, topics: str | None) -> None:
    naming = make_naming(layout, side, topics)
    for kind, text, namespaced in product(KINDS, TEXTS, (False, True)):
        assert_inverse(naming, kind, text, ROBOT, namespaced)


def test_a_stem_below_a_namespace_is_the_robots_already_unless_it_is_absolute() -> None:
    """gazebo_ros puts its namespace before /camera no more than rcl does."""
    naming = make_naming("both")
    for text, moved in (("/eye", True), ("/eye/left", True), ("eye", False), ("eye/", False)):
        assert (affix(naming, "stem", text, namespaced=True) is not None) is moved, text


@pytest.mark.slow
@given(
    st.sampled_from(LAYOUTS),
    st.sampled_from((POSTFIX, PREFIX)),
    st.sampled_from(STRATEGIES),
    st.sampled_from(
        [(kind, mark) for kind in KINDS for mark in ("/", "_", "__") if takes(kind, mark)]
    ),
    st.text("ab_/.-~ ", max_size=6),
    st.sampled_from(("a", "b", "_", "a_b", "ab", "a__b")),
    st.booleans(),
)
def test_removal_undoes_affix_for_any_text(
    layout: Layout, side: str, topics: str | None, marked: tuple[str, str], text: str, robot: str,
    namespaced: bool,
) -> None:  # fmt: skip
    kind, mark = marked
    assume(not layout.at_run_time or (side == PREFIX and (mark == "/" or kind not in FRAME_KINDS)))
    naming = make_naming(layout.name, side, topics, {kind: mark})
    assert_inverse(naming, kind, text, robot, namespaced)


@pytest.mark.sample(3)
@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("kind", KINDS)
def test_nothing_is_removed_that_was_not_put_there(kind: str, text: str) -> None:
    naming = make_naming()
    span = removal(naming, ROBOT, kind, text)
    if span is not None:
        assert spelled(naming, kind, text[: span[0]] + text[span[1] :]) == text


@pytest.mark.parametrize(
    ("kind", "text", "postfix", "prefix"),
    [
        ("link", "base", "base/r1", "r1/base"),
        ("link", "/base", "/base/r1", "/r1/base"),
        ("link", "a b", "a b/r1", "r1/a b"),
        ("frame", "odom", "odom/r1", "r1/odom"),
        ("joint", "lift", "lift_r1", "r1_lift"),
        ("sensor", "imu", "imu_r1", "r1_imu"),
        ("transmission", "t", "t_r1", "r1_t"),
        ("actuator", "m", "m_r1", "r1_m"),
        ("hardware", "sys", "sys_r1", "r1_sys"),
        ("gpio", "io", "io_r1", "r1_io"),
        ("model", "rover", "rover_r1", "r1_rover"),
        ("node", "drive", "drive_r1", "r1_drive"),
        ("stem", "cam", "cam_r1", "r1_cam"),
        ("topic", "scan", "scan/r1", "r1/scan"),
        ("topic", "/scan", "/scan/r1", "/r1/scan"),
        ("topic", "a/scan", "a/scan/r1", "r1/a/scan"),
        ("service", "/reset", "/reset/r1", "/r1/reset"),
        ("link", "world", "world", "world"),
        ("frame", "/map", "/map", "/map"),
        ("joint", "world", "world_r1", "r1_world"),
        ("topic", "/clock", "/clock", "/clock"),
        ("topic", "clock", "clock", "clock"),
        ("topic", "~/scan", "~/scan", "~/scan"),
        ("topic", "scan/", "scan/", "scan/"),
        ("topic", "/", "/", "/"),
        ("topic", "", "", ""),
        ("topic", "{ns}/scan", "{ns}/scan", "{ns}/scan"),
        ("topic", "$(env NS)/scan", "$(env NS)/scan", "$(env NS)/scan"),
        ("topic", "tf", "tf/r1", "r1/tf"),
        ("subtopic", "image", "image", "image"),
        ("subtopic", "/image", "/image/r1", "/r1/image"),
        ("namespace", "/front", "/front", "/front"),
        ("link", "", "/r1", "r1/"),
    ],
)
def test_a_name_under_the_default_layout(kind: str, text: str, postfix: str, prefix: str) -> None:
    assert spelled(make_naming(), kind, text) == postfix
    assert spelled(make_naming(affix="prefix"), kind, text) == prefix


@pytest.mark.parametrize(
    ("layout", "link", "joint", "node", "topic", "tf", "namespace"),
    [
        ("L1", "base", "lift", "drive", "r1/scan", "/r1/tf", "/r1/front"),
        ("L2", "base/r1", "lift_r1", "drive", "r1/scan", "/tf", "/r1/front"),
        ("L3", "base/r1", "lift_r1", "drive", "r1/scan", "/r1/tf", "/r1/front"),
        ("L4", "base/r1", "lift_r1", "drive_r1", "scan/r1", "/tf/r1", "/front"),
    ],
)
@pytest.mark.parametrize("long", [False, True], ids=["short", "long"])
def test_the_four_layouts(
    layout: str, long: bool, link: str, joint: str, node: str, topic: str, tf: str, namespace: str
) -> None:
    word = next(item.name for item in LAYOUTS if item.short == layout) if long else layout
    naming = make_naming(word)
    assert naming.layout.short == layout
    given_ = {"link": "base", "joint": "lift", "node": "drive", "topic": "scan"}
    new = [spelled(naming, kind, text) for kind, text in given_.items()]
    assert new == [link, joint, node, topic]
    assert spelled(naming, "topic", "/tf") == tf
    assert spelled(naming, "namespace", "/front") == namespace


@pytest.mark.parametrize(
    ("topics", "namespaced", "text", "expected"),
    [
        ("postfix", False, "scan", "scan/r1"),
        ("postfix", True, "scan", "scan/r1"),
        ("postfix", True, "/scan", "/scan/r1"),
        ("prefix", False, "scan", "r1/scan"),
        ("prefix", True, "/a/scan", "/r1/a/scan"),
        ("namespace", True, "scan", "scan"),
        ("namespace", False, "scan", "r1/scan"),
        ("namespace", True, "/scan", "/r1/scan"),
        ("namespace", False, "/scan", "/r1/scan"),
        ("namespace", True, "~/scan", "~/scan"),
        ("namespace", False, "scan/", "scan/"),
        ("namespace", True, "/{n}/scan", "/{n}/scan"),
    ],
)
def test_topic_strategies(topics: str, namespaced: bool, text: str, expected: str) -> None:
    assert spelled(make_naming(topics=topics), "topic", text, namespaced) == expected


@pytest.mark.parametrize("text", ["tf", "/tf", "tf_static", "/tf_static"])
def test_one_tf_for_all_stays(text: str) -> None:
    assert spelled(make_naming("L2"), "topic", text) == text
    assert spelled(make_naming("L3"), "topic", text) != text


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "r1"),
        ("/", "/r1"),
        ("front", "r1/front"),
        ("/front", "/r1/front"),
        ("/a/b", "/r1/a/b"),
        ("${ns}", "${ns}"),
    ],
)
def test_the_robot_comes_first_in_a_namespace(text: str, expected: str) -> None:
    assert spelled(make_naming("L1"), "namespace", text) == expected
    assert spelled(make_naming("L1", "prefix"), "namespace", text) == expected


@pytest.mark.parametrize(("namespaced", "expected"), [(True, "cam"), (False, "cam_r1")])
def test_a_stem_stays_where_a_namespace_reaches_it(namespaced: bool, expected: str) -> None:
    assert spelled(make_naming("L1"), "stem", "cam", namespaced) == expected


def test_frames_named_at_run_time_leave_links_and_joints() -> None:
    naming = make_naming("frame-prefix")
    kinds = ("frame", "link", "joint", "sensor", "hardware", "model")
    names = [spelled(naming, kind, "x") for kind in kinds]
    assert names == ["r1/x", "x", "x", "x", "x", "x"]
    assert spelled(naming, "topic", "/scan") == "/r1/scan"
    assert spelled(naming, "topic", "/tf") == "/tf"
    assert spelled(naming, "frame", "map") == "map"


@pytest.mark.parametrize(
    ("options", "hint"),
    [
        ({"affix": "postfix"}, "use affix: prefix"),
        ({"separators": {"frame": "_"}}, "use frame=/"),
        ({"separators": {"link": "_"}}, "use frame=/"),
    ],
)
def test_nodes_name_frames_in_one_way(options: dict[str, Any], hint: str) -> None:
    with pytest.raises(UsageError, match=hint):
        make_naming("frame-prefix", **options)


def test_shared_names_are_a_choice() -> None:
    naming = make_naming(shared_frames=["/odom"], shared_topics=["points/"])
    frames = [spelled(naming, "frame", text) for text in ("odom", "world")]
    topics = [spelled(naming, "topic", text) for text in ("/points", "/clock")]
    assert frames + topics == ["odom", "world/r1", "/points", "/clock/r1"]


@pytest.mark.parametrize(
    ("given_", "link", "frame"),
    [
        ({"link": "_"}, "x_r1", "x_r1"),
        ({"frame": "_"}, "x/r1", "x_r1"),
        ({"link": "_", "frame": "."}, "x_r1", "x.r1"),
        ({"link": "__"}, "x__r1", "x__r1"),
        ({}, "x/r1", "x/r1"),
    ],
)
def test_a_link_separator_carries_the_frames(
    given_: Mapping[str, str], link: str, frame: str
) -> None:
    naming = make_naming(separators=given_)
    assert [spelled(naming, kind, "x") for kind in ("link", "frame")] == [link, frame]


@pytest.mark.parametrize("mark", ["", "//", " ", "x", "a_", ":", "::", "~", "\n", "<", "_//", "é"])
def test_a_separator_that_cannot_be_is_refused(mark: str) -> None:
    with pytest.raises(UsageError, match="separator link="):
        make_naming(separators={"link": mark})


@pytest.mark.parametrize(
    ("kind", "mark"),
    [
        ("topic", "-"),
        ("topic", "."),
        ("service", "-"),
        ("subtopic", "."),
        ("stem", "-"),
        ("namespace", "-"),
        ("node", "-"),
        ("node", "/"),
    ],
)
def test_a_separator_ros_does_not_allow_is_refused(kind: str, mark: str) -> None:
    with pytest.raises(UsageError, match=f"separator {kind}="):
        make_naming(separators={kind: mark})


@pytest.mark.parametrize(
    ("options", "parts"),
    [
        ({"layout": "L9"}, ["layout 'L9'", *(layout.name for layout in LAYOUTS)]),
        ({"layout": "tf_per_robot"}, ["did you mean 'tf-per-robot'?"]),
        ({"layout": "bothe"}, ["did you mean 'both'?"]),
        ({"affix": "postfx"}, ["affix 'postfx'", "did you mean 'postfix'?"]),
        ({"affix": "prefx"}, ["did you mean 'prefix'?"]),
        ({"affix": "namespace"}, ["affix 'namespace'", "postfix, prefix"]),
        ({"affix": ""}, ["affix ''"]),
        ({"topics": "namespaces"}, ["topics 'namespaces'", "did you mean 'namespace'?"]),
        ({"separators": {"jiont": "_"}}, ["separator kind 'jiont'", "did you mean 'joint'?"]),
    ],
)
def test_an_unknown_word_proposes_the_nearest(
    options: dict[str, object], parts: Iterable[str]
) -> None:
    with pytest.raises(UsageError) as caught:
        make_naming(**options)  # type: ignore[arg-type]
    for part in parts:
        assert part in str(caught.value)


@pytest.mark.parametrize(
    ("side", "robots", "pairs"),
    [
        ("postfix", ["left_b", "b"], [("left_b", "b", "_")]),
        ("postfix", ["b", "a", "left_b"], [("left_b", "b", "_")]),
        ("postfix", ["b_left", "b"], []),
        ("postfix", ["leftb", "b"], []),
        ("postfix", ["left_B", "b"], []),
        ("postfix", ["robot1", "robot11", "robot2"], []),
        ("postfix", ["b", "b"], []),
        ("postfix", ["x_y_z", "z", "y_z"], [
            ("x_y_z", "y_z", "_"), ("x_y_z", "z", "_"), ("y_z", "z", "_"),
        ]),
        ("prefix", ["b_left", "b"], [("b_left", "b", "_")]),
        ("prefix", ["left_b", "b"], []),
    ],
)  # fmt: skip
def test_robots_that_can_meet(
    side: str, robots: list[str], pairs: list[tuple[str, str, str]]
) -> None:
    assert overlap(make_naming(affix=side), robots) == pairs


@pytest.mark.slow
@given(
    st.sampled_from((POSTFIX, PREFIX)),
    st.sets(st.text("b_", min_size=1, max_size=6), max_size=4),
    st.sampled_from(("_", "__", "/")),
)
def test_overlap_is_what_its_text_says(side: str, robots: set[str], mark: str) -> None:
    naming = make_naming("L4", side)._replace(separators=dict.fromkeys(KINDS, mark))
    expected = {
        (robot, other, mark)
        for robot, other in product(robots, robots)
        if (robot.endswith(mark + other) if side == POSTFIX else robot.startswith(other + mark))
    }
    assert set(overlap(naming, robots)) == expected


def test_topics_that_meet_on_the_other_side_are_seen() -> None:
    naming = make_naming(affix="postfix", topics="prefix", separators={"topic": "_"})
    assert affix(naming, "topic", "x").spell("x", "b_left") == "b_left_x"  # type: ignore[union-attr]
    assert affix(naming, "topic", "left_x").spell("left_x", "b") == "b_left_x"  # type: ignore[union-attr]
    assert ("b_left", "b", "_") in overlap(naming, ["b_left", "b"])


@pytest.mark.parametrize(
    ("name", "keyword"),
    [("__model__", 1), ("____", 1), ("___", 0), ("__model", 0), ("model__", 0), ("_model_", 0)],
)
def test_words_that_sdf_reserves(name: str, keyword: int) -> None:
    """sdformat Utils.cc, isReservedName."""
    assert is_keyword(name) == bool(keyword)
