# SPDX-License-Identifier: Apache-2.0
"""xacro has one state a process: threads and forks that expand at once get their own results."""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from paths import fixture_text
from waiting import wait_until

from multibot_rewrite import rewrite
from multibot_rewrite.description.sources import processes

FILE = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="side" default="none"/><xacro:property name="side" value="$(arg side)"/>
<xacro:macro name="arm" params="n"><link name="${side}_${n}"/>
<joint name="${side}_j${n}" type="fixed"><parent link="base"/><child link="${side}_${n}"/></joint>
</xacro:macro><link name="base"/><xacro:arm n="1"/><xacro:arm n="2"/></robot>"""
SIDES = [f"s{at}" for at in range(8)]
# A cold start: the server and the tree of rewriters are made by eight threads at once.
COLD = fixture_text("xacro_threads_cold.txt")
FEW, MANY = 2, 20


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "r.urdf.xacro"
    path.write_text(FILE)
    return path


def check_cold_starts(file: Path, times: int) -> None:
    for _ in range(times):
        done = subprocess.run(
            [sys.executable, "-c", COLD, str(file)], capture_output=True, text=True, check=True
        )
        assert (done.stdout, done.stderr) == ("[]\n", "")


@pytest.mark.slow
def test_threads_of_a_fresh_process(file: Path) -> None:
    check_cold_starts(file, FEW)


@pytest.mark.deep
def test_threads_of_many_fresh_processes(file: Path) -> None:
    check_cold_starts(file, MANY)


def _rewritten(file: str, side: str, results: multiprocessing.Queue[str]) -> None:
    text = rewrite(file, "robot1", xacro_args={"side": side}).text
    with processes.child(9.0) as child:
        status = Path(f"/proc/{child.server.pid}/stat").read_text().rpartition(")")[2].split()
    # The server is a child of this process, and not of the one that it was forked from.
    results.put(text if int(status[1]) == os.getpid() else "")


@pytest.mark.more
def test_a_fork_does_not_talk_to_the_server_of_its_parent(file: Path) -> None:
    """Both use it at once: answers would go to the wrong one."""
    rewrite(file, "robot1")
    context = multiprocessing.get_context("fork")
    results: multiprocessing.Queue[str] = context.Queue()
    forks = [context.Process(target=_rewritten, args=(str(file), it, results)) for it in SIDES[:3]]
    for fork in forks:
        fork.start()
    own = rewrite(file, "robot1", xacro_args={"side": "mine"}).text
    texts = [results.get(timeout=60) for _ in forks]
    for fork in forks:
        fork.join()
    assert own.count('"mine_1/robot1"') == 2
    assert sorted(side for text in texts for side in SIDES if f'"{side}_1/' in text) == SIDES[:3]


@pytest.mark.slow
def test_an_idle_server_that_ended_is_started_again(file: Path) -> None:
    text = rewrite(file, "robot1").text
    server = processes.server(os.getpid())
    server.control.close()
    assert rewrite(file, "robot1").text == text


@pytest.mark.slow
def test_no_process_is_left(file: Path) -> None:
    code = f"from multibot_rewrite import rewrite; rewrite({str(file)!r}, 'robot1')"
    with subprocess.Popen([sys.executable, "-c", code], start_new_session=True) as run:
        assert run.wait() == 0
    wait_until(lambda: run.pid not in {_session(it) for it in Path("/proc").glob("[0-9]*")})


def _session(process: Path) -> int:
    try:
        return int((process / "stat").read_text().rpartition(")")[2].split()[3])
    except OSError:
        return 0


def test_one_file_does_not_change_what_the_next_one_gets(file: Path, tmp_path: Path) -> None:
    text = rewrite(file, "robot1").text
    escape = (
        "(lambda: [c for c in ().__class__.__base__.__subclasses__() "
        "if c.__name__ == 'catch_warnings'][0]()._module.__builtins__['__import__'])()"
    )
    hostile = tmp_path / "hostile.urdf.xacro"
    hostile.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        f'<xacro:property name="load" value="${{{escape}}}"/><link name="a${{load(\'builtins\')'
        ".setattr(load('xacro'), 'safe_eval', lambda *_: 'taken')}\"/><link name=\"${1}\"/></robot>"
    )
    assert '"taken/robot1"' in rewrite(hostile, "robot1").text
    assert rewrite(file, "robot1").text == text
    assert threading.active_count() < 10
