# SPDX-License-Identifier: Apache-2.0
"""``ros2 multibot``: what ros2cli calls, called as ros2cli does (``ros2cli/command/__init__.py``)."""

from __future__ import annotations

import argparse
import inspect
from importlib.metadata import entry_points

import pytest
from paths import FIXTURES

from multibot_rewrite.cli.declared.commands import COMMANDS
from multibot_rewrite.cli.multibot import MultibotCommand, main
from multibot_rewrite.version import __version__


def ros2(*words: str) -> int:
    """Return what ``ros2 multibot words...`` ends with."""
    parser = argparse.ArgumentParser(prog="ros2")
    below = parser.add_subparsers(dest="command_of_ros2")
    command = below.add_parser("multibot", formatter_class=argparse.RawDescriptionHelpFormatter)
    extension = MultibotCommand()
    extension.NAME = "multibot"
    command.set_defaults(_command=extension)
    command.description = inspect.getdoc(extension)
    extension.add_arguments(command, "ros2 multibot")
    args = parser.parse_args(["multibot", *words])
    return extension.main(parser=parser, args=args)


@pytest.mark.more
def test_words_reach_the_command(capsys: pytest.CaptureFixture[str]) -> None:
    rover = str(FIXTURES / "robots" / "rover.urdf")
    words = ["plan", rover, "robot1", "--node-set", "nav2", "--output-kind", "ros-args"]
    assert ros2(*words) == main(words) == 0
    first, second = capsys.readouterr().out.split("# robot1: map_server", 1)
    assert second.count("# robot1: map_server") == 1
    assert first == "# ROS 2 humble\n"


def test_a_command_that_fails_fails(capsys: pytest.CaptureFixture[str]) -> None:
    assert ros2("build", "nowhere.yaml", "-o", "nowhere") == 2
    assert "nowhere.yaml" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["--help"], ["-h"]])
def test_help_lists_the_commands(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        ros2(*words)
    assert caught.value.code == 0
    shown = capsys.readouterr().out
    assert all(name in shown and it.about in shown for name, it in COMMANDS.items())


def test_help_of_a_command_is_its_own(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        ros2("plan", "--help")
    assert caught.value.code == 0
    assert "--node-set" in capsys.readouterr().out


@pytest.mark.parametrize(("word", "code"), [("--version", 0), ("chek", 2)])
def test_other_words(word: str, code: int, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        ros2(word)
    assert caught.value.code == code
    told = capsys.readouterr()
    assert __version__ in told.out if code == 0 else "choose from" in told.err


def test_an_entry_point_leads_to_it() -> None:
    found = [it for it in entry_points(group="ros2cli.command") if it.name == "multibot"]
    if not found:
        pytest.skip("installed before there was an entry point: pip install again")
    assert found[0].load() is MultibotCommand


def test_its_first_line_is_shown_by_ros2() -> None:
    assert (MultibotCommand.__doc__ or "").splitlines()[0].endswith(".")
