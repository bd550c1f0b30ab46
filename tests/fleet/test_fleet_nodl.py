# SPDX-License-Identifier: Apache-2.0
"""A fleet file that names NoDL documents: the build's plan has what they say, errors have a line."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import FIXTURES
from plans import ends_of

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.planning.plan import read_plan
from multibot_rewrite.system.records import surely

QOS = "qos: {history: KEEP_ALL, reliability: RELIABLE}"
DOCUMENT = (
    f"nodl_version: 2\npublishers:\n  - {{name: /brand_new, type: acme_msgs/msg/New, {QOS}}}\n"
)


def fleet(folder: Path, nodl: str = "interfaces", document: str = DOCUMENT, more: str = "") -> str:
    (folder / "interfaces").mkdir()
    (folder / "interfaces" / "nav2_amcl__amcl.nodl.yaml").write_text(document)
    (folder / "fleet.yaml").write_text(
        f"description: {FIXTURES / 'robots' / 'rover.urdf'}\n"
        f"layout: tf-per-robot\nnode_sets: amcl\nnodl: {nodl}\n{more}"
        "robots: [{name: robot1}, {name: robot2}]\n"
    )
    return str(folder / "fleet.yaml")


def planned(folder: Path) -> dict[str, str]:
    plan = read_plan((folder / "out" / "plan.yaml").read_bytes(), "plan.yaml")
    return {it.name: it.type for it in ends_of(surely(plan), "/robot1/amcl")}


@pytest.mark.more
def test_a_build_plans_what_the_document_says(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["build", fleet(tmp_path), "-o", str(tmp_path / "out")]) == 0
    assert f"amcl as in {tmp_path}/interfaces/nav2_amcl__amcl" in capsys.readouterr().err
    found = planned(tmp_path)
    assert found["/robot1/brand_new"] == "acme_msgs/msg/New"
    assert "/robot1/particle_cloud" not in found
    table = (tmp_path / "out" / "remappings.yaml").read_text()
    assert "[/brand_new, brand_new]" in table


@pytest.mark.more
def test_a_build_with_none_plans_what_is_built_in(tmp_path: Path) -> None:
    assert main(["build", fleet(tmp_path, "none"), "-o", str(tmp_path / "out")]) == 0
    found = planned(tmp_path)
    assert "/robot1/particle_cloud" in found
    assert "/robot1/brand_new" not in found


@pytest.mark.more
def test_a_parameter_file_does_not_take_a_document_away(tmp_path: Path) -> None:
    params = tmp_path / "params.yaml"
    params.write_text(
        "amcl:\n  ros__parameters:\n    scan_topic: laser\n    base_frame_id: base_link\n"
    )
    file = fleet(tmp_path, more="related_files: {params: params.yaml}\n")
    assert main(["build", file, "-o", str(tmp_path / "out")]) == 0
    found = planned(tmp_path)
    assert found["/robot1/brand_new"] == "acme_msgs/msg/New"
    assert "/robot1/laser" in found


@pytest.mark.more
def test_a_node_that_a_parameter_file_alone_names_has_its_document(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    params = tmp_path / "params.yaml"
    params.write_text("amcl:\n  ros__parameters:\n    base_frame_id: base_link\n")
    file = Path(fleet(tmp_path, more="related_files: {params: params.yaml}\n"))
    file.write_text(file.read_text().replace("node_sets: amcl\n", ""))
    assert main(["build", str(file), "-o", str(tmp_path / "out")]) == 0
    assert "amcl as in" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("nodl", "document", "place"),
    [
        ("missing", DOCUMENT, "fleet.yaml:4: "),
        ("interfaces", "nodl_version: 1\n", "nav2_amcl__amcl.nodl.yaml:1: "),
    ],
)
def test_what_is_wrong_has_a_line(
    nodl: str, document: str, place: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["build", fleet(tmp_path, nodl, document), "-o", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert place in error
    assert error.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.more
def test_the_plan_is_the_same_from_every_working_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fleet(tmp_path)
    texts = []
    for place, file in ((tmp_path, "fleet.yaml"), (tmp_path / "interfaces", "../fleet.yaml")):
        monkeypatch.chdir(place)
        out = tmp_path / f"out{len(texts)}"
        assert main(["build", file, "-o", str(out)]) == 0
        texts.append((out / "plan.yaml").read_text())
    assert texts[0] == texts[1]
