# SPDX-License-Identifier: Apache-2.0
"""Files that want more than to be expanded: nothing outside is touched, and each ends in one line."""

from __future__ import annotations

import os
import re
import shutil
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

import pytest
from paths import FIXTURES

from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.__main__ import main as tell_fences
from multibot_rewrite.description.sources.access import Access, Reach
from multibot_rewrite.description.sources.child import fences, seccomp
from multibot_rewrite.description.sources.child.frames import (
    AUDIT,
    FENCES,
    LANDLOCK,
    LIMITS,
    SECCOMP,
)
from multibot_rewrite.description.sources.conversation import Sources, converse
from multibot_rewrite.description.sources.expand import expand

HOSTILE = FIXTURES / "hostile"
SECRET = "canary-71f3"
# What the hostile files send.
SENT = b"taken"
REFUSED, TRUST, TIME, ENDED, WRONG = (
    "refused: ",
    "--trust",
    "took more",
    "its process",
    "wrong answer",
)
# What is said of each file; None where it is expanded, and has got nothing.
SAID: dict[str, tuple[str, ...] | None] = {
    "abstract_socket": (REFUSED, TRUST),
    "builtin_importer": (REFUSED, TRUST),
    "bytecode": (REFUSED, TRUST),
    "chmod": (REFUSED, "chmod", TRUST),
    "code_of_passwd": ("__import__",),
    "ctypes_system": (REFUSED, "ctypes", TRUST),
    "entity": None,
    "env": ("MULTIBOT_SECRET", "ROS's variables alone", TRUST),
    "environ": None,
    "exec": (REFUSED, "exec", TRUST),
    "exit": (REFUSED, "_exit", TRUST),
    "find_up": ("is no name of a package",),
    "forged_length": (REFUSED, TRUST),
    "forged_report": (REFUSED, TRUST),
    "fork_bomb": (REFUSED, "fork", TRUST),
    "fork_exec": (REFUSED, TRUST),
    "frames": (REFUSED, TRUST),
    "glob_root": ("outside of the folders", TRUST),
    "glob_up": ("outside of the folders", TRUST),
    "hook": (REFUSED, TRUST),
    "include_above": ("outside of the folders", TRUST, "--roots"),
    "include_device": ("outside of the folders", TRUST),
    "include_hidden": ("is hidden", TRUST),
    "include_link": ("link.xacro is outside of the folders", TRUST),
    "include_optional": ("outside of the folders", TRUST),
    "include_passwd": ("/etc/passwd is outside of the folders", TRUST),
    "include_pipe": ("no regular file", TRUST),
    "include_url": ("No such file",),
    "lambda_system": (REFUSED, "system", TRUST),
    "laughs": ("amplification", "entities"),
    "list_root": (REFUSED, "listdir", TRUST),
    "macro_bomb": (TIME,),
    "macro_recursion": ("recursion", "leads back to itself"),
    "make_nodes": (REFUSED, "mkfifo", TRUST),
    "memory": ("MemoryError",),
    "memory_list": ("MemoryError",),
    "message": ("aaaa",),
    "nested_report": (REFUSED, TRUST),
    "no_alarm": (TRUST,),
    "notes": None,
    "open_passwd": (REFUSED, "/etc/passwd", TRUST),
    "optenv": ("MULTIBOT_SECRET", "ROS's variables alone", TRUST),
    "os_open_passwd": (REFUSED, "/etc/passwd", TRUST),
    "output": ("over the limit",),
    "path_socket": (REFUSED, TRUST),
    "poison": None,
    "popen": (REFUSED, TRUST),
    "posix_spawn": (REFUSED, "posix_spawn", TRUST),
    "power": (TIME,),
    "proc_environ": (REFUSED, "environ", TRUST),
    "proc_memory": (REFUSED, "mem", TRUST),
    "ptrace": (REFUSED, "ctypes", TRUST),
    "questions": ("xacro failed",),
    "raw_signal": (REFUSED, "ctypes", TRUST),
    "recursion": ("recursion",),
    "remove_file": (REFUSED, "remove", TRUST),
    "segfault": (REFUSED, "ctypes", TRUST),
    "signal_parent": (REFUSED, "kill", TRUST),
    "sleep": (TRUST,),
    "stat_secret": (REFUSED, "stat", TRUST),
    "subprocess": (REFUSED, TRUST),
    "system_exit": (ENDED,),
    "tcp": (REFUSED, TRUST),
    "terminal": None,
    "threads": ("thread", TRUST),
    "udp": (REFUSED, TRUST),
    "urlopen": (REFUSED, TRUST),
    "vars_of_type": (REFUSED, "system", TRUST),
    "write_descriptors": (REFUSED, TRUST),
    "write_file": (REFUSED, TRUST),
    "yaml_passwd": ("/etc/passwd is outside of the folders", TRUST),
}
ALONE = (AUDIT, LANDLOCK, SECCOMP)
# Without a limit on memory these would be a burden for the machine.
LARGE = {"memory", "memory_list"}
BRIEF = 0.5
ENDLESS = {"macro_bomb", "no_alarm", "power", "questions", "sleep"}
# What Landlock alone does not cover: it is no filter of system calls.
BESIDE_LANDLOCK = {"udp", "fork_bomb", "threads", "chmod", "stat_secret"}


class Scene(NamedTuple):
    """A robot with hostile files beside it, and what they are after, which is outside of it."""

    robot: Path
    arguments: dict[str, str]
    listeners: list[socket.socket]
    other: subprocess.Popen[bytes]

    def file(self, name: str) -> str:
        return str(self.robot / "urdf" / f"{name}.xacro")

    def said(self, name: str, fences: tuple[str, ...] = FENCES) -> str:
        """Return the message for a file, or its text."""
        try:
            reach = Reach(seconds=BRIEF if name in ENDLESS else 60.0, fences=fences)
            return expand(self.file(name), self.arguments, reach=reach).decode()
        except InputError as error:
            assert "\n" not in str(error)
            return str(error)

    def check_untouched(self) -> None:
        """Nothing was made, changed, sent, or ended."""
        outside = self.robot.parent / "outside"
        assert [it.name for it in outside.iterdir()] == ["secret.xacro"]
        secret = outside / "secret.xacro"
        assert (secret.read_text(), secret.stat().st_mode & 0o777) == (SECRET, 0o600)
        for listener in self.listeners:
            with pytest.raises(BlockingIOError):
                received(listener) if listener.type == socket.SOCK_DGRAM else listener.accept()
        assert self.other.poll() is None
        state = Path(f"/proc/{self.other.pid}/stat").read_text().rpartition(")")[2].split()[0]
        # Not stopped, traced or ended; on a busy machine it may still wait for its disk.
        assert state in "RSD"


@pytest.fixture
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Scene]:
    outside, robot = tmp_path / "outside", tmp_path / "robot"
    outside.mkdir()
    secret = outside / "secret.xacro"
    secret.write_text(SECRET)
    secret.chmod(0o600)
    shutil.copytree(HOSTILE, robot / "urdf")
    (robot / "urdf" / "link.xacro").symlink_to(secret)
    (robot / "urdf" / ".git").mkdir()
    (robot / "urdf" / ".git" / "config").write_text(SECRET)
    (robot / "urdf" / "part.yaml").write_text("a: 1")
    os.mkfifo(robot / "urdf" / "pipe.xacro")
    monkeypatch.setenv("MULTIBOT_SECRET", SECRET)
    name = f"multibot-{os.getpid()}"
    listeners = listening(name)
    arguments = {"target": str(outside / "taken"), "secret": str(secret), "name": name}
    arguments["port"] = str(listeners[0].getsockname()[1])
    with subprocess.Popen(["sleep", "600"]) as other:
        yield Scene(robot, {**arguments, "pid": str(other.pid)}, listeners, other)
        other.kill()
    for it in listeners:
        it.close()


def listening(name: str) -> list[socket.socket]:
    """Sockets of TCP, UDP on the same port, and an abstract one."""
    tcp, udp = one_port()
    abstract = socket.socket(socket.AF_UNIX)
    abstract.bind(f"\0{name}")
    for it in (tcp, abstract):
        it.listen()
    for it in (tcp, udp, abstract):
        it.setblocking(False)
    return [tcp, udp, abstract]


def received(listener: socket.socket) -> None:
    """Take what came, which may be of ROS nodes of others that look for each other on every port; one
    of a hostile file ends it."""
    while listener.recv(2**16) != SENT:
        pass


def one_port() -> tuple[socket.socket, socket.socket]:
    """Return sockets of TCP and UDP on one port; nodes of other tests may have the second."""
    for _ in range(50):
        tcp, udp = socket.socket(), socket.socket(type=socket.SOCK_DGRAM)
        tcp.bind(("127.0.0.1", 0))
        with suppress(OSError):
            udp.bind(tcp.getsockname())
            return tcp, udp
        tcp.close()
        udp.close()
    raise AssertionError("no port is free for both")


def check_nothing_told(said: str) -> None:
    assert SECRET not in said
    assert "root:" not in said
    assert "\x1b" not in said


def test_every_file_has_its_expectation() -> None:
    assert {it.stem for it in HOSTILE.glob("*.xacro")} == set(SAID)
    assert len(SAID) >= 30


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", SAID)
def test_a_hostile_file_gets_nothing(
    scene: Scene, name: str, capfd: pytest.CaptureFixture[str]
) -> None:
    said = scene.said(name)
    check_nothing_told(said)
    scene.check_untouched()
    words = SAID[name]
    assert said.startswith("<?xml") == (words is None), said
    assert [word for word in words or () if word not in said] == [], said
    check_nothing_told(capfd.readouterr().err)


def have(fence: str) -> bool:
    return {LANDLOCK: fences.version() > 0, SECCOMP: os.uname().machine in seccomp.MACHINES}.get(
        fence, True
    )


@pytest.mark.sample(10)
@pytest.mark.slow
@pytest.mark.parametrize("fence", ALONE)
@pytest.mark.parametrize(
    ("name", "more"),
    [
        *((name, (LIMITS,)) for name in sorted(SAID)),
        # An endless file is ended by its parent then, whatever it does: one of them is enough.
        *((name, ()) for name in sorted(set(SAID) - LARGE - (ENDLESS - {"sleep"}))),
    ],
)
def test_each_fence_holds_without_the_others(
    scene: Scene, name: str, more: tuple[str, ...], fence: str
) -> None:
    if not have(fence):
        pytest.skip(f"this kernel has no {fence}")
    if fence == LANDLOCK and name in BESIDE_LANDLOCK:
        pytest.skip("Landlock is not for this")
    check_nothing_told(scene.said(name, (fence, *more)))
    scene.check_untouched()


def test_all_fences_are_there(scene: Scene) -> None:
    """Those that this kernel has; one that fails while it is put up would not be missed otherwise."""
    access = Access(scene.file("poison"), Reach(), None)
    held = converse({}, Sources(access, {}), traced=False).fences
    assert held == tuple(it for it in FENCES if have(it))


def test_a_user_can_ask_for_the_fences(capsys: pytest.CaptureFixture[str]) -> None:
    tell_fences()
    told = dict(line.split(": ") for line in capsys.readouterr().out.splitlines())
    assert told == {it: "yes" if have(it) else "no" for it in FENCES}


@pytest.mark.slow
def test_a_line_says_where_no_fence_of_the_kernel_is(scene: Scene) -> None:
    """As in a container that forbids both: the other two stand, and the file gets nothing."""
    wrapper = str(Path(__file__).parents[2] / "support" / "without_kernel_fences.py")

    def run(*call: str) -> subprocess.CompletedProcess[str]:
        whole = [sys.executable, wrapper, *call]
        return subprocess.run(whole, capture_output=True, text=True, check=False)

    held = run("multibot_rewrite.description.sources").stdout.split()
    assert held == ["landlock:", "no", "limits:", "yes", "seccomp:", "no", "audit:", "yes"]
    done = run("multibot_rewrite", "inspect", scene.file("include_above"))
    assert done.stderr.count("neither Landlock nor seccomp (SECURITY.md)") == 1
    check_nothing_told(done.stdout + done.stderr)
    scene.check_untouched()


HELD = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="load" value="${(lambda: [c for c in ().__class__.__base__.__subclasses__()
    if c.__name__ == 'catch_warnings'][0]()._module.__builtins__['__import__'])()}"/>
  <link name="${[load('os').readlink('/proc/self/fd/' + str(i)) for i in range(64)
    if load('os').path.exists('/proc/self/fd/' + str(i))]}"/>
  <link name="${list(load('os').environ)} ${load('os').readlink('/proc/self/cwd')}"/>
</robot>"""


# Python itself sets one, the libraries of its installation need the others.
OF_PYTHON = {"LC_CTYPE", "LD_LIBRARY_PATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE"}


def test_a_child_has_nothing_but_its_socket(tmp_path: Path) -> None:
    """Without fences it could look: three times /dev/null, the socket, no variable, no folder."""
    (tmp_path / "r.xacro").write_text(HELD)
    with open(tmp_path / "open", "wb"):
        text = expand(str(tmp_path / "r.xacro"), {}, reach=Reach(trust=True)).decode()
    descriptors, rest = re.findall('link name="(.*)"', text)
    opened = re.findall(r"'(.*?)'", descriptors)
    # libffi from 3.5 on, which ctypes loads, keeps its own library open to map it.
    held = [it for it in opened if not re.search(r"/libffi(-\w+)?\.so", it)]
    assert held[:3] == [os.devnull] * 3
    assert [it.partition(":")[0] for it in held[3:]] == ["socket"]
    variables, _, folder = rest.partition("] ")
    assert (set(re.findall(r"\w+", variables)) - OF_PYTHON, folder) == (set(), "/")
