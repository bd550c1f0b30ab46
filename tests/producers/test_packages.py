# SPDX-License-Identifier: Apache-2.0
"""``--launch PACKAGE FILE``, as ros2launch finds it in installed packages and in sources."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite import UsageError
from multibot_rewrite.producers.launch.records import launch_order


def package(folder: Path, *files: str) -> Path:
    for name in ("package.xml", *files):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(f"<package><name>{folder.name}</name></package>")
    return folder


def test_what_is_installed_is_found_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    over, under = (package(tmp_path / it / "share" / "acme", "b.launch.py") for it in "ou")
    package(tmp_path / "src" / "acme", "b.launch.py")
    prefixes = f"{tmp_path / 'none'}:{tmp_path / 'o'}:{tmp_path / 'u'}"
    monkeypatch.setenv("AMENT_PREFIX_PATH", prefixes)
    found = launch_order("acme b.launch.py", [str(tmp_path / "src")]).file
    assert found == str(over / "b.launch.py") and under.exists()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("other b.launch.py", "'other' is not found; .*--roots"),
        ("acme c.launch.py", "acme has no such file"),
        ("acme b.launch.py", "it has a/b.launch.py and b.launch.py; give the path"),
    ],
)
def test_a_package_or_file_that_is_not_one(text: str, said: str, tmp_path: Path) -> None:
    package(tmp_path / "acme", "b.launch.py", "a/b.launch.py", ".git/c.launch.py")
    with pytest.raises(UsageError, match=said):
        launch_order(text, [str(tmp_path)])
