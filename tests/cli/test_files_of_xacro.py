# SPDX-License-Identifier: Apache-2.0
"""What a xacro reads is known to every command that expands it: no result is written over it, and an
argument that none of its files knows is a warning."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from paths import write_files

from multibot_rewrite.cli import multibot, urdf_lint, urdf_postfix

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
FILES = {
    "r.urdf.xacro": f"""{HEAD}
  <xacro:include filename="parts/base.xacro"/>
  <link name="arm" />
  <joint name="${{xacro.load_yaml('sizes.yaml')['joint']}}" type="fixed">
    <parent link="$(arg tf_prefix)base_link"/><child link="arm"/>
  </joint>
</robot>
""",
    "parts/base.xacro": f"""{HEAD}
  <xacro:arg name="tf_prefix" default=""/>
  <link name="$(arg tf_prefix)base_link"/>
</robot>
""",
    "sizes.yaml": "joint: mount\n",
    "fleet.yaml": "description: r.urdf.xacro\nrobots:\n  - {name: robot1}\n  - {name: robot2}\n",
    "graph.json": "{}",
}
READ = ("parts/base.xacro", "sizes.yaml")
Command = tuple[Callable[[Sequence[str]], int], str]
POSTFIX, MULTIBOT, LINT = urdf_postfix.main, multibot.main, urdf_lint.main
# The target is what comes last.
WRITERS: dict[str, Command] = {
    "postfix": (POSTFIX, "r.urdf.xacro robot1 -o"),
    "own arguments": (POSTFIX, "r.urdf.xacro robot1 tf_prefix:={robot}_ -o"),
    "changes": (POSTFIX, "r.urdf.xacro robot1 --output-kind changes -o"),
    "strip": (POSTFIX, "made.urdf robot1 --undo --xacro r.urdf.xacro tf_prefix:={robot}_ -o"),
    "plan": (MULTIBOT, "plan r.urdf.xacro robot1 robot2 -o"),
    "plan of a fleet": (MULTIBOT, "plan fleet.yaml -o"),
    "remap": (MULTIBOT, "plan --output-kind table r.urdf.xacro robot1 robot2 -o"),
    "check": (MULTIBOT, "check fleet.yaml --from graph.json -o"),
    "rehearse": (MULTIBOT, "rehearse fleet.yaml --save-snapshot"),
    "inspect": (MULTIBOT, "inspect r.urdf.xacro -o"),
    "inspect --suggest": (MULTIBOT, "inspect --suggest r.urdf.xacro -o"),
}


@pytest.fixture
def robot(here: Path) -> Path:
    write_files(here, FILES)
    return here


def there(robot: Path) -> dict[str, str]:
    files = (it for it in robot.rglob("*") if it.is_file())
    return {it.relative_to(robot).as_posix(): it.read_text() for it in files}


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("target", READ)
@pytest.mark.parametrize("name", WRITERS)
def test_nothing_is_written_over_what_the_xacro_reads(
    name: str, target: str, robot: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if name == "strip":
        assert POSTFIX(["r.urdf.xacro", "robot1", "tf_prefix:={robot}_", "-o", "made.urdf"]) == 0
    before = there(robot)
    run, words = WRITERS[name]
    capsys.readouterr()
    assert run([*words.split(), target]) == 2
    (said,) = capsys.readouterr().err.splitlines()
    assert f"{target} is a file that is read; choose another one for --" in said
    assert there(robot) == before


def test_what_another_name_leads_to_is_not_written_over(
    robot: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (robot / "link.urdf").symlink_to("sizes.yaml")
    (robot / "robot1.urdf").hardlink_to(robot / "sizes.yaml")
    for target in ("link.urdf", "{robot}.urdf"):
        assert POSTFIX(["r.urdf.xacro", "robot2", "robot1", "-o", "{robot}.urdf"]) == 2
        assert POSTFIX(["r.urdf.xacro", "robot1", "-o", target]) == 2
    assert not (robot / "robot2.urdf").exists()
    assert (robot / "sizes.yaml").read_text() == FILES["sizes.yaml"]


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("force", [[], ["--force"]])
def test_a_build_writes_over_nothing_that_a_xacro_reads(
    force: list[str], robot: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (robot / "r.urdf.xacro").write_text(
        FILES["r.urdf.xacro"].replace("sizes.yaml", "out/robot1/r.urdf")
    )
    (robot / "out" / "robot1").mkdir(parents=True)
    (robot / "out" / "robot1" / "r.urdf").write_text(FILES["sizes.yaml"])
    before = there(robot)
    assert MULTIBOT(["build", "fleet.yaml", "-o", "out", *force]) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert "out/robot1/r.urdf is a file that is read; choose another folder for --output" in said
    assert there(robot) == before


WARNED: dict[str, Command] = {
    "postfix": (POSTFIX, "r.urdf.xacro robot1 robot2 -o {robot}.urdf tf_prefx:={robot}_"),
    "lint": (LINT, "r.urdf.xacro --select MB144 --fail-on error tf_prefx:=x_"),
    "plan": (MULTIBOT, "plan r.urdf.xacro robot1 robot2 tf_prefx:={robot}_"),
    "plan of a fleet": (MULTIBOT, "plan fleet.yaml"),
    "remap": (MULTIBOT, "plan --output-kind table fleet.yaml"),
    "build": (MULTIBOT, "build fleet.yaml -o out"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", WARNED)
def test_a_misspelt_argument_is_said_once(
    name: str, robot: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    fleet = FILES["fleet.yaml"].replace("}", ", arguments: {tf_prefx: '{robot}_'}}")
    (robot / "fleet.yaml").write_text(fleet)
    run, words = WARNED[name]
    assert run(words.split()) == 0
    got = capsys.readouterr()
    (said,) = [it for it in (got.out + got.err).splitlines() if "MB144" in it]
    assert "warning: MB144 argument 'tf_prefx' is given" in said
    assert "did you mean 'tf_prefix'?" in said
