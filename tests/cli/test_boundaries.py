# SPDX-License-Identifier: Apache-2.0
"""What a command writes and reads only if it was named: links of an output, what a fleet file names."""

from __future__ import annotations

from pathlib import Path
from subprocess import run

import pytest

from multibot_rewrite.base.child import python
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.cli.walk import check_link
from multibot_rewrite.producers.bags import read


def test_an_output_that_is_a_link_out_of_its_folder(tmp_path: Path) -> None:
    folder = tmp_path / "here"
    folder.mkdir()
    (folder / "link").symlink_to(tmp_path / "file")
    (folder / "near").symlink_to(folder / "deep" / "file")
    with pytest.raises(UsageError, match=r"is a link to .*/file; name that file"):
        check_link(str(folder / "link"))
    for name in ("near", "none", "/dev/stdout"):
        check_link(str(folder / name))


@pytest.mark.more
def test_a_file_of_another_kind_is_not_copied_by_a_fleet(tmp_path: Path) -> None:
    (tmp_path / "secret").write_text("password: x\n")
    fleet = tmp_path / "fleet"
    fleet.mkdir()
    (fleet / "r.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    (fleet / "fleet.yaml").write_text(
        "robots: [{name: robot1, description: r.urdf}]\ncompanions: {params: [../secret]}\n"
    )
    said = run(
        [
            *python("multibot_rewrite"),
            "build",
            str(fleet / "fleet.yaml"),
            "-o",
            str(tmp_path / "out"),
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert said.returncode == 2
    assert "not a ROS 2 parameter file" in said.stderr
    assert "password" not in said.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("before", [b"", b"\x50\x2a\x4d\x18\1\0\0\0x"], ids=["plain", "skipped"])
@pytest.mark.parametrize("name", ["a.db3.zstd", "a.db3"])
def test_a_bag_that_unpacks_to_more_than_a_bound(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, before: bytes
) -> None:
    """Its metadata say what is packed, whatever the file is called."""
    zstd = pytest.importorskip("rosbags.rosbag2.reader").zstd
    (tmp_path / name).write_bytes(before + zstd.compress(bytes(5_000_000)))
    monkeypatch.setattr(read, "LEAST_UNPACKED", 1_000_000)
    with pytest.raises(InputError, match="unpacks to more than"):
        read.read_bag(str(tmp_path))
