# SPDX-License-Identifier: Apache-2.0
"""Liveliness tokens as rmw_zenoh writes them, by hand from its source, and what they announce.

The examples of docs/design.md in ros2/rmw_zenoh are among them, word for word.
"""

from __future__ import annotations

from math import inf

import pytest
from hypothesis import given, strategies as st

from multibot_rewrite.producers.zenoh.tokens import endpoints, nodes, read_qos, read_token, ros_type
from multibot_rewrite.system.records import End, Node, Qos

STRING = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
ADD = "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"
SESSION = "aac3178e146ba6f1fc6e6a4085e77f21"
LISTENER = f"@ros2_lv/2/{SESSION}/0/0/NN/%/%/listener"
SUBSCRIPTION = (
    f"@ros2_lv/2/{SESSION}/0/10/MS/%/%/listener/%chatter/std_msgs::msg::dds_::String_/{STRING}"
    "/::,10:,:,:,,"
)
SERVER = (
    "@ros2_lv/2/f9980ee0495eaafb3e38f0d19e2eae12/0/10/SS/%/%/add_two_ints_server/%add_two_ints/"
    f"example_interfaces::srv::dds_::AddTwoInts_/{ADD}/::,10:,:,:,,"
)
# qos.cpp: reliable, volatile, keep last 42, nothing limited.
DEFAULT = Qos("KEEP_LAST", 42, "RELIABLE", "VOLATILE", inf, inf, "AUTOMATIC", inf)


def test_the_node_of_the_design_page() -> None:
    token = read_token(LISTENER)
    assert token is not None and token.end is None
    assert (token.domain, token.session, token.node_id) == (2, SESSION, "0")
    assert (token.node, token.enclave) == ("/listener", "/")


def test_the_subscription_of_the_design_page() -> None:
    token = read_token(SUBSCRIPTION)
    assert token is not None
    qos = DEFAULT._replace(depth=10)
    assert token.end == End(
        *("topic", "subscribes", "/chatter", "std_msgs/msg/String", STRING),
        *("/listener", qos, SESSION),
    )


def test_the_service_of_the_design_page() -> None:
    token = read_token(SERVER)
    assert token is not None and token.end is not None
    assert token.end[:5] == (
        *("service", "serves", "/add_two_ints", "example_interfaces/srv/AddTwoInts", ADD),
    )


@pytest.mark.parametrize(
    ("kind", "expected"),
    [
        ("MP", ("topic", "publishes")),
        ("MS", ("topic", "subscribes")),
        ("SS", ("service", "serves")),
        ("SC", ("service", "calls")),
    ],
)
def test_the_kinds_of_endpoints(kind: str, expected: tuple[str, str]) -> None:
    token = read_token(SUBSCRIPTION.replace("/MS/", f"/{kind}/"))
    assert token is not None and token.end is not None
    assert token.end[:2] == expected


def test_slashes_of_enclave_namespace_and_topic_are_percent_signs() -> None:
    token = read_token(
        "@ros2_lv/0/ab/3/4/MP/%fleet%robot1/%fleet_a%robot1/drive/%fleet_a%robot1%odom/"
        f"nav_msgs::msg::dds_::Odometry_/{STRING}/::,:,:,:,,"
    )
    assert token is not None and token.end is not None
    assert (token.enclave, token.node) == ("/fleet/robot1", "/fleet_a/robot1/drive")
    assert (token.end.name, token.end.node) == ("/fleet_a/robot1/odom", "/fleet_a/robot1/drive")


def test_humble_has_no_hash() -> None:
    """Its rmw_zenoh writes this word, and the token is a good one."""
    token = read_token(SUBSCRIPTION.replace(STRING, "TypeHashNotSupported"))
    assert token is not None and token.end is not None
    assert token.end.type_hash == ""


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("::,:,:,:,,", DEFAULT),
        # liveliness_utils.hpp, where every field is written.
        (
            "1:2:1,10:5,0:60,3000:1,0,0",
            Qos("KEEP_LAST", 10, "RELIABLE", "VOLATILE", 5.0, 60.000003, "AUTOMATIC", inf),
        ),
        ("2:1:2,10:,:,:,,", DEFAULT._replace(
            history="KEEP_ALL", depth=10, reliability="BEST_EFFORT", durability="TRANSIENT_LOCAL"
        )),
        ("::,:,:,:3,1,500000000", DEFAULT._replace(
            liveliness="MANUAL_BY_TOPIC", liveliness_lease_duration=1.5
        )),
        # RMW_DURATION_INFINITE in full.
        ("::,:9223372036,854775807:,:,,", DEFAULT),
        # 0 is "not set" in rmw.
        ("::,:0,0:0,0:,0,0", DEFAULT),
    ],
)  # fmt: skip
def test_qos(text: str, expected: Qos) -> None:
    assert read_qos(text) == expected


# rmw types.h, by number: reliability, durability, history, liveliness.
WORDS = {
    "{}::,:,:,:,,": ("SYSTEM_DEFAULT", "RELIABLE", "BEST_EFFORT", "UNKNOWN", "BEST_AVAILABLE"),
    ":{}:,:,:,:,,": ("SYSTEM_DEFAULT", "TRANSIENT_LOCAL", "VOLATILE", "UNKNOWN", "BEST_AVAILABLE"),
    "::{},:,:,:,,": ("SYSTEM_DEFAULT", "KEEP_LAST", "KEEP_ALL", "UNKNOWN"),
    "::,:,:,:{},,": (
        *("SYSTEM_DEFAULT", "AUTOMATIC", "MANUAL_BY_NODE", "MANUAL_BY_TOPIC", "UNKNOWN"),
        "BEST_AVAILABLE",
    ),
}


@pytest.mark.parametrize(("text", "field"), [*zip(WORDS, (2, 3, 0, 6), strict=True)])
def test_the_words_of_a_profile_are_those_of_rmw_by_number(text: str, field: int) -> None:
    for number, word in enumerate(WORDS[text]):
        found = read_qos(text.format(number))
        assert found[field] == word
        assert (*found[:field], *found[field + 1 :]) == (*DEFAULT[:field], *DEFAULT[field + 1 :])
    assert read_token(SUBSCRIPTION.replace("::,10:,:,:,,", text.format(len(WORDS[text])))) is None


@pytest.mark.parametrize(
    ("text", "seconds"),
    [("0,500000000", 0.5), ("2,0", 2.0), ("9223372036,0", inf), ("1,", 1.854775807)],
)
def test_the_times_of_a_profile(text: str, seconds: float) -> None:
    assert read_qos(f"::,:{text}:,:,,").deadline == seconds
    assert read_qos(f"::,:,:{text}:,,").lifespan == seconds
    assert read_qos(f"::,:,:,:,{text}").liveliness_lease_duration == seconds


@pytest.mark.parametrize(
    "key",
    [
        "",
        "@ros2_lv",
        "@ros2_lv/2/ab/0/0/NN/%/%",
        LISTENER.replace("@ros2_lv", "@ros_lv"),
        LISTENER.replace("/NN/", "/XX/"),
        LISTENER.replace("/2/", "/two/"),
        LISTENER.replace("/2/", "/-2/"),
        LISTENER.replace("/2/", f"/{'9' * 5000}/"),
        LISTENER.replace("/%/%/", "//%/"),
        LISTENER.replace("/%/%/", "/%/robot1/"),
        SUBSCRIPTION.rpartition("/")[0],
        SUBSCRIPTION.replace("/%chatter/", "/chatter/"),
        SUBSCRIPTION.replace("::,10:,:,:,,", "::"),
        SUBSCRIPTION.replace("::,10:,:,:,,", "::10:,:,:,,"),
        SUBSCRIPTION.replace("::,10:,:,:,,", "9::,10:,:,:,,"),
        SUBSCRIPTION.replace("::,10:,:,:,,", "::,ten:,:,:,,"),
        SUBSCRIPTION.replace("::,10:,:,:,,", "::,10:,:,:,²,"),
    ],
)
def test_what_is_no_token_is_left_out(key: str) -> None:
    assert read_token(key) is None


@pytest.mark.slow
@given(st.text("@ros2_lv/%NMPSC0123456789:,ab²\n", max_size=80))
def test_no_text_breaks_the_reader(text: str) -> None:
    for key in (text, f"{LISTENER}{text}", f"{SUBSCRIPTION}{text}", f"@ros2_lv/0/{text}"):
        token = read_token(key)
        assert token is None or token.node.startswith("/")


def test_a_type_that_is_none_of_ros_stays() -> None:
    assert ros_type("std_msgs::msg::dds_::String_") == "std_msgs/msg/String"
    assert ros_type("std_msgs::msg::dds_::String") == "std_msgs::msg::dds_::String"
    assert ros_type("my::Type_") == "my::Type_"


def test_nodes_of_one_name_are_as_many_as_sessions_and_ids() -> None:
    """One process may have two nodes of one name, two processes as well."""
    keys = [
        LISTENER,
        SUBSCRIPTION,
        LISTENER.replace("/0/0/", "/1/1/"),
        LISTENER.replace("aac", "b"),
    ]
    found = nodes([token for key in keys if (token := read_token(key))])
    other = SESSION.replace("aac", "b")
    assert found == [
        Node("/listener", SESSION),
        Node("/listener", SESSION),
        Node("/listener", other),
    ]


def test_the_enclave_of_a_node_and_none() -> None:
    inside = read_token(LISTENER.replace("/NN/%/", "/NN/%robot1/"))
    outside = read_token(LISTENER)
    assert inside is not None and outside is not None
    assert [it.enclave for it in nodes([inside])] == ["/robot1"]
    assert [it.enclave for it in nodes([outside])] == [""]


def test_a_node_is_there_once_its_endpoint_is() -> None:
    token = read_token(SUBSCRIPTION)
    assert token is not None
    assert nodes([token]) == [Node("/listener", SESSION)]


@pytest.mark.parametrize(("kind", "role"), [("MP", "serves"), ("MS", "calls")])
def test_an_action_is_known_by_its_feedback(kind: str, role: str) -> None:
    key = (
        f"@ros2_lv/0/ab/0/7/{kind}/%/%robot1/nav/%robot1%go%_action%feedback/"
        f"nav2_msgs::action::dds_::NavigateToPose_FeedbackMessage_/{STRING}/::,10:,:,:,,"
    )
    token = read_token(key)
    assert token is not None
    action, topic = endpoints([token])
    assert action[:6] == (
        *("action", role, "/robot1/go", "nav2_msgs/action/NavigateToPose", "", "/robot1/nav"),
    )
    assert topic.name == "/robot1/go/_action/feedback"
