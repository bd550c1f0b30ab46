# SPDX-License-Identifier: Apache-2.0
"""What a name of each kind becomes for a robot, and how it is taken away again."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import (
    SEPARATORS,
    Affix,
    Naming,
    is_keyword,
    is_of_world,
    make_naming,
    overlap,
    removal,
    spelled,
)

ROS = {"stem": "_", "topic": "/", "subtopic": "/", "service": "/"}
FRAMED = {
    "link": "/", "joint": "_", "frame": "/", "sensor": "_", "light": "_", "transmission": "_",
    "actuator": "_", "hardware": "_", "gpio": "_", "model": "_", "shape": "_",
}  # fmt: skip


@pytest.mark.parametrize(
    ("layout", "separators", "topics", "shared"),
    [
        ("L1", {"light": "_", **ROS, "namespace": "/"}, "namespace", False),
        ("L2", {**FRAMED, **ROS, "namespace": "/"}, "namespace", True),
        ("L3", {**FRAMED, **ROS, "namespace": "/"}, "namespace", False),
        ("L4", {**FRAMED, **ROS, "node": "_"}, "postfix", False),
        ("L5", {"frame": "/", "light": "_", **ROS, "namespace": "/"}, "namespace", True),
    ],
)
def test_what_a_layout_renames(
    layout: str, separators: dict[str, str], topics: str, shared: bool
) -> None:
    naming = make_naming(layout)
    assert (naming.separators, naming.topics) == (separators, topics)
    assert ({"tf", "tf_static"} <= naming.shared_topics) is shared
    assert naming.affix == ("prefix" if layout == "L5" else "postfix")
    assert {"clock", "rosout"} <= naming.shared_topics and "map" in naming.shared_frames
    renamed = make_naming(layout, groups="rename").separators
    assert ("group" in renamed) is (layout in ("L2", "L3", "L4"))
    assert naming.layout.renames_models is (layout in ("L2", "L3", "L4"))


def test_the_usual_policy_and_its_words() -> None:
    assert make_naming() == make_naming("postfix", "postfix", "postfix")
    assert make_naming("L4", "prefix").topics == "prefix"
    assert make_naming("L1", topics="postfix").topics == "postfix"
    own = make_naming("L4", shared_frames=["/depot/"], shared_topics=["/a/"])
    assert (own.shared_frames, own.shared_topics) == ({"depot"}, {"a"})


def test_a_frame_has_the_separator_of_a_link() -> None:
    assert make_naming(separators={"link": "-"}).separators["frame"] == "-"
    both = make_naming(separators={"link": "-", "frame": "."}).separators
    assert (both["link"], both["frame"]) == ("-", ".")
    assert make_naming(separators={"frame": "."}).separators["link"] == "/"


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("words", "said"),
    [
        ({"layout": "boht"}, "layout 'boht' is not known, use one of tf-per-robot,"
         " frames-per-robot, both, postfix, frame-prefix; did you mean 'both'?"),
        ({"affix": "x"}, "affix 'x' is not known, use one of postfix, prefix"),
        ({"topics": "x"}, "topics 'x' is not known, use one of postfix, prefix, namespace"),
        ({"groups": "x"}, "groups 'x' is not known, use one of keep, rename"),
        ({"separators": {"link": "+"}}, "separator link='+': use one of / _ __ - ."),
        ({"separators": {"node": "/"}}, "separator node='/': use one of _"),
        ({"separators": {"topic": "-"}}, "separator topic='-': use one of / _"),
        ({"separators": {"namespace": "_"}}, "separator namespace='_': use one of /"),
        ({"layout": "L5", "affix": "postfix"},
         "in layout frame-prefix nodes put robot1/ before frames: use affix: prefix"),
        ({"layout": "L5", "separators": {"frame": "_"}},
         "in layout frame-prefix nodes put robot1/ before frames: use frame=/"),
        ({"layout": "L5", "separators": {"link": "_"}},
         "in layout frame-prefix nodes put robot1/ before frames: use frame=/"),
        ({"separators": {"jiont": "_"}}, "separator kind 'jiont' is not known, use one of"
         f" {', '.join(SEPARATORS)}; did you mean 'joint'?"),
    ],
)  # fmt: skip
def test_a_policy_that_is_none_is_said(words: dict[str, object], said: str) -> None:
    with pytest.raises(UsageError) as caught:
        make_naming(**words)  # type: ignore[arg-type]
    assert str(caught.value) == said


AFTER, BEFORE, L2, L1 = (
    make_naming("L4"), make_naming("L4", "prefix"), make_naming("L2", "prefix"), make_naming("L1")
)  # fmt: skip


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("naming", "kind", "text", "reached", "new"),
    [
        (AFTER, "link", "base", False, "base/r"), (BEFORE, "link", "base", False, "r/base"),
        (BEFORE, "link", "/base", False, "/r/base"), (L1, "link", "base", False, "base"),
        (AFTER, "joint", "j", False, "j_r"), (AFTER, "frame", "map", False, "map"),
        (AFTER, "link", "/map", False, "/map"), (AFTER, "joint", "map", False, "map_r"),
        (AFTER, "unknown", "x", False, "x"), (AFTER, "node", "n", False, "n_r"),
        (L2, "node", "n", False, "n"),
        # Topics.
        (AFTER, "topic", "scan", False, "scan/r"), (AFTER, "topic", "/scan", True, "/scan/r"),
        (BEFORE, "topic", "/scan", False, "/r/scan"), (BEFORE, "topic", "scan", False, "r/scan"),
        (L2, "topic", "scan", False, "r/scan"), (L2, "topic", "scan", True, "scan"),
        (L2, "topic", "/scan", True, "/r/scan"), (AFTER, "subtopic", "scan", False, "scan"),
        (AFTER, "subtopic", "/scan", False, "/scan/r"), (AFTER, "service", "s", False, "s/r"),
        (AFTER, "topic", "/clock", False, "/clock"), (L2, "topic", "tf", False, "tf"),
        (AFTER, "topic", "tf", False, "tf/r"), (AFTER, "topic", "~/x", False, "~/x"),
        (AFTER, "topic", "__x", False, "__x"), (AFTER, "topic", "/", False, "/"),
        (AFTER, "topic", "a/", False, "a/"), (AFTER, "topic", "a b", False, "a b"),
        (AFTER, "topic", "/world/w/set_pose", False, "/world/w/set_pose"),
        # Stems and namespaces.
        (AFTER, "stem", "cam", False, "cam_r"), (BEFORE, "stem", "cam", False, "r_cam"),
        (L2, "stem", "cam", True, "cam"), (L2, "stem", "/cam", True, "/r/cam"),
        (L2, "stem", "cam", False, "r_cam"), (L2, "namespace", "/a", False, "/r/a"),
        (L2, "namespace", "a", False, "r/a"), (L2, "namespace", "", False, "r"),
        (L2, "namespace", "/", False, "/r"), (L2, "namespace", "${a}", False, "${a}"),
        (AFTER, "namespace", "/a", False, "/a"),
        # The kinds of a description, and what is everybody's.
        (AFTER, "frame", "odom", False, "odom/r"), (AFTER, "hardware", "s", False, "s_r"),
        (AFTER, "model", "rover", False, "rover_r"), (AFTER, "link", "a b", False, "a b/r"),
        (AFTER, "link", "", False, "/r"), (AFTER, "link", "world", False, "world"),
        (AFTER, "topic", "clock", False, "clock"), (AFTER, "topic", "", False, ""),
        (AFTER, "topic", "{n}/scan", False, "{n}/scan"), (L1, "topic", "/tf", False, "/r/tf"),
        (AFTER, "topic", "$(env N)/scan", False, "$(env N)/scan"),
    ],
)  # fmt: skip
def test_a_name_for_a_robot(naming: Naming, kind: str, text: str, reached: bool, new: str) -> None:
    assert spelled(naming, "r", kind, text, reached) == new
    there = removal(naming, "r", kind, new, reached)
    if new == text:
        assert there is None
    else:
        assert there is not None and new[: there[0]] + new[there[1] :] == text


@pytest.mark.parametrize(
    ("naming", "kind", "text"),
    [
        (AFTER, "link", "base"), (AFTER, "link", "r/base"), (BEFORE, "link", "base/r"),
        (AFTER, "link", "base_r"), (L1, "link", "base/r"), (AFTER, "topic", "clock"),
        (AFTER, "link", "base/rr"),
    ],
)  # fmt: skip
def test_what_nobody_put_there_is_not_taken_away(naming: Naming, kind: str, text: str) -> None:
    assert removal(naming, "r", kind, text) is None


def test_names_that_an_argument_spells() -> None:
    own = {("link", "arm_base"): Affix(0, "", "_"), ("link", "fixed"): None}
    naming = AFTER._replace(own=own)
    assert spelled(naming, "r", "link", "arm_base") == "r_arm_base"
    assert spelled(naming, "r", "link", "fixed") == "fixed"
    assert spelled(naming, "r", "link", "other") == "other/r"
    assert removal(naming, "r", "link", "r_arm_base") == (0, 2)
    assert removal(naming, "r", "link", "fixed") is None
    assert removal(naming, "r", "joint", "r_arm_base") is None


@pytest.mark.parametrize(
    ("topic", "it_is"),
    [("/world/w/set_pose", True), ("/world/w", False), ("/world/w/model/m/x", False),
     ("world/w/x", False), ("/a/w/x", False), ("/world/w/models", True)],
)  # fmt: skip
def test_topics_of_a_world(topic: str, it_is: bool) -> None:
    assert is_of_world(topic) is it_is


@pytest.mark.parametrize(
    ("text", "it_is"),
    [
        ("__model__", True),
        ("____", True),
        ("___", False),
        ("__a", False),
        ("a__", False),
        ("__model", False),
        ("_model_", False),
    ],
)
def test_words_that_sdf_reserves(text: str, it_is: bool) -> None:
    assert is_keyword(text) is it_is


def test_robots_whose_names_may_meet() -> None:
    assert overlap(make_naming("L4"), ["b", "left_b", "c"]) == [("left_b", "b", "_")]
    assert overlap(make_naming("L4"), ["left", "left_b"]) == []
    assert overlap(make_naming("L4", "prefix"), ["left", "left_b"]) == [("left_b", "left", "_")]
    assert overlap(make_naming("L2"), ["left", "left_b", "b"]) == [
        ("left_b", "b", "_"), ("left_b", "left", "_"),
    ]  # fmt: skip
    assert overlap(make_naming("L4"), ["b", "leftb", "left_B", "b"]) == []
    assert overlap(make_naming("L4"), ["x_y_z", "z", "y_z"]) == [
        ("x_y_z", "y_z", "_"), ("x_y_z", "z", "_"), ("y_z", "z", "_"),
    ]  # fmt: skip


@pytest.mark.parametrize("name", ["box", "/box", "box/", "x"])
def test_a_shared_frame_is_one_whatever_slashes_it_has(name: str) -> None:
    naming = make_naming("L4", shared_frames=["box", "x"])
    assert spelled(naming, "r1", "frame", name) == spelled(naming, "r1", "link", name) == name
    assert spelled(naming, "r1", "joint", "box") == "box_r1"
    assert spelled(naming, "r1", "frame", "bo") == "bo/r1"
