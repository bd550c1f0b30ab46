# SPDX-License-Identifier: Apache-2.0
"""Which mentions a reason explains, and what is left."""

from __future__ import annotations

from pathlib import Path

import pytest
from surveyed_robot import surveyed

from multibot_rewrite import InputError
from tools.unclaimed import Explained, Reason, explain, main, read_reasons


def plugin(library: str, body: str = "") -> str:
    return f'<gazebo><plugin name="p" filename="{library}">{body}</plugin></gazebo>'


def explained(body: str, *reasons: str) -> Explained:
    rows = [Reason(path, "why", line) for line, path in enumerate(reasons, 1)]
    return explain(surveyed(body), rows)


@pytest.mark.parametrize(
    "path",
    [
        "robot/gazebo/plugin[libacme.so]/x",
        "*/plugin[libacme.so]/x",
        "robot/*/x",
        "*plugin[lib*.so]*",
        "*",
    ],
)
def test_a_reason_explains_its_path_with_stars_for_any_text(path: str) -> None:
    found = explained(plugin("libacme.so", "<x>hip</x>"), path)
    assert [mention.path for mention, _, _ in found.explained] == [
        "robot/gazebo/plugin[libacme.so]/x"
    ]
    assert not found.left and not found.stale


@pytest.mark.parametrize(
    "path",
    [
        "robot/gazebo/plugin[libacme.so]",
        "robot/gazebo/pluginl/x",
        "robot/gazebo/plugin[libacme?so]/x",
        "robot/gazebo/plugin[[]libacme.so]/x",
        "ROBOT/*",
        "x",
    ],
)
def test_only_a_star_stands_for_something_else(path: str) -> None:
    found = explained(plugin("libacme.so", "<x>hip</x>"), path)
    assert not found.explained
    assert [mention.path for mention, _ in found.left] == ["robot/gazebo/plugin[libacme.so]/x"]
    assert [stale.path for stale in found.stale] == [path]


def test_the_first_reason_counts_and_the_second_is_not_stale() -> None:
    found = explained(plugin("libacme.so", "<x>hip</x>"), "*/x", "*")
    assert [reason.line for _, _, reason in found.explained] == [1]
    assert not found.stale


def test_a_reason_is_for_exact_mentions() -> None:
    found = explained(plugin("libacme.so", "<x>hip arm</x>"), "*")
    assert not found.explained and not found.left
    assert len(found.stale) == 1


def test_reasons_are_read_line_by_line() -> None:
    text = "# comment\n\nrobot/a\tbecause it is\nrobot/b@c\ttab\tin it\n"
    assert read_reasons(text, "f") == [
        Reason("robot/a", "because it is", 3),
        Reason("robot/b@c", "tab\tin it", 4),
    ]


@pytest.mark.parametrize("row", ["robot/a", "robot/a because", "robot/a\t", "\twhy", "robot/a\t  "])
def test_a_line_without_path_or_reason_is_refused(row: str) -> None:
    with pytest.raises(
        InputError, match=r"^why\.tsv:2: write the tag path, a tab, and the reason$"
    ):
        read_reasons(f"# one\n{row}\n", "why.tsv")


@pytest.mark.parametrize(
    ("reasons", "code", "printed"),
    [
        ("*/plugin[libacme.so]/x\tan old label\n", 0, ""),
        ("", 1, "a.urdf:1: robot/gazebo/plugin[libacme.so]/x: hip\n"),
        (
            "*/x\ta label\nrobot/gone\tit was\n",
            1,
            "why.tsv:2: explains nothing any more: robot/gone\n",
        ),
        ("robot/x no tab\n", 2, ""),
    ],
)
def test_the_program_says_what_is_left(
    reasons: str, code: int, printed: str, here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("why.tsv").write_text(reasons)
    body = plugin("libacme.so", "<x>hip</x>")
    joint = '<joint name="hip" type="fixed"><parent link="a"/><child link="b"/></joint>'
    Path("a.urdf").write_text(
        f'<robot name="r"><link name="a"/><link name="b"/>{joint}{body}</robot>'
    )
    assert main(["why.tsv", "a.urdf"]) == code
    assert capsys.readouterr().out == printed
