# SPDX-License-Identifier: Apache-2.0
"""A launch file started in a place of its own, and the processes that it starts as records."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple, cast

import yaml

from tools.bringups.install import install, packages

WATCH = Path(__file__).with_name("watch.py")
# Seconds after which a launch file is ended.
PATIENCE = 180
# No network, no process of others, no file of others to write, no right of root; nothing stays.
FENCED = (
    *("/usr/bin/unshare", "--net", "--ipc", "--mount", "--pid", "--fork", "--kill-child"),
    *("--mount-proc", "/bin/sh", "-c"),
    'PATH=/usr/sbin:/usr/bin:/sbin:/bin; mount --bind "$0" "$0" && mount -t tmpfs none /sys &&'
    " mount -o remount,ro,bind / && run=$(command -v setpriv) && PATH=$0/bin &&"
    ' exec $run --bounding-set=-all --inh-caps=-all --no-new-privs "$@"',
)
XACRO = """\
#!/bin/sh
{python} -c 'import sys, xacro; xacro.main()' "$@" 2>"$BRINGUP_ROWS/../xacro.log" \\
    || echo '<robot name="not_expanded"/>'
"""
# What launch files ask of a shell and is run as it is.
PLAIN = (
    "basename",
    "cat",
    "cut",
    "date",
    "dirname",
    "grep",
    "hostname",
    "ls",
    "pwd",
    "sed",
    "uname",
)
# Where launch comes from, and installed packages; multibot is run without them.
LAUNCH = os.environ.get("PYTHONPATH", "")
INSTALLED = os.environ.get("AMENT_PREFIX_PATH", "")
# Programs with more nodes than the one that their arguments name.
MANY = {"ros2_control_node", "component_container", "component_container_mt"}
# What starts controllers; the second one until Galactic.
SPAWNERS = ("spawner", "spawner.py")
# Options of ``ros2 control load_controller`` with a value (ros2controlcli, verb/load_controller.py).
_VALUED = ("-c", "--controller-manager", "--set-state")
# Where the topics of a bridge's file are among its parameters.
BRIDGED = "\0bridged"
# Variables that launch, Python and the referee set themselves.
_OWN = re.compile(
    r"BRINGUP_|ROS_LOG_DIR$|PYTHON|OVERRIDE_LAUNCH|_$|PWD$|OLDPWD$|SHLVL$|LC_CTYPE$|\w+_NUM_THREADS$"
)


class Process(NamedTuple):
    """A process, a component or an include of what is not here, as it was started."""

    package: str
    program: str
    kind: str = "program"
    name: str = ""
    namespace: str = ""
    rules: tuple[tuple[str, str], ...] = ()
    parameters: Mapping[str, Any] = {}
    words: tuple[str, ...] = ()
    environ: Mapping[str, str] = {}
    # Parameters that it has only if it is called as a section of a file is: its name is not told.
    loose: frozenset[str] = frozenset()
    # What else its launch file says of it: respawn, delay, prefix, folder.
    facts: Mapping[str, str] = {}

    @property
    def label(self) -> str:
        """Return what a table calls it."""
        whole = "/".join(it for it in (self.package, self.program) if it)
        if not self.package:
            whole = " ".join((self.program, *self.words[:3]))
        return f"{whole} ({self.name})" if self.name and self.name != self.program else whole


class Ran(NamedTuple):
    """What a launch file has started, and why it ended before its time, or nothing."""

    processes: tuple[Process, ...]
    fault: str


def start(file: Path, given: Sequence[str], sources: Iterable[Path], folder: Path) -> Ran:
    """Start a launch file with the packages below ``sources`` installed, and write below ``folder``."""
    shutil.rmtree(folder, ignore_errors=True)
    for name in ("rows", "bin", "home", "tmp", "site", "install/lib"):
        (folder / name).mkdir(parents=True)
    index = folder / "install/share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    for source in sources:
        for name, place in packages(source).items():
            if not (index / name).exists():
                (index / name).touch()
                install(name, place, folder / "install")
                if (place / name / "__init__.py").is_file():
                    (folder / "site" / name).symlink_to(place / name)
    (folder / "bin/xacro").write_text(XACRO.format(python=sys.executable))
    (folder / "bin/xacro").chmod(0o755)
    for name in PLAIN:
        if (Path("/bin") / name).exists():
            (folder / "bin" / name).symlink_to(Path("/bin") / name)
    environ = _environment(folder)
    command = [*FENCED, str(folder), sys.executable, str(WATCH), str(folder), str(file), *given]
    with (folder / "log").open("w") as log:
        child = subprocess.Popen(
            command,
            env=environ,
            cwd=folder / "home",
            stdout=log,
            stderr=log,
            stdin=subprocess.DEVNULL,
            start_new_session=True,
        )
        try:
            child.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)
            child.wait()
    rows = [json.loads(it.read_text()) for it in sorted((folder / "rows").glob("*.json"))]
    failed = child.returncode != 0 or any(it.get("failed") for it in rows)
    base: dict[str, Any] = next((it["base"] for it in rows if "base" in it), {})
    facts = {it["of"]: it["facts"] for it in rows if "facts" in it}
    processes = [
        made._replace(facts={**made.facts, **facts.get(row.get("pid"), {})})
        for row in rows
        for made in _processes(row, base, folder)
    ]
    return Ran(tuple(processes), _fault(folder / "log") if failed else "")


def _environment(folder: Path) -> dict[str, str]:
    """Return the variables that a launch file sees: those of a plain machine with ROS, no secret."""
    path = os.pathsep.join([LAUNCH, str(folder / "site")])
    prefixes = [str(folder / "install"), INSTALLED]
    return {
        "AMENT_PREFIX_PATH": os.pathsep.join(prefixes).strip(os.pathsep),
        "BRINGUP_ROWS": str(folder / "rows"),
        "DISPLAY": ":0",
        "HOME": str(folder / "home"),
        "LANG": "C.UTF-8",
        "PATH": str(folder / "bin"),
        "PYTHONPATH": path.strip(os.pathsep),
        "PYTHONDONTWRITEBYTECODE": "1",
        "ROS_DISTRO": os.environ.get("ROS_DISTRO", "jazzy"),
        "ROS_LOG_DIR": str(folder / "tmp/log"),
        "ROS_VERSION": "2",
        "TMPDIR": str(folder / "tmp"),
        "USER": "user",
    }


def _fault(log: Path) -> str:
    """Return the line that says why a launch file ended."""
    lines = [it.strip() for it in log.read_text(errors="replace").splitlines() if it.strip()]
    told = [it for it in lines if re.search(r"Error|exception|Caught", it)]
    return (told or lines or ["it was ended after its time"])[-1][:300]


def _processes(row: dict[str, Any], base: Mapping[str, str], folder: Path) -> Iterator[Process]:
    """Return what a row says was started: a spawner of two controllers is two."""
    if row.get("asked") or row.keys() & {"failed", "base", "facts"}:
        return
    if "include" in row:
        words = [f"{name}:={it}" for name, it in sorted(row["arguments"].items())]
        space = row["namespace"]
        yield Process(row["package"], row["include"], "include", "", space, words=tuple(words))
        return
    if "component" in row:
        rules = tuple((old, new) for old, new in row["rules"])
        yield Process(
            row["package"],
            row["component"],
            "component",
            row["name"],
            row["namespace"],
            rules,
            row["parameters"],
        )
        return
    environ = {
        name: it
        for name, it in row["environ"].items()
        if base.get(name) != it and not _OWN.match(name)
    }
    package, program, words, before = _program(row["words"], folder)
    home = str(folder / "home")
    facts = {"prefix": before, "folder": "" if row["folder"] == home else row["folder"]}
    node = _node(words, row["files"], program in MANY)._replace(
        package=package,
        program=program,
        environ=environ,
        facts={name: it for name, it in facts.items() if it},
    )
    if bridged := _bridged(node.parameters.get("config_file", "")):
        node = node._replace(parameters={**node.parameters, BRIDGED: bridged})
    yield from by_controller(node)


def _program(words: Sequence[str], folder: Path) -> tuple[str, str, list[str], str]:
    """Return package and program of a command line, the words after it, and those before."""
    inside = folder / "install/lib"
    for number, word in enumerate(words):  # behind xterm -e, gdb --args, sudo
        if Path(word).is_relative_to(inside):
            package, program = Path(word).relative_to(inside).parts[:2]
            before = " ".join((Path(words[0]).name, *words[1:number])) if number else ""
            return package, program, list(words[number + 1 :]), before
    name, rest = Path(words[0]).name, list(words[1:])
    if [name, *rest[:1]] == ["ros2", "run"] and len(rest) > 2:
        return rest[1], rest[2], rest[3:], ""
    return "", name, rest, ""


def _node(words: Sequence[str], files: Mapping[str, str], many: bool = False) -> Process:
    """Return name, namespace, rules, parameters and own words of a command line; of a process of
    many nodes the parameters of all."""
    own: list[str] = []
    rules: list[tuple[str, str]] = []
    given: list[str | dict[str, Any]] = []
    name, space, inside = "", "", False
    rest = iter(words)
    for word in rest:
        if word in ("--ros-args", "--"):
            inside = word == "--ros-args"
        elif not inside:
            own.append(word)
        elif word in ("-r", "--remap"):
            old, _, new = next(rest, "").partition(":=")
            if old == "__node":
                name = new
            elif old == "__ns":
                space = new
            else:
                rules.append((old, new))
        elif word in ("-p", "--param"):
            key, _, value = next(rest, "").partition(":=")
            given.append({key: value_of(value)})
        elif word == "--params-file":
            given.append(files.get(next(rest, ""), ""))
    parameters: dict[str, Any] = {}
    sure: set[str] = set()
    for one in given:
        if isinstance(one, dict):
            parameters |= one
            sure |= one.keys()
        else:
            parameters |= parameters_of(one, "" if many else name, space)
            sure |= parameters_of(one, name or "\0", space).keys()
    loose = frozenset(parameters.keys() - sure)
    words = tuple(own)
    return Process("", "", "program", name, space, tuple(rules), parameters, words, {}, loose)


def _bridged(file: Any) -> list[str]:
    """Return the ROS topics of the file of a bridge."""
    if not isinstance(file, str) or not os.path.isfile(file):
        return []
    rows = value_of(Path(file).read_text(errors="replace"))
    topics = [it for it in rows if isinstance(it, dict)] if isinstance(rows, list) else []
    return [str(it.get("ros_topic_name") or it.get("topic_name", "")) for it in topics]


class _Values(yaml.SafeLoader):
    """launch tags lists that were tuples."""


_Values.add_constructor(
    "tag:yaml.org,2002:python/tuple",
    lambda loader, node: loader.construct_sequence(cast(yaml.SequenceNode, node)),
)


def value_of(text: str) -> Any:
    """Return the value of a text in YAML; the text itself if it is none."""
    try:
        return yaml.load(text, _Values)
    except yaml.YAMLError:
        return text


def parameters_of(text: str, name: str, space: str) -> dict[str, Any]:
    """Return the values of a parameter file that a node reads; all of them if its name is not told."""
    found: dict[str, Any] = {}
    content = value_of(text)
    found_sections = list(sections(content, "")) if isinstance(content, dict) else []
    whole = f"{space.rstrip('/')}/{name}" if name else ""
    for key, values in sorted(found_sections, key=lambda it: "*" not in it[0]):
        if not whole or _matches(key, whole):
            found |= dict(flat(values))
    return found


def sections(content: Mapping[Any, Any], above: str) -> Iterator[tuple[str, Mapping[Any, Any]]]:
    """Return the sections of a parameter file, each with its path and its values."""
    for key, values in content.items():
        if not isinstance(values, dict):
            continue
        path = f"{above}/{str(key).strip('/')}"
        if isinstance(values.get("ros__parameters"), dict):
            yield path, values["ros__parameters"]
        yield from sections({k: it for k, it in values.items() if k != "ros__parameters"}, path)


def _matches(key: str, whole: str) -> bool:
    """Return whether the key of a section is for a node, as rcl reads it."""
    if not re.search(r"[*]", key):
        return key == whole
    words = [
        ".*" if it == "**" else "[^/]*" if it == "*" else re.escape(it)
        for it in key.strip("/").split("/")
    ]
    pattern = "/" + "/".join(words)
    return re.fullmatch(pattern.replace(".*/", "(?:.*/)?"), whole) is not None


def flat(values: Any, above: str = "") -> Iterator[tuple[str, Any]]:
    """Return the names and values of nested parameters."""
    if not isinstance(values, dict):
        yield above, values
        return
    for name, value in values.items():
        yield from flat(value, f"{above}.{name}" if above else str(name))


def by_controller(node: Process) -> Iterator[Process]:
    """Return a process for each controller that a spawner, or a command of ros2 control, starts."""
    words = list(node.words)
    if [node.program, *words[:2]] == ["ros2", "control", "load_controller"]:
        behind = pairwise(words[1:])
        names = [it for before, it in behind if before not in _VALUED and it[:1] != "-"]
        for name in names:
            manager = [it for option, it in pairwise(words) if option in _VALUED[:2]][:1]
            own = (name, *(part for it in manager for part in ("-c", it)))
            yield node._replace(package="controller_manager", program="spawner", words=own, name="")
        return
    if node.program not in SPAWNERS:
        yield node
        return
    node = node._replace(program="spawner")
    first = next((at for at, word in enumerate(words) if word.startswith("-")), len(words))
    for name in words[:first] or [""]:
        yield node._replace(words=(name, *words[first:]))
