# SPDX-License-Identifier: Apache-2.0
"""What a command writes and reads only if it was named: links of an output, what a fleet file names."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from subprocess import run

import pytest

from multibot_rewrite.base import workers
from multibot_rewrite.base.child import python
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.cli.walk import check_link
from multibot_rewrite.producers.bags import read

PIPES = ("package.xml", "manifest.json", "pyproject.toml", "r.srdf", "nav.yaml", "a.rviz", "a.mcap")


def test_an_output_that_is_a_link_out_of_its_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "here"
    folder.mkdir()
    (folder / "link").symlink_to(tmp_path / "file")
    (folder / "near").symlink_to(folder / "deep" / "file")
    for name in ("link", "near"):
        with pytest.raises(UsageError, match=r"is a link to .*/file; name that"):
            check_link(str(folder / name))
    for name in ("none", "/dev/stdout"):
        check_link(str(folder / name))
    (folder / "fleet.yaml").write_text("robots: [{name: a, description: a.urdf}]\n")
    (folder / "out").symlink_to(tmp_path)
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out")]) == 2
    assert "out is a link to " in capsys.readouterr().err


@pytest.mark.more
def test_a_file_of_another_kind_is_not_copied_by_a_fleet(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "secret").write_text("password: x\n")
    fleet = tmp_path / "fleet"
    fleet.mkdir()
    (fleet / "r.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    (fleet / "fleet.yaml").write_text(
        "robots: [{name: robot1, description: r.urdf}]\nrelated_files: {params: [../secret]}\n"
    )
    assert main(["build", str(fleet / "fleet.yaml"), "-o", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert "not a ROS 2 parameter file" in said
    assert "password" not in said
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("mode", ["FILE", "MESSAGE", "STORAGE"])
def test_a_bag_that_unpacks_to_more_than_a_bound(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, mode: str
) -> None:
    """A file, a message, a chunk of an MCAP: each is some kB of zeros packed."""
    made_bags, rosbag2 = pytest.importorskip("made_bags"), pytest.importorskip("rosbags.rosbag2")
    storage = rosbag2.StoragePlugin[("SQLITE3", "MCAP")[mode == "STORAGE"]]
    writer = rosbag2.Writer(tmp_path / "bag", version=9, storage_plugin=storage)
    writer.set_compression(rosbag2.CompressionMode[mode], rosbag2.CompressionFormat.ZSTD)
    with writer:
        tf = writer.add_connection("/tf", made_bags.TF, typestore=made_bags.STORE)
        writer.write(tf, 0, bytes(100_000_000))
    monkeypatch.setattr(workers, "MOST_MEMORY", 50_000_000)
    monkeypatch.setattr(read, "LEAST_UNPACKED", 1_000_000)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with pytest.raises(InputError, match="unpacks to more than"):
        read.read_bag(str(tmp_path / "bag"))
    assert [it.name for it in tmp_path.iterdir()] == ["bag"]


@pytest.mark.slow
@pytest.mark.parametrize(
    "words", ["urdf_lint .", "urdf_postfix r.urdf a", "multibot check --from a.mcap"]
)
def test_a_pipe_in_a_folder_is_not_waited_for(tmp_path: Path, words: str) -> None:
    """An archive may hold pipes under the names that are looked for beside a description."""
    for name in PIPES:
        os.mkfifo(tmp_path / name)
    (tmp_path / "r.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    command, *rest = words.split()
    line = [*python(f"multibot_rewrite.cli.{command}"), *rest]
    said = run(line, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60)
    assert said.returncode in (0, 2)
    assert "Traceback" not in said.stderr
