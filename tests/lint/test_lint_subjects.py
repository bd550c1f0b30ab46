# SPDX-License-Identifier: Apache-2.0
"""What of a file is checked: as it is written, and once for each set of xacro arguments."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.base.findings.finding import SRDF, XACRO
from multibot_rewrite.lint.files.subjects import Failed, read_subjects
from multibot_rewrite.rules.settings import ArgumentSet, Settings

SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
LINK = '<link name="a"/>'
ARG = '<xacro:arg name="side" default="left"/>'
NEEDED = '<link name="$(arg side)"/>'
MACRO = '<xacro:macro name="m" params=""><link name="b"/></xacro:macro>'
INCLUDE = '<xacro:include filename="part.xacro"/>'
SETS = (ArgumentSet("*", (("side", "right"),)),)
OTHERS = (ArgumentSet("other*", (("side", "right"),)),)


def robot(body: str, tag: str = "robot") -> str:
    return f'<{tag} name="r" {SPACE}>{body}</{tag}>'


def read(name: str, text: str, folder: Path, **settings: object) -> list[str]:
    """Of each subject its format, the end of its file's name and what it was given."""
    file = folder / name
    file.write_text(text)
    (folder / "part.xacro").write_text(robot(""))
    included = frozenset({str(file)}) if settings.pop("part", False) else frozenset()
    chosen = Settings(included=included, **settings)  # type: ignore[arg-type]
    found = read_subjects(str(file), text.encode(), chosen)
    return [
        "failed" if isinstance(it, Failed) else f"{it.format} {','.join(it.given)}".strip()
        for it in found
    ]


@pytest.mark.parametrize(
    ("name", "text", "settings", "found"),
    [
        ("r.urdf", robot(LINK), {}, ["urdf"]),
        ("r.xacro", robot(LINK), {}, [XACRO, "urdf"]),
        # What includes a model of SDF is expanded all the same.
        ("r.xacro", robot(LINK + "<include/>"), {}, [XACRO, "urdf"]),
        # By its elements, whatever it is called.
        ("r.urdf", robot(LINK + ARG), {}, [XACRO, "urdf"]),
        ("r.xacro", robot(ARG + LINK), {"arguments": SETS}, [XACRO, "urdf", "urdf side"]),
        ("r.xacro", robot(ARG + LINK), {"arguments": OTHERS}, [XACRO, "urdf"]),
        # An argument that has no default: with a set that gives it there is no default expansion.
        ("r.xacro", robot(NEEDED), {}, [XACRO, "failed"]),
        ("r.xacro", robot(NEEDED), {"arguments": SETS}, [XACRO, "urdf side"]),
        ("r.xacro", robot(NEEDED), {"arguments": OTHERS}, [XACRO, "failed"]),
        ("r.xacro", robot("<xacro:m/>" + ARG), {"arguments": SETS}, [XACRO, "failed", "failed"]),
        # What only defines is expanded where it is used.
        ("r.xacro", robot(MACRO), {}, [XACRO]),
        ("r.xacro", robot(MACRO + INCLUDE), {}, [XACRO]),
        ("r.xacro", robot(ARG), {}, [XACRO]),
        ("r.xacro", robot(INCLUDE), {}, [XACRO, "urdf"]),
        ("r.xacro", robot(MACRO + LINK), {}, [XACRO, "urdf"]),
        # Included by others: a xacro alone is read as it is written, and of any root nothing.
        ("r.xacro", robot(LINK), {"part": True}, [XACRO]),
        ("r.urdf", robot(LINK), {"part": True}, []),
        ("r.xacro", robot(LINK, "acme"), {"part": True}, []),
        ("r.xacro", robot(MACRO, "acme"), {}, []),
        ("r.srdf", '<robot name="r"><group name="g"/></robot>', {}, [SRDF]),
        # An SRDF by its name alone.
        ("r.srdf", '<robot name="r"/>', {}, [SRDF]),
        ("r.urdf", '<robot name="r"/>', {}, ["urdf"]),
    ],
)
def test_what_of_a_file_is_checked(
    name: str, text: str, settings: dict[str, object], found: list[str], tmp_path: Path
) -> None:
    assert read(name, text, tmp_path, **settings) == found
