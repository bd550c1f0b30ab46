# SPDX-License-Identifier: Apache-2.0
"""MB9: what a rewrite would leave as it is, at the very value."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import Settings


def linted(folder: Path, text: str) -> list[tuple[str, str, int, int]]:
    file = folder / "r.urdf"
    file.write_text(f'<robot name="r">\n{text}\n</robot>')
    found = lint_file(str(file), Settings(select=("MB9", "MB105")))
    return [(it.code, it.level, it.line, it.column) for it in found]


LINK = '<link name="gripper"/>\n'


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (LINK + '<x part="gripper"/>', [("MB901", "warning", 3, 4)]),
        (LINK + '<x a="1" part="b gripper"/>', [("MB901", "warning", 3, 10)]),
        (LINK + "<x>gripper</x>", [("MB901", "warning", 3, 4)]),
        (LINK + "<x>grippers</x>", []),
        (LINK + '<x parent="gripper"><origin/></x>', [("MB105", "warning", 3, 1)]),
        (LINK + "<!-- gripper -->", []),
        # Known to be a word of its own, or a reference that is renamed.
        (LINK + '<gazebo reference="gripper"/>', []),
        (LINK + '<joint name="j" type="gripper"/>', []),
        ("<x>gripper</x>", []),
        ('<gazebo><light name="eye"/></gazebo><x>eye</x>', [("MB901", "warning", 2, 40)]),
        ("", []),
        (
            '<gazebo><plugin name="p" filename="libunheard_of.so"/></gazebo>',
            [("MB902", "note", 2, 9)],
        ),
        (
            # No Gazebo of the newest release loads it (REP 2000).
            '<gazebo><plugin name="p" filename="libgazebo_ros_camera.so"/></gazebo>',
            [("MB902", "note", 2, 9)],
        ),
        # Without a parameter it opens what it opens.
        (
            "<ros2_control><hardware><plugin>un/Heard</plugin></hardware></ros2_control>",
            [("MB903", "note", 2, 1)],
        ),
        (
            '<ros2_control><hardware><plugin>un/Heard</plugin><param name="a">b</param></hardware>'
            "</ros2_control>",
            [("MB903", "note", 2, 1)],
        ),
        ('<ros2_control><hardware><plugin/><param name="a"/></hardware></ros2_control>', []),
    ],
)
def test_what_nothing_knows(
    text: str, expected: list[tuple[str, str, int, int]], tmp_path: Path
) -> None:
    assert linted(tmp_path, text) == expected


def test_only_what_ros_2_does_not_read_is_named(tmp_path: Path) -> None:
    """bodyName is followed by libsdformat itself, frame_name is read by both versions."""
    file = tmp_path / "a.urdf"
    tags = "<ros/><topicName>t</topicName><bodyName>a</bodyName><frame_name>a</frame_name>"
    plugin = f'<plugin name="i" filename="libgazebo_ros_imu_sensor.so">{tags}</plugin>'
    file.write_text(f'<robot name="r"><link name="a"/><gazebo>{plugin}</gazebo></robot>')
    (found,) = lint_file(str(file), Settings(select=("MB904",)))
    assert "does not read <topicName> in ROS 2" in found.message


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("row", "text", "line"),
    [
        ("a uses link", "<a>base</a>", "a"),
        ("b/c uses link", "<b>\n<c>base</c></b>", "b/c"),
        ("@d uses link", "", ""),
        ("e[@name=f] uses link", "<e name='f'>base</e>", "e[@name=f]"),
        ("e[@name=f] uses link", "<e name='g'>base</e>", ""),
        ("h@i uses link", "<h i='base'/><h/>", "h@i"),
        ("k keep a word", "<k>base</k>", ""),
    ],
)
@pytest.mark.parametrize("whole", [False, True])
def test_a_row_of_another_release(
    row: str, text: str, line: str, whole: bool, tmp_path: Path
) -> None:
    """By a word in the row, or by the setting of a section that adds it."""
    words, setting = ("", "releases: humble\n") if whole else (" releases=humble", "")
    row = row.replace(" uses link", f" uses link{words}").replace(" keep ", f" keep{words} ")
    definitions = tmp_path / "my.vocab"
    definitions.write_text(f"[plugin lamp]\nz uses link\n[plugin lamp]\n{setting}{row}\n")
    file = tmp_path / "r.urdf"
    plugin = f"<gazebo><plugin name='l' filename='liblamp.so'>{text}</plugin></gazebo>"
    file.write_text(f"<robot name='r'><link name='base'/>{plugin}</robot>")

    def found(release: str) -> list[str]:
        settings = Settings(select=("MB905",), definitions=(str(definitions),), distro=release)
        return [it.message for it in lint_file(str(file), settings)]

    about = f"{line} of plugin lamp is not in jazzy, only in humble: nothing in it is renamed"
    assert found("jazzy") == ([about] if line else [])
    assert found("humble") == []


@pytest.mark.more
def test_a_plugin_that_only_another_release_has(tmp_path: Path) -> None:
    definitions = tmp_path / "my.vocab"
    definitions.write_text("[plugin lamp]\nopens: nothing\nreleases: <=jazzy\nlink uses link\n")
    file = tmp_path / "r.urdf"
    plugin = "<gazebo><plugin name='l' filename='liblamp.so'><link>a</link></plugin></gazebo>"
    file.write_text(f"<robot name='r'><link name='a'/>{plugin}</robot>")
    settings = Settings(select=("MB902",), definitions=(str(definitions),), distro="kilted")
    (found,) = lint_file(str(file), settings)
    assert "plugin 'liblamp.so' is not in kilted, only in humble, jazzy" in found.message
    assert "--distro" in found.hint
    assert lint_file(str(file), settings._replace(distro="jazzy")) == []
