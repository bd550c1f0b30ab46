# SPDX-License-Identifier: Apache-2.0
"""Input that was made to hurt ends, in one clear line, with the documented exit code; as processes,
because that is where a hang, a crash or a traceback would show."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from graph_cases import healthy
from paths import FIXTURES

from multibot_rewrite.system.json import to_json

pytestmark = pytest.mark.slow

# More than any of these takes on a busy machine, and less than what had no end took.
PATIENCE = 60
MANY = 450_000
LINT, POSTFIX, MULTIBOT = "urdf_lint", "urdf_postfix", "multibot"


def robot(inner: str) -> str:
    return f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{inner}</robot>'


def joint(name: str) -> str:
    ends = '<parent link="a"/><child link="b"/>'
    return f'<link name="a"/><link name="b"/><joint name="{name}" type="fixed">{ends}</joint>'


def pattern(text: str) -> str:
    inner = f'<controller type="force"><joint>{text}</joint></controller>'
    library = "libJointControlPlugin.so"
    return f'<gazebo><plugin name="c" filename="{library}">{inner}</plugin></gazebo>'


def fleet(more: str) -> str:
    return f"{more}robots:\n  - {{name: robot1, description: good.urdf}}\n"


GOOD = robot('<link name="a"/>')
DIFF_DRIVE = "libgazebo_ros_diff_drive.so"
SCOPES = "m::" * 100_000
NAMESPACES = " ".join(f'xmlns:n{at}="u{at}"' for at in range(50_000))
ATTRIBUTES = " ".join(f'x{at}="a"' for at in range(300_000))
MESHES = "".join(
    f'<link name="l{at}"><visual><geometry><mesh filename="{"../" * 500}x"/></geometry></visual></link>'
    for at in range(200)
)

# Command -> files with their text, how it ends, words of its last line.
CASES: dict[str, dict[str, tuple[str | bytes, int, str]]] = {
    "urdf_lint in.urdf.xacro": {
        "includes": ("<xacro:include " * (MANY // 15), 1, "1 error"),
        "includes-in-quotes": ('<xacro:include filename="' * (MANY // 25), 1, "1 error"),
    },
    "urdf_lint in.urdf.xacro good.urdf": {
        "includes-unchanged": ("<xacro:include 'a' " * (MANY // 15), 1, "2 files"),
    },
    "urdf_postfix in.urdf r1": {
        "pattern": (robot(joint("a" * 36) + pattern("(a+)+c")), 0, "1 joint"),
        "brackets": (robot(joint("a") + pattern("[" * 100_000)), 0, "1 joint"),
        "attributes": (
            robot(f'<link name="a" {ATTRIBUTES}/>'),
            2,
            "an element has 300,001 attributes, over 1,000; leave some out",
        ),
        "long-values": (
            robot(
                f'<link name="a"/><gazebo><plugin name="p" filename="{DIFF_DRIVE}">'
                f"<left_joint>{'a,' * 100_000}</left_joint></plugin></gazebo>"
            ),
            0,
            "1 link",
        ),
        "null-bytes": (b"\0" * MANY, 2, "the file holds no XML"),
        "two-marks": (b"\xef\xbb\xbf" * 2 + GOOD.encode(), 2, "the file is not XML"),
        "half-a-character": (GOOD.replace("a", "&#xd800;", 1), 2, "correct the XML"),
    },
    "urdf_lint in.urdf": {
        "namespaces": (f"<robot {NAMESPACES}/>", 1, "1 error"),
        "paths": (robot(MESHES), 1, "1 file"),
        "deep-elements": (robot("<a>" * 100_000 + "</a>" * 100_000), 1, "1 error"),
    },
    "urdf_postfix in.sdf r1": {
        "scopes": (
            (
                '<sdf version="1.9"><model name="m"><link name="l"/><joint name="j" type="fixed">'
                f"<parent>{SCOPES}l</parent><child>l</child></joint></model></sdf>"
            ),
            0,
            "1 joint",
        ),
    },
    "multibot snapshot --output-kind nodes --from /dev/zero": {
        "large-snapshot": (b"", 2, "over the limit of"),
    },
    "multibot build in.yaml -o out": {
        "no-nodes": (fleet("nodes: good.urdf\n"), 2, "in.yaml:1: good.urdf:"),
    },
    "multibot build fleet.yaml -o out": {
        "lua-like-xml": ("<<: 1\n", 0, "next: ros2 launch out/fleet.launch.py"),
    },
    "urdf_lint good.urdf --config in.toml": {
        "dotted-keys": (f"a{'.a' * 100_000} = 1\n", 2, "a line with more than 1000 dots"),
        "deep-settings": (f"a = {'[' * 100_000}\n", 2, "TOML that cannot be read"),
    },
}
ENDINGS = (".urdf.xacro", ".urdf", ".sdf", ".yaml", ".json", ".toml")


@pytest.mark.sample(4)
@pytest.mark.parametrize(("words", "name"), [(it, name) for it in CASES for name in CASES[it]])
def test_it_ends_with_one_clear_line(words: str, name: str, tmp_path: Path) -> None:
    text, code, said = CASES[words][name]
    program, *options = words.split()
    (tmp_path / "good.urdf").write_text(GOOD)
    (tmp_path / "fleet.yaml").write_text(fleet("related_files: {lua: in.yaml}\n"))
    for ending in ENDINGS:
        data = text if isinstance(text, bytes) else text.encode()
        (tmp_path / f"in{ending}").write_bytes(data)
    command = [sys.executable, "-m", f"multibot_rewrite.cli.{program}", *options]
    # With two pipes urdf-postfix would tell of failures alone.
    with open(tmp_path / "messages", "w+b") as messages:
        run = subprocess.run(
            command,
            cwd=tmp_path,
            stdout=subprocess.PIPE,
            stderr=messages,
            timeout=PATIENCE,
            check=False,
        )
        messages.seek(0)
        said_all = messages.read().decode()
    lines = said_all.splitlines()
    assert (run.returncode, "Traceback" in said_all) == (code, False), lines[-1:]
    assert said in lines[-1]
    # A value that a message repeats may be a whole file.
    assert max(map(len, lines)) < 1_200
    assert code != 2 or len(lines) == 1


@pytest.mark.parametrize("program", [POSTFIX, LINT])
def test_standard_input_without_an_end(program: str, tmp_path: Path) -> None:
    words = ["-", "robot1"] if program == POSTFIX else ["-"]
    command = [sys.executable, "-m", f"multibot_rewrite.cli.{program}", *words]
    with open("/dev/zero", "rb") as endless:
        run = subprocess.run(
            command, stdin=endless, capture_output=True, timeout=PATIENCE, check=False
        )
    assert run.returncode in (1, 2)
    assert "it is over the limit of 16,777,216 bytes" in (run.stderr + run.stdout).decode()


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("tree.xml", (POSTFIX, "tree.xml", "robot1")),
        ("in.urdf.xacro", (MULTIBOT, "init", "in.urdf.xacro", "--yes")),
        ("in.urdf.xacro", (MULTIBOT, "init", ".", "--yes")),
        ("in.launch.py", (MULTIBOT, "check-launch", "in.launch.py")),
        ("plan.yaml", (MULTIBOT, "check", "plan.yaml", "--from", "plan.yaml")),
    ],
)
def test_nobody_waits_for_a_pipe(name: str, words: tuple[str, ...], tmp_path: Path) -> None:
    os.mkfifo(tmp_path / name)
    program, *rest = words
    command = [sys.executable, "-m", f"multibot_rewrite.cli.{program}", *rest]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, timeout=PATIENCE, check=False)
    assert run.returncode == 2
    assert run.stderr.count(b"\n") == 1 and b"Traceback" not in run.stderr


def test_links_in_a_circle_pipes_and_folders_are_told_or_left_out(tmp_path: Path) -> None:
    # Beside it are the folders of all other tests.
    here = tmp_path / "here"
    here.mkdir()
    (here / "good.urdf").write_text(GOOD)
    os.mkfifo(here / "pipe.urdf")
    os.symlink("loop.urdf", here / "loop.urdf")
    os.symlink("..", here / "above")
    os.symlink("/dev/zero", here / "zero.urdf")
    (here / "folder.urdf").mkdir()
    command = [sys.executable, "-m", "multibot_rewrite.cli.urdf_lint", "."]
    run = subprocess.run(command, cwd=here, capture_output=True, timeout=PATIENCE, check=False)
    assert run.returncode == 1
    found = {line.partition(":")[0] for line in run.stdout.decode().splitlines()}
    assert {Path(it).name for it in found} >= {"loop.urdf"}
    assert b"Traceback" not in run.stderr


def test_a_plan_and_a_snapshot_may_be_as_large_as_a_fleet(tmp_path: Path) -> None:
    """Both hold some ten kB a robot; what is added here is what their readers skip."""
    room = 17 * 2**20
    plan, graph = tmp_path / "plan.yaml", tmp_path / "graph.json"
    plan.write_text((FIXTURES / "graphs" / "plan.yaml").read_text() + f"#{'x' * room}\n")
    graph.write_bytes(to_json(healthy("frames-per-robot")) + b" " * room)
    command = [sys.executable, "-m", "multibot_rewrite.cli.multibot", "check", str(plan)]
    run = subprocess.run(
        [*command, "--from", str(graph)], capture_output=True, timeout=PATIENCE, check=False
    )
    assert (run.returncode, run.stderr.decode()) == (
        0,
        "multibot: 2 robots, 8 nodes each: all known, all seen; 0 findings: as planned (ROS 2"
        " jazzy)\n",
    )
