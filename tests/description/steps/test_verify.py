# SPDX-License-Identifier: Apache-2.0
"""The proof of a rewrite: who calls it, and what it says; what it refuses is in test_proof_faults.

Each wrong text goes in where the robots' texts are made, so that the public calls are what refuses
it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from paths import fixture_text

from multibot_rewrite import InputError, ProofError, RewriteRefused, rewrite, rewrite_all
from multibot_rewrite.cli.urdf_postfix import main as urdf_postfix
from multibot_rewrite.description import pipeline

# What is replaced in ``pipeline``: how a text is filled in.
FILL = "fill"

# A link has as many letters as the frame that is inserted for robot1: odom/robot1.
ROVER = fixture_text("verify_rover.urdf").encode()
LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
Make = Callable[[list[bytes], str], bytes]
Wrong = Callable[[bytes], bytes]


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[Wrong], None]]:
    """Call it with what is done to every text before it is verified."""
    right: Make = getattr(pipeline, FILL)

    def start(wrong: Wrong) -> None:
        monkeypatch.setattr(pipeline, FILL, lambda pieces, robot: wrong(right(pieces, robot)))

    yield start


def change(old: str, new: str) -> Wrong:
    """Return the text with one thing in the place of another, at its first place."""

    def wrong(text: bytes) -> bytes:
        assert old.encode() in text, "the test looks for what is not there"
        return text.replace(old.encode(), new.encode(), 1)

    return wrong


@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_right_text_is_proved(made: Callable[[Wrong], None], layout: str) -> None:
    made(lambda text: text)
    assert b"wheel" in rewrite(ROVER, "robot1", layout=layout).data


@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_input_itself_is_no_rewrite(made: Callable[[Wrong], None], layout: str) -> None:
    made(lambda _: ROVER)
    with pytest.raises(ProofError):
        rewrite(ROVER, "robot1", layout=layout)


@pytest.mark.parametrize("wrong", [b"", b"\xff\xfe", b"no XML", b"<world/>"])
def test_what_is_no_description_fails_the_proof_and_not_the_input(
    made: Callable[[Wrong], None], wrong: bytes
) -> None:
    made(lambda _: wrong)
    with pytest.raises(ProofError):
        rewrite(ROVER, "robot1")


# Where several parts of the proof see a fault, the first one names what is wrong.


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ('<child link="wheel/robot1"', '<child link="wheel/robot2"', "'wheel/robot2'"),
        ("left_joint>axle_robot1</left", "right_joint>axle_robot1</right", "'axle_robot1'"),
        ('  <link name="odom_link_1/robot1"/>\n', "", r"\b11\b.*\b10\b"),
    ],
)
def test_the_name_that_is_wrong_is_named(
    made: Callable[[Wrong], None], old: str, new: str, named: str
) -> None:
    made(change(old, new))
    with pytest.raises(ProofError, match=named):
        rewrite(ROVER, "robot1", layout="both")


# Names that meet.

URDF = b'<robot name="arm"><link name="a"/><link name="a/robot1"/></robot>'
SRDF = b'<robot name="arm"><group name="all"><link name="a"/></group></robot>'


def test_two_links_of_the_urdf_that_become_one_are_refused_with_the_srdf() -> None:
    """a becomes a/robot1, and a/robot1 stays: the group would hold the one or the other."""
    assert b"a/robot1" in rewrite(SRDF, "robot1", urdf=URDF).data
    with pytest.raises(RewriteRefused, match="MB420"):
        rewrite(SRDF, "robot1", urdf=URDF, shared_frames=["a/robot1"])


def test_a_name_of_the_input_may_be_what_is_inserted() -> None:
    """A link odom/robot1 is renamed, and a frame of that name is inserted."""
    source = ROVER.replace(b"odom_link_1", b"odom/robot1")
    text = rewrite(source, "robot1", layout="both", again=True).text
    assert re.findall(r"odom/robot1[^\"<]*", text) == ["odom/robot1/robot1", "odom/robot1"]


# Who calls it.


def test_every_public_call_proves_what_it_gives(made: Callable[[Wrong], None]) -> None:
    made(change("base/robot", "base/robut"))
    with pytest.raises(ProofError):
        rewrite(ROVER, "robot1")
    with pytest.raises(ProofError):
        next(rewrite_all(ROVER, ["robot1", "robot2", "robot3"]))


def test_the_command_writes_nothing_that_is_not_proved(
    made: Callable[[Wrong], None], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source, target = tmp_path / "rover.urdf", tmp_path / "{robot}.urdf"
    source.write_bytes(ROVER)
    made(change("base/robot", "base/robut"))
    assert urdf_postfix([str(source), "robot1", "robot2", "-o", str(target)]) == 1
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == [source]
    assert capsys.readouterr().out == ""


def test_a_fault_of_the_input_stays_one() -> None:
    with pytest.raises(InputError):
        rewrite(b"<robot", "robot1")
