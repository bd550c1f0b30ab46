# SPDX-License-Identifier: Apache-2.0
"""What descriptions are called, which act, and which two are of one robot; by hand."""

from __future__ import annotations

import pytest
from lxml import etree

from multibot_rewrite.proposal import choosing
from multibot_rewrite.proposal.looking import Looked


@pytest.mark.parametrize(
    ("path", "stem", "model"),
    [
        ("a/r.urdf.xacro", "r", False), ("sdf/r.urdf", "r", False), ("x500/model.sdf", "x500", True),
        ("a/model.sdf.xacro", "a", True), ("x500/model (1).sdf", "x500", True),
        ("x500/model copy.sdf", "x500", True), ("x500/models.sdf", "models", True),
        ("a/r.model", "r", True),
    ],
)  # fmt: skip
def test_a_model_is_called_by_its_folder(path: str, stem: str, model: bool) -> None:
    assert (choosing._stem(path), choosing.is_model(path)) == (stem, model)


def looked(tag: str, inside: str = "", path: str = "a.urdf", links: int = 1) -> Looked:
    made = "".join(f'<link name="l{at}"/>' for at in range(links))
    root = etree.fromstring(f"<{tag}>{made}{inside}</{tag}>")
    return Looked(path, tag=tag, links=links, root=root)


@pytest.mark.parametrize(
    ("it", "does"),
    [
        (looked("robot"), True),
        (looked("sdf"), False),
        (looked("sdf", links=2), True),
        (looked("sdf", '<joint name="j" type="revolute"/>'), True),
        (looked("sdf", '<joint name="j" type="fixed"/><joint name="k"/>'), False),
        (looked("sdf", '<joint type="revolute"/>'), False),
        (looked("sdf", "<sensor/>"), True),
        (Looked("a.sdf", tag="sdf"), False),
    ],
)
def test_a_thing_does_not_act(it: Looked, does: bool) -> None:
    assert choosing.acts(it) is does


def test_the_partner_has_half_of_the_links_and_is_of_another_kind() -> None:
    urdf = looked("robot", '<link name="robot1/x"/>', links=2)
    few, half, most = (looked("sdf", links=it) for it in (5, 4, 3))
    assert choosing.partner(urdf, [few, half]) is half
    assert choosing.partner(urdf, [few]) is None
    own = looked("sdf", '<link name="x"/>', links=3)._replace(links=4)
    assert choosing.partner(urdf, [most, own]) is own
    assert choosing.partner(urdf, [looked("robot", links=2), looked("sdf", links=0)]) is None


@pytest.mark.parametrize(
    ("name", "copy"),
    [
        ("r copy.urdf", True), ("r_copy.urdf", True), ("r (copy).urdf", True), ("r (1).urdf", True),
        ("r-copy.urdf", True), ("copyist.urdf", False), ("r1.urdf", False), ("r_copycat.urdf", False),
    ],
)  # fmt: skip
def test_a_copy_is_told_by_its_name(name: str, copy: bool) -> None:
    assert (choosing._COPY.search(name) is not None) is copy
