# SPDX-License-Identifier: Apache-2.0
"""What a launch file can do behind its fences: each row is a line of Python that one has."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest
from paths import FIXTURES, ROOT, fixture_text

from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.child import fences
from multibot_rewrite.producers.launch.child import read_launch_files
from multibot_rewrite.producers.launch.records import LaunchGraph, LaunchOrder

# Before it HERE is its folder, OUT one of another package; DONE is what is there when it is done.
ALLOWED = (
    "__import__('tempfile').NamedTemporaryFile('w', delete=False).write('a')",
    "__import__('tempfile').TemporaryDirectory().cleanup()",
    "(lambda d: (os.makedirs(d + '/a'), open(d + '/a/b', 'w').close(),"
    " shutil.move(d + '/a/b', d + '/c'), shutil.copy2(d + '/c', d + '/d'),"
    " shutil.rmtree(d)))(tempfile.mkdtemp())",
    "open(HERE + '/near.txt').read()", "os.listdir(HERE)", "open(os.devnull, 'w').write('a')",
    "__import__('xml.dom.minidom').dom.minidom.parseString('<a/>')", "__import__('math').pi",
    "__import__('random').random()", "__import__('uuid').uuid4()", "os.cpu_count()",
    "__import__('datetime').datetime.now().astimezone()", "__import__('time').sleep(0.01)",
    "__import__('socket').gethostname()", "os.environ['HOME']", "os.environ.get('NOBODY_HAS_IT')",
    "os.chmod(OUT, 0o777)", "os.utime(OUT + '/far.txt')",
)  # fmt: skip
REFUSED = (
    "open(HERE + '/made', 'w')", "open(HERE + '/near.txt', 'a')", "open(OUT + '/far.txt').read()",
    "os.open(HERE + '/near.txt', os.O_RDONLY | os.O_TRUNC)", "os.remove(HERE + '/near.txt')",
    "os.mkdir(HERE + '/made')", "os.rename(HERE + '/near.txt', HERE + '/made')",
    "os.truncate(HERE + '/near.txt', 0)", "os.symlink(OUT, tempfile.gettempdir() + '/l')",
    "os.link(OUT + '/far.txt', tempfile.gettempdir() + '/l')", "os.listdir(OUT)",
    "open('/etc/passwd').read()", "os.listdir('/root')", "open('/proc/self/environ', 'rb').read()",
    "__import__('socket').socket()", "__import__('socket').socketpair()", "os.fork()",
    "os.execv('/bin/true', ['true'])", "os.posix_spawn('/bin/true', ['true'], {})",
    "os.kill(os.getppid(), 0)", "os.kill(os.getpid(), 0)",
    "__import__('fcntl').fcntl(0, __import__('fcntl').F_SETOWN, os.getppid())",
    "os.environ['A_SECRET']", "os.environ.get('A_SECRET')", "os.getenv('A_SECRET')",
    "ctypes.CDLL(None, use_errno=True).chmod(OUT.encode(), 0o700) and raised(ctypes.get_errno())",
)  # fmt: skip
FILE = fixture_text("confined_file.txt")


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    """Return a folder with a package, in which a launch file will be, and one that is none of its."""
    (tmp_path / "own").mkdir()
    (tmp_path / "own/package.xml").write_text("<package><name>own</name></package>")
    (tmp_path / "other").mkdir(mode=0o755)
    (tmp_path / "own/near.txt").write_text("near")
    (tmp_path / "other/far.txt").write_text("far")
    return tmp_path


def there(folder: Path) -> dict[str, tuple[int, int, bytes]]:
    files = [it for it in folder.rglob("*") if it.suffix != ".py"]
    return {
        str(it): (it.stat().st_mode, it.stat().st_mtime_ns, b"" if it.is_dir() else it.read_bytes())
        for it in files
    }


def read(file: Path, trust: bool = False) -> LaunchGraph:
    (found,) = read_launch_files([LaunchOrder(str(file), trusted=trust)], 60.0)
    assert isinstance(found, LaunchGraph), found
    return found


# What is asked of a machine, what is seen of it, and what is named.
MACHINE = (
    ("os.listdir('/dev')", "[]", "/dev"),
    ("[it.name for it in os.scandir('/dev/')]", "[]", "/dev"),
    ("list(__import__('pathlib').Path('/dev').iterdir())", "[]", "/dev"),
    ("__import__('glob').glob('/dev/tt*')", "[]", "/dev"),
    ("__import__('glob').glob('/dev/tty')", "[]", "/dev/tty"),
    ("[*os.walk('/sys/class/net')]", "[('/sys/class/net', [], [])]", "/sys/class/net"),
    ("[*__import__('pathlib').Path('/sys/class').glob('n*')]", "[]", "/sys/class"),
    ("os.path.exists('/dev/tty')", "False", "/dev/tty"),
    ("os.path.isdir('/proc/self')", "False", "/proc/self"),
    ("os.path.islink(b'/dev/../proc/self')", "False", "/proc/self"),
    ("__import__('pathlib').Path('/dev/tty').exists()", "False", "/dev/tty"),
    ("os.access('/dev/tty', os.R_OK)", "False", "/dev/tty"),
    ("swallowed(lambda: __import__('socket').socket())", "None", "the network"),
    ("swallowed(lambda: __import__('socket').gethostbyname('a'))", "None", "the network"),
    ("os.path.exists(os.devnull)", "True", ""), ("os.path.exists(HERE)", "True", ""),
    ("os.path.exists('/devices')", "False", ""), ("os.stat(0) is not None", "True", ""),
)  # fmt: skip
ASKS = """import os
from launch import LaunchDescription
from launch_ros.actions import Node
HERE = os.path.dirname(__file__)
def swallowed(call):
    try:
        call()
    except OSError:
        pass
def generate_launch_description():
    return LaunchDescription([Node(package="p", executable=repr(LINE))])
"""


@pytest.mark.parametrize(("line", "seen", "named"), MACHINE)
def test_a_launch_file_sees_nothing_of_a_machine(
    line: str, seen: str, named: str, kept: Path
) -> None:
    """Another one has other devices: the file is read as where none is there, and that is said."""
    file = kept / "own/a.launch.py"
    file.write_text(ASKS.replace("LINE", line))
    found = read(file)
    assert [it.executable for it in found.nodes] == [seen]
    said = f"it looks at {named} of the machine, and sees nothing of it here; --trust shows it"
    assert [(it.message, it.parameters) for it in found.notes] == ([(said, True)] if named else [])
    assert not read(file, trust=True).notes


def test_a_device_in_a_parameter_is_not_looked_at(kept: Path) -> None:
    """Whether a parameter's text is a file that is there is asked by the reader, not by the file."""
    file = kept / "own/a.launch.py"
    node = 'parameters=[{"serial_port": "/dev/ttyUSB0"}], arguments=["-file", "/dev/ttyUSB0"])'
    file.write_text(ASKS.replace("executable=repr(LINE))", f'executable="e", {node}'))
    assert not read(file).notes


def test_a_launch_file_waits_for_nothing(kept: Path) -> None:
    """What it would wait for is not started; where it may start it, it waits."""
    file = kept / "own/a.launch.py"
    file.write_text(ASKS.replace("LINE", "__import__('time').sleep(3600)"))
    assert [it.executable for it in read(file).nodes] == ["None"]
    # Its process may end by its own timer first.
    for line in ("time.sleep(3600)", "time.sleep(1.9); os.kill(os.getpid(), 9)"):
        file.write_text(f"import os, time\n{line}\n")
        (found,) = read_launch_files([LaunchOrder(str(file), (), (), True)], 2.0)
        assert "took more than 2 s" in str(found)


def test_a_launch_file_that_is_a_link_to_nothing_stops_no_other(kept: Path) -> None:
    """An installed package whose sources have gone has such links."""
    other, gone = kept / "own/a.launch.py", kept / "own/gone.launch.py"
    other.write_text(ASKS.replace("LINE", "1"))
    gone.symlink_to("nosuch.py")
    orders = [LaunchOrder(str(it), every=True) for it in (gone, other)]
    error, graph = read_launch_files(orders, 60.0)
    assert str(error).endswith("the launch file cannot be read: No such file or directory")
    assert not isinstance(graph, InputError) and [it.executable for it in graph.nodes] == ["1"]


def test_a_launch_file_reads_what_python_has_compiled(
    kept: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else what it imports is compiled for each launch file anew."""
    compiled = kept / "compiled"
    compiled.mkdir()
    monkeypatch.setenv("PYTHONPYCACHEPREFIX", str(compiled))
    file = kept / "own/a.launch.py"
    file.write_text(ASKS.replace("LINE", "os.listdir(__import__('sys').pycache_prefix)"))
    assert next(it.executable for it in read(file).nodes).startswith("[")


def test_of_a_description_no_folder_is_asked_for(kept: Path) -> None:
    """Its text has thousands of slashes: as a path it would be as many folders."""
    file = kept / "own/a.launch.py"
    file.write_text(
        "import os\nfrom launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
        "look, asked = os.lstat, [0]\n"
        "def counted(path, *words, **options):\n"
        "    asked[0] += len(os.fspath(path)) > 2000\n    return look(path, *words, **options)\n"
        "def generate_launch_description():\n"
        "    text = '<robot>' + '\\n<link/>' * 400\n    os.lstat = counted\n"
        "    from launch.actions import OpaqueFunction as Then\n"
        "    told = lambda _: [Node(package='p', executable=str(asked[0]))]\n"
        "    one = Node(package='p', executable='one', parameters=[{'robot_description': text}])\n"
        "    return LaunchDescription([one, Then(function=told)])\n"
    )
    assert [it.executable for it in read(file).nodes] == ["one", "0"]


def test_what_a_launch_file_may_do(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All that is refused leaves everything as it was; all else is done."""
    if not fences.version():
        pytest.skip("this kernel has no Landlock")
    monkeypatch.setenv("A_SECRET", "x")
    lines = (*ALLOWED, *REFUSED)
    text = FILE.replace("OUT_OF_IT", str(kept / "other")).replace("LINES", repr(lines))
    file = kept / "own/a.launch.py"
    file.write_text(text)
    before = there(kept)
    nodes = {(it.package, it.executable) for it in read(file).nodes} - {("p", "begun")}
    wrong = [
        (who, lines[int(at)])
        for who, at in nodes
        if (who, int(at) < len(ALLOWED)) != ("refused", False)
    ]
    assert wrong == []
    assert {lines[int(at)] for _, at in nodes} == {*REFUSED}
    assert there(kept) == before


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            "__import__('threading').Thread(target=print).start()",
            "it starts a thread (a.launch.py:1)",
        ),
        ("bytearray(1 << 40)", "it needs more memory than it gets (a.launch.py:1)"),
    ],
)
def test_what_the_fences_stop_in_other_words_is_named(line: str, said: str, kept: Path) -> None:
    """Python has no word of its own for it, and launch would read the file: --trust is the way."""
    (kept / "own/a.launch.py").write_text(f"{line}\n")
    (found,) = read_launch_files([LaunchOrder(str(kept / "own/a.launch.py"))], 60.0)
    assert f"cannot be read: {said}; " in str(found)
    assert str(found).endswith("give --trust if you trust it (SECURITY.md)")


ROBOT = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="n"
 default="d"/><link name="$(arg n)"/><link name="${LINK}"/></robot>"""
USES = """\
from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node
import os, subprocess
file = os.path.join(os.path.dirname(__file__), "r.xacro")
def generate_launch_description():
    return LaunchDescription([Node(package="p", executable="e", parameters=[
        {"a": Command(["xacro ", file, " n:=x"]),
         "b": subprocess.check_output(["xacro", file], text=True)}])])
"""


@pytest.mark.parametrize(
    "link", ["1 + 1", "__import__('os').system('true')", "open('/etc/passwd').read()"]
)
def test_xacro_of_a_launch_file_has_its_own_fences(link: str, kept: Path) -> None:
    """Whatever the process of the launch file asks for: it is expanded by one with all of them."""
    (kept / "own/r.xacro").write_text(ROBOT.replace("LINK", link))
    (kept / "own/a.launch.py").write_text(USES)
    found = read(kept / "own/a.launch.py")
    texts = [it.text.replace("\\", "") for it in found.nodes[0].parameters]
    if link == "1 + 1":
        assert not found.notes
        assert (
            'name="x"' in texts[0]
            and 'name="d"' in texts[1]
            and all('name="2"' in it for it in texts)
        )
    else:
        assert all("is not known" in it.message for it in found.notes) and len(found.notes) == 2
        assert all("link" not in it for it in texts)


def test_what_the_relay_starts_has_all_fences(kept: Path) -> None:
    """A launch file that asks for a child without fences gets one with all."""
    made = kept / "made"
    hostile = (FIXTURES / "hostile/lambda_system.xacro").read_text()
    robot = hostile.replace('name="target" default=""', f'name="target" default="{made}"')
    (kept / "own/r.xacro").write_text(robot)
    lines = "from multibot_rewrite.description.sources import expand, access\n" + USES.replace(
        'Command(["xacro ", file, " n:=x"])',
        "expand.expand(file, {}, None, access.TRUSTED).decode()",
    )
    (kept / "own/a.launch.py").write_text(lines)
    (found,) = read_launch_files([LaunchOrder(str(kept / "own/a.launch.py"))], 60.0)
    assert "refused: os.system" in str(found) and not made.exists()


WITHOUT = """\
import json, sys
from multibot_rewrite.producers.launch.child import read_launch_files
from multibot_rewrite.producers.launch.records import LaunchOrder
def main():
    orders = [LaunchOrder(sys.argv[1], trusted=it) for it in (False, True)]
    print(*read_launch_files(orders, 60.0), sep="\\n")
main()
"""


def test_without_fences_nothing_of_it_runs(kept: Path) -> None:
    """It says what to do; ``trusted`` reads it all the same."""
    wrapper = Path(__file__).parents[1] / "support/without_kernel_fences.py"
    made = f"open({str(kept / 'made')!r}, 'x')\n"
    (kept / "own/a.launch.py").write_text(made + FILE.replace("LINES", "[]"))
    (kept / "asks.py").write_text(WITHOUT)
    environ: Mapping[str, str] = {**os.environ, "PYTHONPATH": f"{kept}:{ROOT}"}
    line = [sys.executable, str(wrapper), "asks", str(kept / "own/a.launch.py")]
    done = subprocess.run(line, env=environ, capture_output=True, text=True, check=True)
    first, second = done.stdout.splitlines()
    assert "not both Landlock and seccomp" in first and "--trust" in first
    assert second.startswith("LaunchGraph") and (kept / "made").exists()


WITHOUT_TOOLS = fixture_text("confined_without_tools.txt")
INNER = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
def generate_launch_description():
    own = Node(package="q", executable=LaunchConfiguration("name"))
    return LaunchDescription([
        DeclareLaunchArgument("name"), DeclareLaunchArgument("mode"), own])
"""


def test_what_a_package_makes_that_is_not_here_stops_nothing(kept: Path) -> None:
    """A class may have it for its base, in YAML it is a text. The arguments of an include that it makes
    may be those that are given; what else is needed is not known."""
    (kept / "own/a.launch.py").write_text(WITHOUT_TOOLS)
    (kept / "own/b.launch.py").write_text(INNER)
    order = LaunchOrder(str(kept / "own/a.launch.py"), (("name", "x"),))
    (found,) = read_launch_files([order], 60.0)
    assert isinstance(found, LaunchGraph), found
    assert {(it.package, it.executable) for it in found.nodes} == {("p", "b {'str'}"), ("q", "x")}
    said = "a package that is not installed sets the arguments of an include"
    assert said in {it.message for it in found.notes if it.parameters}
