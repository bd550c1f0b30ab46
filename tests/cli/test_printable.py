# SPDX-License-Identifier: Apache-2.0
"""No name of a file, a description or the live graph steers the terminal or fakes a line."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from fleet_folder import SMALL, fleet_folder
from graph_cases import healthy, read_plan

from multibot_rewrite.base.findings.formats import FORMATS
from multibot_rewrite.base.wording import for_terminal, one_line
from multibot_rewrite.cli import multibot, urdf_lint, urdf_postfix
from multibot_rewrite.cli.declared.commands import COMMANDS
from multibot_rewrite.cli.output import print_bytes
from multibot_rewrite.planning.plan import to_yaml
from multibot_rewrite.system.json import to_json

FAKED = "FAKE: all is well"
# ESC ] 0 ; ... BEL names a window, U+009B 2 J clears it, U+202E turns the text.
EVIL = f"e\x1b]0;x\x07\x9b2J\u202e\n{FAKED}\r\n"
IN_XML = f"e&#x9b;2J&#x202e;&#10;{FAKED}&#13;&#10;"
# What a person may be shown: no controls but the end of a line, nothing that turns.
STEERING = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")
LAYOUT = "frames-per-robot"
DESCRIPTION = f"""<robot name="r {IN_XML}">
  <link name="base_link"/>
  <link name="{IN_XML}"/>
  <joint name="{IN_XML}" type="fixed"><parent link="base_link"/><child link="{IN_XML}"/></joint>
  <joint name="{IN_XML}" type="{IN_XML}"><parent link="nobody{IN_XML}"/><child link="x"/></joint>
  <gazebo reference="none{IN_XML}">
    <plugin name="{IN_XML}" filename="lib{IN_XML}.so">
      <frame a="{IN_XML}">{IN_XML}</frame>
      <other>base_link</other>
    </plugin>
    <plugin name="x" filename="libgazebo_ros_diff_drive.so">
      <ros><namespace>{IN_XML}</namespace><remapping>odom:={IN_XML}</remapping></ros>
      <left_joint>{IN_XML}</left_joint>
    </plugin>
  </gazebo>
  <ros2_control name="{IN_XML}" type="system">
    <hardware><plugin>{IN_XML}</plugin><param name="{IN_XML}">{IN_XML}</param></hardware>
    <joint name="gone{IN_XML}"/>
  </ros2_control>
</robot>
"""
XACRO = f"""<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="a" default="{IN_XML}"/>
  <xacro:arg name="{IN_XML}" default="{IN_XML}"/>
  <link name="$(arg a){IN_XML}"/>
</robot>
"""


@pytest.fixture
def folder(here: Path) -> Path:
    """Files with names that no terminal should obey, in and on them."""
    (here / f"{EVIL}.urdf").write_text(DESCRIPTION)
    (here / f"{EVIL}.xml").write_text("<robot")
    (here / f"{EVIL}.xacro").write_text(XACRO)
    (here / f"{EVIL}.lint.urdf").write_text('<robot name="r"><link name="a "/></robot>')
    head = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    argument = f'<xacro:arg name="prefix" default="{IN_XML}"/><link name="$(arg prefix)"/>'
    (here / f"{EVIL}.xacro").write_text(f"{head}{argument}</robot>")
    (here / "cut.urdf").write_text(DESCRIPTION[:-20])
    fleet_folder(here, SMALL.replace("rover.urdf", json.dumps(f"{EVIL}.urdf")))
    (here / f"{EVIL}.yaml").write_text(json.dumps({EVIL: [{EVIL: EVIL}]}))
    plan, graph = read_plan(LAYOUT), healthy(LAYOUT)
    (here / "plan.yaml").write_text(to_yaml(plan))
    (here / f"{EVIL}.plan").write_text(to_yaml(plan))
    frames = tuple(it._replace(child=f"{it.child}{EVIL}") for it in graph.edges)
    nodes = tuple(it._replace(name=f"{it.name}{EVIL}") for it in graph.nodes)
    ends = tuple(it._replace(node=f"{it.node}{EVIL}", type=EVIL) for it in graph.ends)
    evil = graph._replace(edges=(*graph.edges, *frames), nodes=nodes, ends=ends)
    (here / "graph.json").write_bytes(to_json(evil))
    (here / f"{EVIL}.json").write_bytes(to_json(graph)[:-9])
    return here


PROGRAMS: dict[str, Callable[[list[str]], int]] = {
    "urdf-postfix": urdf_postfix.main,
    "urdf-lint": urdf_lint.main,
}
FILE = f"{EVIL}.urdf"
LINES = (
    *(["urdf-postfix", FILE, "robot1", "robot2", "-o", f"{EVIL}/{{robot}}"],),
    *(["urdf-postfix", FILE, "robot1", "--force", "--fail-on", "warning"],),
    *(["urdf-postfix", FILE, EVIL],),
    *(["urdf-postfix", "--undo", FILE, "robot1"],),
    *(["urdf-postfix", f"{EVIL}.xml", "robot1"], ["urdf-postfix", "cut.urdf", "robot1"]),
    *(["urdf-postfix", f"{EVIL}.none", "robot1"], ["urdf-postfix", FILE, "r", f"--{EVIL}"]),
    *(["urdf-postfix", "--why", f"{FILE}:{line}"] for line in range(2, 22)),
    *(["urdf-lint", "."], ["urdf-lint", FILE, "cut.urdf"], ["urdf-lint", f"{EVIL}.none"]),
    *(["urdf-lint", FILE, "--format", it] for it in FORMATS),
    *(["urdf-lint", FILE, "--select", EVIL], ["urdf-lint", ".", "--config", EVIL]),
    *(
        ["urdf-lint", f"{EVIL}.lint.urdf", "--fix", "--diff"],
        ["urdf-lint", f"{EVIL}.xacro"],
        ["urdf-postfix", f"{EVIL}.xacro", "robot1", f"{EVIL}:={EVIL}"],
        ["inspect", f"{EVIL}.xacro"],
        ["inspect", f"{EVIL}.xacro", "--output-kind", "json"],
    ),
    *(["inspect", "--suggest", FILE], ["inspect", EVIL]),
    *(["inspect", f"{EVIL}.xacro"], ["inspect", f"{EVIL}.xacro", f"a:={EVIL}"]),
    *(["urdf-postfix", f"{EVIL}.xacro", "r", f"a:={EVIL}{{robot}}"]),
    *(
        ["inspect", f"MB,{EVIL}"],
        ["help", EVIL],
        [EVIL],
        ["plan", "--output-kind=table", FILE, "robot1", "--node-set", EVIL],
    ),
    *(
        [
            "plan",
            "--output-kind=table",
            FILE,
            "robot1",
            "robot2",
            "--node-set",
            "nav2",
            "--output-kind",
            it,
        ]
        for it in ("table",)
    ),
    *(
        [
            "plan",
            "--output-kind=table",
            FILE,
            "robot1",
            "--nodes",
            f"{EVIL}.yaml",
            "--node-set",
            "nav2",
        ],
    ),
    *(["plan", FILE, "robot1", "robot2", "--node-set", "nav2", "-o", EVIL],),
    *(["check", "plan.yaml", "--from", "graph.json"],),
    *(["check", "plan.yaml", "--from", "graph.json", "--format", it] for it in ("text",)),
    *(["check", f"{EVIL}.plan", "--from", "graph.json", "--verbose"],),
    *(["check", "plan.yaml", "--from", f"{EVIL}.json"],),
    *(
        ["check", f"{EVIL}.yaml", "--from", "graph.json"],
        ["snapshot", "--output-kind", "nodes", "--from", "graph.json"],
    ),
    *(["build", "fleet.yaml", "-o", f"{EVIL}out"], ["build", f"{EVIL}.yaml", "-o", "out"]),
    *(["check", "--from", "graph.json"], ["check", "--from", f"{EVIL}.json"]),
    *(["check", "--from", "graph.json", "--suggest", f"{EVIL}out"],),
    *(["build", "fleet.yaml", "-o", "out", "--check"],),
    *(["init", ".", "-o", "-"], ["init", f"{EVIL}.xacro", f"a:={EVIL}", "-o", f"{EVIL}f.yaml"]),
    *(["check-launch", f"{EVIL}.launch.py"], ["check-launch", EVIL, "x.launch.py"]),
    *(["view", FILE, "-o", f"{EVIL}.html"], ["view", f"{EVIL}.yaml"], ["view", FILE, EVIL]),
    *(
        ["adopt", "."],
        ["adopt", EVIL],
        ["adopt", ".", EVIL],
        ["rename", EVIL, "b", "."],
        ["completion", EVIL],
    ),
    *(["join", FILE, EVIL, "--at", EVIL], ["join", FILE, FILE, "--at", EVIL, "--prefix", "a_"]),
    *(["rename", "a", EVIL, "."], ["rename", "a", "b", EVIL]),
    *(["rehearse", FILE, "robot1", "--node-set", EVIL], ["snapshot", "--domain", EVIL]),
)


def test_every_command_is_tried() -> None:
    tried = {words[0] for words in LINES}
    assert {*COMMANDS, *PROGRAMS} <= tried


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    "words", LINES, ids=[f"{number}-{words[0][:12]}" for number, words in enumerate(LINES)]
)
def test_a_name_does_not_steer_the_terminal(
    words: list[str], folder: Path, capfdbinary: pytest.CaptureFixture[bytes]
) -> None:
    try:
        program = PROGRAMS.get(words[0])
        _ = program(words[1:]) if program else multibot.main(words)
    except SystemExit:
        pass
    out, err = capfdbinary.readouterr()
    text = err.decode("utf-8", "surrogateescape")
    # What is made of a description holds its names as they are, for programs.
    if not (out.startswith(b"<robot") or "--suggest" in words or "nodes" in words):
        text += out.decode("utf-8", "surrogateescape")
    assert text or out
    assert STEERING.findall(text) == []
    assert [line for line in text.splitlines() if line.startswith(FAKED)] == []
    assert "Traceback" not in text


def test_a_terminal_gets_a_document_without_what_it_would_obey(
    monkeypatch: pytest.MonkeyPatch, capfdbinary: pytest.CaptureFixture[bytes]
) -> None:
    data = "<a b='\x9b2J\u202e'>\t\x1b[31mred\x1b[0m\x1b]0;x\x07</a>\n".encode() + b"\xff"
    print_bytes(data)
    assert capfdbinary.readouterr().out == data
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    print_bytes(data)
    shown = b"<a b='\\x9b2J\\u202e'>\t\x1b[31mred\x1b[0m\\x1b]0;x\\x07</a>\n\\udcff"
    assert capfdbinary.readouterr().out == shown


@pytest.mark.parametrize(
    ("text", "line", "shown"),
    [
        ("plain ä 中 😀", "plain ä 中 😀", "plain ä 中 😀"),
        ("a\tb\nc", "a\\tb\\nc", "a\tb\nc"),
        ("\x1b[1mbold\x1b[0m", "\\x1b[1mbold\\x1b[0m", "\x1b[1mbold\x1b[0m"),
        ("\x1b[2J\x1b[31", "\\x1b[2J\\x1b[31", "\\x1b[2J\\x1b[31"),
        ("\r\x07\x7f\x85", "\\r\\x07\\x7f\\x85", "\\r\\x07\\x7f\\x85"),
        ("\u200e\u2066\ufeff", "\\u200e\\u2066\ufeff", "\\u200e\\u2066\ufeff"),
    ],
)
def test_what_is_shown_of_a_text(text: str, line: str, shown: str) -> None:
    assert (one_line(text), for_terminal(text)) == (line, shown)
