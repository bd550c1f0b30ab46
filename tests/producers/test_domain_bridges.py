# SPDX-License-Identifier: Apache-2.0
"""What a launched domain_bridge has in each domain.

Expectations: ros2/domain_bridge c2523e1, process_cmd_line_arguments.hpp,
parse_domain_bridge_yaml_config.cpp and domain_bridge.cpp (get_node_for_domain, bridge_topic,
add_bridges).
"""

from __future__ import annotations

from pathlib import Path

import pytest
from launched_nodes import AT

from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.launch.bridges import BridgedDomains, bridged_domains
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES

FILE = """\
name: bridge
from_domain: 2
to_domain: 3
topics:
  chatter: {type: std_msgs/msg/String}
  /back: {type: std_msgs/msg/String, reversed: true, remap: /forth}
  other: {type: std_msgs/msg/String, from_domain: 4, to_domain: 5, bidirectional: true}
"""


def bridged(*arguments: str, program: str = "domain_bridge/domain_bridge") -> BridgedDomains:
    run = Run("", "n", "/r", "n", (), program=program, arguments=arguments, place=AT)
    return bridged_domains([run])


def ends(found: BridgedDomains) -> set[tuple[str, str, str]]:
    return {(it.node, it.role, it.name) for it in found.ends}


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "bridge.yaml"
    path.write_text(FILE)
    return str(path)


def test_each_topic_is_read_in_one_domain_and_sent_in_the_other(file: str) -> None:
    found = bridged(file, "--wait-for-subscription", "true")
    assert ends(found) == {
        ("/bridge_2", SUBSCRIBES, "/chatter"),
        ("/bridge_3", PUBLISHES, "/chatter"),
        ("/bridge_3", SUBSCRIBES, "/back"),
        ("/bridge_2", PUBLISHES, "/forth"),
        ("/bridge_4", SUBSCRIBES, "/other"),
        ("/bridge_5", PUBLISHES, "/other"),
        ("/bridge_5", SUBSCRIBES, "/other"),
        ("/bridge_4", PUBLISHES, "/other"),
    }
    assert [it.name for it in found.nodes] == [f"/bridge_{it}" for it in (2, 3, 4, 5)]
    assert {it.type for it in found.ends} == {"std_msgs/msg/String"}
    assert found.notes == ()


def test_options_hold_for_all_topics(file: str) -> None:
    found = bridged("--from", "7", file, "--to", "8")
    assert {it.name for it in found.nodes} == {"/bridge_7", "/bridge_8"}
    assert ("/bridge_8", SUBSCRIBES, "/back") in ends(found)


@pytest.mark.parametrize(
    "row",
    [
        "{type: a/msg/B, from_domain: 2}",
        "{type: a/msg/B, from_domain: 2, to_domain: 2}",
        "{type: a/msg/B, from_domain: two, to_domain: 3}",
        "[]",
    ],
)
def test_what_is_not_bridged_makes_no_node(row: str, tmp_path: Path) -> None:
    path = tmp_path / "bridge.yaml"
    path.write_text(f"topics: {{/x: {row}}}\n")
    assert bridged(str(path)) == BridgedDomains((), (), ())
