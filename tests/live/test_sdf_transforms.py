# SPDX-License-Identifier: Apache-2.0
"""The transforms of an SDF: its frames are no part of tf, the links that they are attached to are."""

from __future__ import annotations

from description_calls import NEWEST_LTS, Inventory, builtin_tree, collect, edges_in, read_document
from paths import FIXTURES

from multibot_rewrite.system.records import edge_of

JOINT = '<joint name="j" type="fixed"><parent>{}</parent><child>tool</child></joint>'
MODEL = (
    '<sdf version="1.9"><model name="m"><link name="base"/><link name="tool"/>'
    '<frame name="first" attached_to="base"/><frame name="second" attached_to="first"/>'
    '<frame name="free"/><frame name="round" attached_to="about"/>'
    '<frame name="about" attached_to="round"/>{}</model></sdf>'
)


def inventory(data: bytes) -> Inventory:
    return collect(read_document(data, "robot.sdf"), builtin_tree((), NEWEST_LTS))


def parent(name: str) -> str:
    (edge,) = edges_in(inventory(MODEL.format(JOINT.format(name)).encode()).document.root)
    return edge.parent


def test_a_frame_is_the_link_that_it_is_attached_to() -> None:
    assert parent("base") == parent("first") == parent("second") == "base"


def test_a_frame_without_a_link_stays() -> None:
    assert parent("free") == "free"
    assert parent("round") in ("round", "about")


def test_the_tree_of_the_rover_has_one_root() -> None:
    edges = list(
        edges_in(inventory((FIXTURES / "robots" / "rover.sdf").read_bytes()).document.root)
    )
    assert edge_of("base_link", "head::base_link", True) in edges
    assert {it.parent for it in edges} == {"base_link"}
