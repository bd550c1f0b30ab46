# SPDX-License-Identifier: Apache-2.0
"""What a name of each kind becomes for a robot, and how it is taken away again."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import (
    SEPARATORS,
    Naming,
    is_keyword,
    make_naming,
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
