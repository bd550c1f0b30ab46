# SPDX-License-Identifier: Apache-2.0
"""What ``multibot init`` makes of answers: each question alone, nothing is built."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from multibot_rewrite.cli import init
from multibot_rewrite.proposal.looking import Looked
from multibot_rewrite.proposal.propose import Choice, release_of_files
from multibot_rewrite.proposal.seeing import Wanted


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> Callable[..., list[tuple[str, str]]]:
    """Return a function that sets the answers and returns what was asked, with its default. An
    empty answer takes the default."""

    def answering(*answers: str) -> list[tuple[str, str]]:
        left, questions = [*answers], list[tuple[str, str]]()

        def ask(question: str, default: str, words: Any = None) -> str:
            questions.append((question, default))
            answer = left.pop(0) or default
            assert words is None or answer in words
            return answer

        monkeypatch.setattr(init, "_ask", ask)
        return questions

    return answering


def wanted(**words: Any) -> Wanted:
    return Wanted(("."), 0, {}, "jazzy", False, "", False, ())._replace(**words)


@pytest.mark.parametrize(
    ("answers", "each", "names"),
    [
        ([""], 2, ()),
        (["3"], 3, ()),
        ([" 3 "], 3, ()),
        (["front, rear"], 2, ("front", "rear")),
        (["a b,c"], 3, ("a", "b", "c")),
        # Asked again: no robots, one name twice, what is no name.
        (["0", "a a", "1a", "-1", "", "x"], 2, ()),
        (["a a", "a"], 1, ("a",)),
    ],
)
def test_robots_are_a_number_or_names(
    answers: list[str], each: int, names: tuple[str, ...], asked: Any
) -> None:
    asked(*answers)
    made = init._with_names(wanted())
    assert (made.each, made.names) == (each, names)


def test_names_that_a_count_gives_are_the_default(asked: Any) -> None:
    questions = asked("")
    made = init._with_names(wanted(each=3))
    assert questions == [("Robots: how many, or their names", "robot1, robot2, robot3")]
    assert (made.each, made.names) == (3, ("robot1", "robot2", "robot3"))
    assert init._with_names(wanted(names=("a",))) == wanted(names=("a",)) and len(questions) == 1


def test_how_many_of_each_is_asked_until_it_is_a_number(asked: Any) -> None:
    questions = asked("0", "two", "4")
    assert init._with_count(wanted()).each == 4
    assert questions == [("Robots of each description", "2")] * 3
    assert init._with_count(wanted(each=1)).each == 1 and len(questions) == 3


def test_one_of_several_descriptions_is_named_by_its_number(asked: Any, capsys: Any) -> None:
    robots = [Looked("a.urdf", links=1), Looked("b.urdf", links=7)]
    questions = asked("2", "")
    assert (
        init._choose_description(robots) == robots[1:]
        and init._choose_description(robots) == robots[:1]
    )
    said = capsys.readouterr().err
    assert "1: a.urdf (1 link)" in said and "2: b.urdf (7 links)" in said
    assert init._choose_description(robots[1:]) == robots[1:] and len(questions) == 2


PATHS = ["a.yaml", "b.rviz", "c.srdf"]


@pytest.mark.parametrize(
    ("answers", "left"),
    [
        (["none"], []),
        ([""], []),
        (["all"], PATHS),
        (["1"], ["a.yaml"]),
        (["3, 1"], ["c.srdf", "a.yaml"]),
        (["4", "0", "x", "2"], ["b.rviz"]),
    ],
)
def test_files_are_left_out_by_number(answers: list[str], left: list[str], asked: Any) -> None:
    asked(*answers)
    # Two robots with one file: it is asked for once.
    members = [
        SimpleNamespace(related_files=SimpleNamespace(paths=it)) for it in (PATHS, PATHS[:1])
    ]
    made: Any = SimpleNamespace(members=members)
    assert init._unwanted_files(made) == left


def test_where_nothing_is_beside_nothing_is_asked(asked: Any) -> None:
    none = SimpleNamespace(related_files=SimpleNamespace(paths=()))
    made: Any = SimpleNamespace(members=[none])
    assert (init._unwanted_files(made), asked()) == ([], [])


@pytest.mark.parametrize(
    ("places", "answers", "metres", "questions"),
    [
        ([0, 1.5, 3], [""], 1.5, 1),
        ([0, 1.5, 3], ["-1", "0", "2.", "x", "2.25"], 2.25, 5),
        ([0, 1.5, 3], ["1000"], 1000, 1),
        ([0, 1.5, 3.5], [], 0, 0),
        ([0], [], 0, 0),
    ],
)
def test_how_far_robots_are_apart(
    places: list[float], answers: list[str], metres: float, questions: int, asked: Any
) -> None:
    seen = asked(*answers)
    made: Any = SimpleNamespace(poses={at: {"y": it} for at, it in enumerate(places)})
    assert init._ask_distance(made) == metres
    assert seen == [("Metres from robot to robot", "1.5")] * questions


def test_arguments_that_were_given_are_not_asked(asked: Any, monkeypatch: Any) -> None:
    values = (("prefix", "{robot}_"), ("ip", ""), ("given", "1"))
    looked = Looked("a.xacro", arguments=values, needed=("ip",))
    monkeypatch.setattr(init, "with_arguments", lambda robots, *_: robots)
    questions = asked("", "10.0.0.1")
    made = init._with_arguments(looked, wanted(arguments={"given": "1"}), init.Found())
    assert dict(made.arguments) == {"prefix": "{robot}_", "ip": "10.0.0.1", "given": "1"}
    assert made.needed == () and [it[0] for it in questions] == [
        "Argument prefix of the xacro",
        "Argument ip of the xacro",
    ]


def test_another_layout_is_made_and_the_same_is_not(asked: Any, monkeypatch: Any) -> None:
    made: Any = SimpleNamespace(keys={"layout": Choice("both", "tf has one topic")})
    monkeypatch.setattr(init, "in_layout", lambda _, choice: choice.value)
    questions = asked("", "postfix")
    assert init._ask_layout(made) is made and init._ask_layout(made) == "postfix"
    assert questions[0] == ("Layout (tf has one topic)", "both")


# The release of parameter files, by what ros2_controllers declares in each.

MANAGER = """controller_manager:
  ros__parameters:
    drive: {type: tricycle_steering_controller/TricycleSteeringController}
drive:
  ros__parameters: {%s}
"""
OLD = "wheel_track: 1.0, front_wheels_radius: 0.1, rear_wheels_radius: 0.1"


@pytest.mark.parametrize(
    ("own", "release", "why"),
    [
        (OLD, "jazzy", "lyrical lacks 3 parameters or plugins of p.yaml"),
        # One may be left over.
        ("wheel_track: 1.0", "lyrical", ""),
        ("wheelbase: 1.0", "lyrical", ""),
        ("of_nobody: 1.0, nor_this: 2.0", "lyrical", ""),
        ("]", "lyrical", ""),
    ],
)
def test_the_release_is_that_which_has_most(
    own: str, release: str, why: str, tmp_path: Path
) -> None:
    file = tmp_path / "p.yaml"
    file.write_text(MANAGER % own)
    assert release_of_files([str(file), str(tmp_path / "gone.yaml")]) == (release, why)
    assert release_of_files([]) == ("lyrical", "")
