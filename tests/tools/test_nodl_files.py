# SPDX-License-Identifier: Apache-2.0
"""NoDL documents written from sources: what they have, and that the published schema takes them."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from nodl_schema_file import nodl_validator
from paths import FIXTURES

from multibot_rewrite.base.model import UsageError
from tools.interfaces.__main__ import main
from tools.interfaces.nodl_files import nodl_of
from tools.interfaces.table import Fact, from_table, read_packed


def facts() -> tuple[Fact, ...]:
    return from_table(read_packed(FIXTURES / "interfaces" / "jazzy.tsv.xz"))


def test_a_document_has_what_the_sources_say() -> None:
    """navigation2 jazzy nav2_amcl/src/amcl_node.cpp; collision_monitor_node.cpp."""
    made = yaml.safe_load(nodl_of("amcl", facts()).text)
    assert made["nodl_version"] == 2
    assert {"amcl_pose", "particle_cloud", "/tf"} <= {it["name"] for it in made["publishers"]}
    servers = {it["name"]: it["type"] for it in made["service_servers"]}
    assert servers["request_nomotion_update"] == "std_srvs/srv/Empty"


def test_a_condition_is_told_and_what_has_no_form_is_left_out() -> None:
    made = nodl_of("behavior_server", facts())
    entries = yaml.safe_load(made.text)["publishers"]
    cmd_vel = [it for it in entries if it["name"] == "cmd_vel"]
    assert len(cmd_vel) == 2
    assert all(it["description"].startswith("only if: ") for it in cmd_vel)
    assert "serves <name>" in made.left_out


def test_an_unknown_node_is_an_error_of_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "acme@1"
    folder.mkdir()
    assert main([str(folder), "--nodl", "amcl"]) == 2
    assert "amcl: these sources have no such node" in capsys.readouterr().err
    with pytest.raises(UsageError):
        nodl_of("nobody", facts())


def test_every_document_fits_the_schema() -> None:
    validator = nodl_validator()
    for node in dict.fromkeys(it.node for it in facts()):
        document = yaml.safe_load(nodl_of(node, facts()).text)
        assert list(validator.iter_errors(document)) == [], node
