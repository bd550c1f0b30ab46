"""The proof of a rewrite: wrong text in the place of the right one is refused, whatever is wrong.

Each wrong text goes in where the robots' texts are made, so that the public calls are what refuses
it. Some of them only one part of the proof can see; their tests say which.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from multibot_rewrite import InputError, ProofError, pipeline, rewrite, rewrite_all
from multibot_rewrite.cli.urdf_postfix import main as urdf_postfix

# What is replaced in ``pipeline``: how a text is filled in, what the URDF beside an SRDF declares.
FILL, BESIDE = "fill", "respelled_names"

# A link has as many letters as the frame that is inserted for robot1: odom/robot1.
ROVER = b"""\
<robot name="rover">
  <link name="base"/>
  <link name="odom_link_1"/>
  <link name="wheel"><visual><geometry><mesh filename="wheel.stl"/></geometry></visual></link>
  <joint name="axle" type="continuous"><parent link="base"/><child link="wheel"/></joint>
  <!-- by hand -->
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_diff_drive.so">
      <update_rate>50</update_rate>
      <left_joint>axle</left_joint>
      <robot_base_frame>base</robot_base_frame>
    </plugin>
    <plugin name="imu" filename="libgazebo_ros_imu_sensor.so"/>
  </gazebo>
</robot>
"""
LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
Make = Callable[[list[bytes], str], bytes]
Wrong = Callable[[bytes], bytes]


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[Wrong], None]]:
    """Call it with what is done to every text before it is proved."""
    right: Make = getattr(pipeline, FILL)

    def start(wrong: Wrong) -> None:
        monkeypatch.setattr(pipeline, FILL, lambda pieces, robot: wrong(right(pieces, robot)))

    yield start


def change(old: str, new: str) -> Wrong:
    """The text with one thing in the place of another, at its first place."""

    def wrong(text: bytes) -> bytes:
        assert old.encode() in text, "the test looks for what is not there"
        return text.replace(old.encode(), new.encode(), 1)

    return wrong


@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_right_text_is_proved(made: Callable[[Wrong], None], layout: str) -> None:
    made(lambda text: text)
    assert b"wheel" in rewrite(ROVER, "robot1", layout=layout).data


WRONG = {
    "a declaration is not renamed": ('<link name="base/robot1"', '<link name="base"'),
    "a use is not renamed": ('<parent link="base/robot1"', '<parent link="base"'),
    "the text of a plugin is not renamed": ("<left_joint>axle_robot1", "<left_joint>axle"),
    "renamed twice": ('<child link="wheel/robot1"', '<child link="wheel/robot1/robot1"'),
    "another robot's name": ('<child link="wheel/robot1"', '<child link="wheel/robot2"'),
    "another separator": ('<child link="wheel/robot1"', '<child link="wheel_robot1"'),
    "a file is renamed": ('"wheel.stl"', '"wheel/robot1.stl"'),
    "a plugin's file is renamed": ("libgazebo_ros_imu_sensor.so", "libgazebo_ros_imu_robot1.so"),
    "two links have one name": ('<link name="wheel/robot1"', '<link name="base/robot1"'),
    "a name at another place": ("left_joint>axle_robot1</left", "right_joint>axle_robot1</right"),
    "a link is lost": ('  <link name="odom_link_1/robot1"/>\n', ""),
    "a link is new": ('  <link name="wheel', '  <link name="x"/>\n  <link name="wheel'),
    "parent and child are swapped": (
        '<parent link="base/robot1"/><child link="wheel/robot1"/>',
        '<child link="wheel/robot1"/><parent link="base/robot1"/>',
    ),
    "a number is another": ("<update_rate>50", "<update_rate>51"),
    "a comment is another": ("<!-- by hand -->", "<!-- by hands -->"),
    "a blank is lost": ('<link name="base/robot1"/>', '<link  name="base/robot1"/>'),
    "an insertion is lost": ("      <odometry_frame>odom/robot1</odometry_frame>\n", ""),
    "an insertion is longer": ("<odometry_frame>odom/robot1", "<odometry_frame>odom/robot12"),
    "an insertion is another element": ("odometry_frame>", "robot_base_frame>"),
    "a marker is lost": ("multibot robot1", "somebody robot1"),
    "a marker of another robot": ("multibot robot1", "multibot robot2"),
    "a marker counts too few": ("robot1 +2", "robot1 +1"),
    "a marker counts too many": ("robot1 +2", "robot1 +3"),
    "a marker forgets that its element was empty": ("+1 expanded (", "+1 ("),
    "the end is lost": ("</robot>\n", ""),
    "an element is not closed": ("</gazebo>", "<gazebo>"),
}


@pytest.mark.parametrize(("old", "new"), WRONG.values(), ids=WRONG)
def test_a_wrong_text_is_refused(made: Callable[[Wrong], None], old: str, new: str) -> None:
    made(change(old, new))
    with pytest.raises(ProofError):
        rewrite(ROVER, "robot1", layout="both")


UNSEEN = {
    "inserted text of another robot": (
        "<odometry_frame>odom/robot1",
        "<odometry_frame>odom/robot2",
    ),
    "an inserted namespace of another robot": ("<namespace>/robot1", "<namespace>/robot2"),
    "an inserted rule for another topic": ("/tf:=tf<", "/tg:=tf<"),
    "a marker that cannot be read": ("+1 expanded (", "+1 expandet ("),
    "a marker that counts more than there is": ("robot1 +2", "robot1 +9"),
}


@pytest.mark.parametrize(("old", "new"), UNSEEN.values(), ids=UNSEEN)
def test_a_wrong_insertion_as_long_as_the_right_one_is_refused(
    made: Callable[[Wrong], None], old: str, new: str
) -> None:
    made(change(old, new))
    with pytest.raises(ProofError):
        rewrite(ROVER, "robot1", layout="both")


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


# What one part of the proof alone sees.


def test_an_old_name_in_inserted_text_is_seen_by_the_count_of_names(
    made: Callable[[Wrong], None],
) -> None:
    """The text is as long as the right one and is taken out as a whole: both ways back hold."""
    made(change("<odometry_frame>odom/robot1<", "<odometry_frame>odom_link_1<"))
    with pytest.raises(ProofError, match="'odom_link_1'"):
        rewrite(ROVER, "robot1", layout="both")


def test_a_longer_insertion_is_seen_by_undoing_the_edits(made: Callable[[Wrong], None]) -> None:
    """Its names are right, and stripping takes it out whatever its length."""
    made(change("<odometry_frame>odom/robot1<", "<odometry_frame >odom/robot1<"))
    with pytest.raises(ProofError):
        rewrite(ROVER, "robot1", layout="both")


def test_a_marker_that_takes_out_the_users_own_text_is_seen_by_stripping(
    made: Callable[[Wrong], None],
) -> None:
    """As long as the right one, and the element behind the inserted ones holds no name."""
    made(change("multibot robot1 +2", "multibot robot1 +3"))
    with pytest.raises(ProofError):
        rewrite(ROVER, "robot1", layout="both")


URDF = b'<robot name="arm"><link name="a"/><link name="b"/><link name="c"/></robot>'
SRDF = b'<robot name="arm"><group name="all"><link name="a"/></group></robot>'


def test_two_symbols_in_one_are_seen_by_counting_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two links of the URDF beside an SRDF get one name; the SRDF mentions neither."""
    assert b"a/robot1" in rewrite(SRDF, "robot1", urdf=URDF).data
    right = getattr(pipeline, BESIDE)

    def merged(*given: object) -> dict[str, dict[str, object]]:
        declared = {kind: dict(names) for kind, names in right(*given).items()}
        del declared["link"]["c/robot1"]
        return declared

    monkeypatch.setattr(pipeline, BESIDE, merged)
    with pytest.raises(ProofError):
        rewrite(SRDF, "robot1", urdf=URDF)


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
