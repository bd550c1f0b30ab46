# SPDX-License-Identifier: Apache-2.0
"""What a name in a file beside a description becomes, by its kind and by the layout."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from made_params import DECLARED, L1, L2, L4, setting

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts, Param
from multibot_rewrite.related_files.context import (
    NAMESPACE_SLOT as SPACE,
    TAG_SLOT as TAG,
    Context,
    make_context,
)
from multibot_rewrite.related_files.names import by_kind
from multibot_rewrite.related_files.names.by_kind import SPELLERS
from multibot_rewrite.related_files.names.node_topics import TopicText, spell_topic
from multibot_rewrite.related_files.names.rename_map import related_file_names, with_srdf
from multibot_rewrite.related_files.params.shared_defaults import missing_defaults
from multibot_rewrite.related_files.sites import FROM_NODE, FROM_PARENT, IN_FULL
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC

L5, AFTER = ("L5", "prefix"), ("L2", "postfix")


@pytest.mark.parametrize(
    ("policy", "kind", "value", "new"),
    [
        (L2, "joint", "elbow", f"{TAG}_elbow"),
        (L1, "joint", "elbow", "elbow"),
        (AFTER, "joint", "elbow", f"elbow_{TAG}"),
        (L2, "joint", "other", "other"),
        (L2, "joint", "drive/elbow", f"drive/{TAG}_elbow"),
        (L4, "joint", "drive/elbow", f"drive_{SPACE}/elbow_{TAG}"),
        (L4, "joint", "a/imu_sensor/elbow", f"a_{SPACE}/imu_sensor_{TAG}/elbow_{TAG}"),
        (L4, "joint", "drive/other", "drive/other"),
        (L2, "interface", "elbow/position", f"{TAG}_elbow/position"),
        (L2, "interface", "position", "position"),
        (L4, "interface", "drive/elbow/position", f"drive_{SPACE}/elbow_{TAG}/position"),
        (L4, "interface", "drive/linear/velocity", f"drive_{SPACE}/linear/velocity"),
        (L4, "interface", "drive/a/elbow/position", f"drive_{SPACE}/a_{SPACE}/elbow_{TAG}/position"),
        (L2, "interface", "imu_sensor/x", f"{TAG}_imu_sensor/x"),
        # Descriptions do not declare all their gpios.
        (L2, "interface", "io/out", f"{TAG}_io/out"),
        (L1, "interface", "io/out", "io/out"),
        (L4, "controller", "drive", f"drive_{SPACE}"),
        (L2, "controller", "drive", "drive"),
        (L4, "controller", "<drive>", "<drive>"),
        (L4, "controller", "", ""),
        (L2, "component", "elbow", f"{TAG}_elbow"),
        (L2, "component", "laser", "laser"),
        (L2, "namespace", "/front", f"/{SPACE}/front"),
        (L2, "namespace", "front", "front"),
        (L4, "namespace", "/front", "/front"),
        (L2, "node", "amcl", "amcl"),
        (L2, "node", "/amcl", f"/{SPACE}/amcl"),
        (L4, "node", "amcl", f"amcl_{SPACE}"),
        (L4, "node", "/amcl", f"/amcl_{SPACE}"),
        (L4, "node", "front/amcl", f"front/amcl_{SPACE}"),
        (L2, "node", "front/amcl", "front/amcl"),
        (L2, "node", "/front/amcl", "/front/amcl"),
        (L2, "node", "/<x>", "/<x>"),
        # Its code places its costmap; the manager's bond knows it by its name.
        (L4, "node", "controller_server", "controller_server"),
        (L4, "node", "/controller_server", f"/{SPACE}/controller_server"),
        (L2, "stem", "cam", f"{TAG}/cam"),
        (AFTER, "stem", "cam", "cam"),
        (L2, "words", "joints(elbow, base_link,x)", f"joints({TAG}_elbow, {TAG}/base_link,x)"),
        (L2, "link_prefix", "", f"{TAG}/"),
        (L2, "link_prefix", "a_", f"{TAG}/a_"),
        (L2, "link_prefix", "<a>", "<a>"),
        (L1, "link_prefix", "a_", "a_"),
        (AFTER, "link_prefix", "a_", "a_"),
        (L2, "joint_prefix", "", f"{TAG}_"),
        (L2, "gpio_prefix", "x_", f"{TAG}_x_"),
        (L2, "joint_stem", "", TAG),
        (L2, "joint_stem", "left", f"{TAG}_left"),
        (AFTER, "joint_stem", "left", "left"),
        (L5, "doubles", "x", TAG),
        (L5, "doubles_as_is", "x", f"{TAG}/"),
        (L2, "doubles", "x", "x"),
        (L2, "doubles_as_is", "x", "x"),
        (L2, "frame", "base_link", f"{TAG}/base_link"),
        (L2, "frame", "map", "map"),
        (L2, "frame", "<base_link>", "<base_link>"),
        (L2, "frame", "$(var x)", "$(var x)"),
        (L5, "frame", "base_link", f"{TAG}/base_link"),
        (L5, "link", "base_link", "base_link"),
        (L2, "link", "base_link", f"{TAG}/base_link"),
        (L2, "sensor", "imu_sensor", f"{TAG}_imu_sensor"),
        (L2, "gpio", "io", f"{TAG}_io"),
        (L2, "hardware", "drive", f"{TAG}_drive"),
        (L2, "group", "", ""),
    ],
)  # fmt: skip
def test_a_name_of_each_kind(policy: tuple[str, str], kind: str, value: str, new: str) -> None:
    assert SPELLERS[kind](setting(policy), value) == new


def test_every_kind_is_tried() -> None:
    """knowledge/nodes: the words that a parameter's kind may be."""
    assert set(SPELLERS) == {
        "joint", "interface", "controller", "node", "namespace", "stem", "link_prefix",
        "joint_prefix", "gpio_prefix", "joint_stem", "doubles", "doubles_as_is", "component", "words",
        "frame", "link", "sensor", "gpio", "hardware", "group", "port", "output",
    }  # fmt: skip


def test_a_node_of_all_robots_keeps_its_name() -> None:
    for policy, told in ((L2, "/map_server"), (L4, "map_server")):
        shared = setting(policy)._replace(nodes={"map_server": "/map_server"})
        assert by_kind.node(shared, "map_server") == told


def test_an_argument_of_the_xacro_is_the_prefix() -> None:
    own = {("joint", "elbow"): "left_elbow", ("link", "laser"): "laser"}
    context = setting(L2)
    context = context._replace(names=context.names._replace(own=own))
    found = [SPELLERS["joint_prefix"](context, it) for it in ("", "left_", "x_")]
    assert found == ["left_", "left_", "left_x_"]
    assert SPELLERS["link_prefix"](context, "") == f"{TAG}/"
    assert SPELLERS["joint"](context, "elbow") == "left_elbow"


def test_what_arguments_make_is_declared_by_either_text() -> None:
    declared = {"joint": {"left_A1": "here"}, "link": {}}
    naming = make_naming("L2", "prefix")
    own = {("joint", "lbr_A1"): "left_A1", ("topic", "/imu"): "left/imu"}
    names = related_file_names(declared, naming, "left", own)  # type: ignore[arg-type]
    assert names.declared["joint"] == {"left_A1": "here", "lbr_A1": "here", "A1": "here"}
    assert names.own == {
        ("joint", "lbr_A1"): "left_A1", ("joint", "A1"): "left_A1",
        ("topic", "/imu"): "left/imu", ("topic", "imu"): "left/imu",
    }  # fmt: skip
    both = with_srdf(
        {"link": {"a": 1}, "joint": {"j": 1}},
        {"group": {"arm": 2}, "joint": {"v": 2}, "link": {"x": 2}},
    )  # type: ignore[dict-item]
    assert both == {"link": {"a": 1}, "joint": {"j": 1, "v": 2}, "group": {"arm": 2}}


# ---------------------------------------------------------------- topics


NODE = NodeFacts(
    "driver", "driver",
    (Endpoint(TOPIC, SUBSCRIBES, "/scan"), Endpoint(TOPIC, PUBLISHES, "odom")),
)  # fmt: skip
APART = NODE._replace(name="costmap/costmap", apart=True)


def around(policy: tuple[str, str], *nodes: NodeFacts) -> Context:
    return make_context(DECLARED, make_naming(*policy), nodes or (NODE,), "jazzy")  # type: ignore[arg-type]


def topic(
    policy: tuple[str, str], value: str, reach: str = FROM_NODE, node: NodeFacts = NODE,
    kind: str = "topic",
) -> TopicText:  # fmt: skip
    return spell_topic(
        around(policy, NODE, APART), node.name, kind, value, reach, {node.name: node}
    )


@pytest.mark.parametrize(
    ("policy", "value", "reach", "text"),
    [
        (L2, "other", FROM_NODE, "other"),
        (L2, "/other", FROM_NODE, f"/{SPACE}/other"),
        (L4, "other", FROM_NODE, f"other/{SPACE}"),
        (L4, "/other", FROM_NODE, f"/other/{SPACE}"),
        (L2, "~/own", FROM_NODE, "~/own"),
        (L2, "<x>", FROM_NODE, "<x>"),
        (L2, "a//b", FROM_NODE, "a//b"),
        (L2, "", FROM_NODE, ""),
        # What all share.
        (L2, "/diagnostics", FROM_NODE, "/diagnostics"),
        (L2, "diagnostics", FROM_NODE, "/diagnostics"),
        (L4, "diagnostics", FROM_NODE, "diagnostics"),
        (L4, "diagnostics", IN_FULL, "/diagnostics"),
        # Outside of the robot's namespace only a full name is right.
        (L2, "other", IN_FULL, f"/{SPACE}/other"),
        (L4, "other", IN_FULL, f"/other/{SPACE}"),
        (L4, "other", FROM_PARENT, f"/other/{SPACE}"),
        (L2, "other", FROM_PARENT, "other"),
        # What is below another node's name follows that node.
        (L4, "/driver/reset", FROM_NODE, f"/driver_{SPACE}/reset"),
        (L4, "driver/reset", FROM_NODE, f"driver_{SPACE}/reset"),
        (L2, "/driver/reset", FROM_NODE, f"/{SPACE}/driver/reset"),
    ],
)
def test_a_topic_of_a_parameter(policy: tuple[str, str], value: str, reach: str, text: str) -> None:
    assert topic(policy, value, reach) == TopicText(
        text, made_absolute=reach == IN_FULL and not value.startswith("/")
    )


# What a default of a kind becomes with a prefix and with a postfix; None where no line is written.
DEFAULTS: dict[tuple[str, str], tuple[str | None, str | None]] = {
    ("frame", "odom"): (f"{TAG}/odom", f"odom/{TAG}"), ("frame", "map"): (None, None),
    ("link", "base_link"): (f"{TAG}/base_link", f"base_link/{TAG}"),
    ("link", "nowhere"): (None, None),
    ("stem", "tag"): (f"{TAG}/tag", None),
    ("interface", "elbow/position"): (f"{TAG}_elbow/position", f"elbow_{TAG}/position"),
    ("joint_prefix", ""): (f"{TAG}_", None), ("gpio_prefix", ""): (f"{TAG}_", None),
    ("joint_stem", ""): (TAG, None),
    ("off", "true"): ("false", "false"), ("no_prefix", ""): ("/", "/"),
    **{(it, "scan"): (None, None) for it in ("topic", "output", "service", "namespace", "group")},
}  # fmt: skip


@pytest.mark.parametrize(("kind", "default"), DEFAULTS)
def test_a_default_that_robots_would_share_is_written_out(kind: str, default: str) -> None:
    """A stem and a prefix stand in front: a postfix has no place for them."""
    node = SimpleNamespace(name="n", defaults=(Param("p", kind, default),))
    shared = "# multibot: the default is every robot's"
    off = "# multibot: the default puts the namespace before frames"
    comment = off if kind in ("off", "no_prefix") else shared
    for policy, value in zip((L2, L4), DEFAULTS[kind, default], strict=True):
        found = [*missing_defaults(setting(policy), node, set())]  # type: ignore[arg-type]
        assert found == ([] if value is None else [(comment, "p", value)])
        assert [*missing_defaults(setting(policy), node, {"p"})] == []  # type: ignore[arg-type]
