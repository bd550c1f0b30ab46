# SPDX-License-Identifier: Apache-2.0
"""What rules look up in a system: ends by name, trees by topic, whose each of them is."""

from __future__ import annotations

from multibot_rewrite.system.index import (
    Tree,
    index,
)
from multibot_rewrite.system.ownership import ALONE
from multibot_rewrite.system.records import (
    OFF,
    PUBLISHES,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    System,
)

TF, TWIST, TEXT = "tf2_msgs/msg/TFMessage", "geometry_msgs/msg/Twist", "std_msgs/msg/String"


def end(node: str, role: str, name: str, type_: str = TEXT, kind: str = TOPIC) -> End:
    return End(kind, role, name, type_, "", node, None, "")


def test_transforms_are_in_trees_by_their_topic() -> None:
    def edge(child: str, topic: str, *nodes: str, parent: str = "odom") -> Edge:
        return Edge(child, parent, topic, False, nodes)

    system = System(
        ends=(
            end("/a/ekf", PUBLISHES, "/a/tf", TF),
            end("/a/rsp", PUBLISHES, "/a/tf_static", TF),
            end("/a/nav", SUBSCRIBES, "/a/tf", TF),
            end("/a/map", SUBSCRIBES, "/a/tf_static", TF),
            end("/b/nav", SUBSCRIBES, "/b/tf", TF),
            end("/c/nav", SUBSCRIBES, "/c/tf", TEXT),
        ),
        edges=(
            edge("/base", "/a/tf", "/a/driver", "/a/ekf"),
            edge("lidar", "/a/tf_static", parent="/base"),
            edge("x", "/_hidden/tf"),
            edge("y", "/a/tf")._replace(sure=OFF),
        ),
    )
    base, lidar = edge("base", "/a/tf", "/a/driver", "/a/ekf"), edge("lidar", "/a/tf_static")
    assert index(system, ALONE).trees == [
        Tree(
            "/a/tf",
            (base, lidar._replace(parent="base")),
            ("/a/ekf", "/a/rsp", "/a/driver"),
            ("/a/nav",),
        ),
        Tree("/b/tf", (), (), ("/b/nav",)),
    ]
