# SPDX-License-Identifier: Apache-2.0
"""The package in figures: its packages, lines, functions, and what runs for a command.

python benchmarks/house.py                  this checkout
python benchmarks/house.py CHECKOUT         another one
python benchmarks/house.py --write          put them into the pages that state them
python benchmarks/house.py --write --loop   and the CPU seconds of the fast tests: it runs them

A package here is a file or folder right below it; its layer is the longest chain of imports below it.
"""

from __future__ import annotations

import argparse
import ast
import os
import re
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage
from types import CodeType, FrameType
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
PACKAGE = "multibot_rewrite"
SMALL, LONG, EQUAL = 40, 350, 6
KINDS = ("code", "blank", "imports", "docstrings", "words", "data", "comments")
# What declares a rule: its words and examples are the arguments.
DECLARING = {"declare", "rule", "danger_rule", "graph_rule", "srdf_rule"}
ROVER, GRAPHS = "fixtures/robots/rover.urdf", "fixtures/graphs"
# What has several records, and all that it was and is. In NAMESAKES a name means something else.
SHAPES = {
    "an end": (
        *("WiredTopic", "ReadEndpoint", "RuntimeName", "Endpoint", "EndpointName", "End", "Ends"),
        *("StubEndpoint", "DrawnEdge"),
    ),
    "a node": (
        *("NodeFacts", "KnownNode", "NodeParameters", "ReadNode", "NodeTable", "Home", "GivenNode"),
        *("LaunchedNode", "RunningNode", "Start", "Component", "StubNode", "Node", "Run", "Fact"),
    ),
    "a finding": ("Problem", "Fault", "Remark", "LaunchNote", "Caveat", "Finding"),
}
NAMESAKES = ("lint/catalogue.py", "producers/launch/stand_in/ros.py")
# A test that imports so many modules besides commands and public names knows how the package is built.
SEVERAL = 3
# What a user asks for.
COMMANDS = {
    "rewrite": ("urdf_postfix", ROVER, "robot1", "robot2", "-o", "{}/{{robot}}.urdf"),
    "lint": ("urdf_lint", ROVER),
    "check": ("multibot", "check", f"{GRAPHS}/plan.yaml", "--from", f"{GRAPHS}/healthy.json"),
    "plan": ("multibot", "plan", "examples/two_robots_nav2/fleet.yaml", "-o", "{}/plan.yaml"),
    "build": ("multibot", "build", "examples/two_robots_nav2/fleet.yaml", "-o", "{}/fleet"),
}
OTHERS = "the public names (`__init__.py`), the version"
FAST = ("-q", "-m", "not live and not slow")


class Module(NamedTuple):
    """A file of the package: where it is below it, its lines and its tree."""

    file: str
    lines: tuple[str, ...]
    tree: ast.Module

    @property
    def room(self) -> str:
        return self.file.partition("/")[0].removesuffix(".py")


def modules(checkout: Path) -> list[Module]:
    """Every module of the package."""
    package = checkout / PACKAGE
    found = []
    for path in sorted(package.rglob("*.py")):
        text = path.read_text()
        file = path.relative_to(package).as_posix()
        found.append(Module(file, tuple(text.splitlines()), ast.parse(text)))
    return found


def kinds(module: Module) -> Counter[str]:
    """How many lines of each kind a module has."""
    found = Counter(_kinds_of_lines(module))
    return Counter({kind: found[kind] for kind in KINDS})


@cache
def _kinds_of_lines(module: Module) -> list[str]:
    kind = [_plain_kind(line) for line in module.lines]
    for node in ast.walk(module.tree):
        for marked, first, last in _marked(node):
            kind[first - 1 : last] = [marked] * (last - first + 1)
    for node in module.tree.body:
        if isinstance(node, ast.Assign | ast.AnnAssign) and _is_data(node.value):
            first, last = node.lineno, node.end_lineno or node.lineno
            kind[first - 1 : last] = ["data"] * (last - first + 1)
    return kind


def _plain_kind(line: str) -> str:
    stripped = line.strip()
    return "comments" if stripped.startswith("#") else "code" if stripped else "blank"


def _marked(node: ast.AST) -> Iterator[tuple[str, int, int]]:
    """The lines of an import, a docstring, or the declaration of a rule."""
    if isinstance(node, ast.Import | ast.ImportFrom):
        yield "imports", node.lineno, node.end_lineno or node.lineno
    elif isinstance(node, ast.Call) and _name(node.func) in DECLARING:
        yield "words", node.lineno, node.end_lineno or node.lineno
    elif isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node):
        text = node.body[0]
        yield "docstrings", text.lineno, text.end_lineno or text.lineno


def _name(node: ast.AST) -> str:
    return node.id if isinstance(node, ast.Name) else getattr(node, "attr", "")


def _is_data(value: ast.AST | None) -> bool:
    """A table or text: nothing in it is computed."""
    computed = (ast.Call, ast.Lambda, ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
    return value is not None and not any(isinstance(it, computed) for it in ast.walk(value))


def arrows(every: list[Module]) -> Counter[tuple[str, str]]:
    """Return the pairs of packages with imports, and how many modules import so."""
    files = {it.file: it.room for it in every}
    pairs = ((it.room, files[other]) for it in every for other in imported(it.tree, files))
    return Counter((one, other) for one, other in pairs if one != other)


def imported(tree: ast.Module, files: Iterable[str]) -> set[str]:
    """The modules of the package that one of them imports."""
    found: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(PACKAGE):
            for name in node.names:
                parts = f"{node.module}.{name.name}".split(".")[1:]
                bases = ("/".join(parts[:end]) for end in range(len(parts), -1, -1))
                paths = (
                    f"{it}{end}".lstrip("/") for it in bases for end in (".py", "/__init__.py")
                )
                found.update(next(([it] for it in paths if it in files), []))
    return found


def floors(between: Iterable[tuple[str, str]]) -> int:
    """Return the longest chain of imports from package to package."""
    below: dict[str, set[str]] = defaultdict(set)
    for one, other in between:
        below[one].add(other)

    @cache
    def floor(room: str) -> int:
        return 1 + max(map(floor, below[room]), default=0)

    return max(map(floor, list(below)), default=1)


def equal_pairs(every: list[Module]) -> int:
    """How often six lines of code stand in two places; longer ones are one pair."""
    places: dict[tuple[str, ...], list[tuple[int, int]]] = defaultdict(list)
    for number, module in enumerate(every):
        code = _code_lines(module)
        for at in range(len(code) - EQUAL + 1):
            places[tuple(code[at : at + EQUAL])].append((number, at))
    pairs = {
        (one, other)
        for found in places.values()
        for index, one in enumerate(found)
        for other in found[index + 1 :]
    }
    return sum(((a, i - 1), (b, j - 1)) not in pairs for (a, i), (b, j) in pairs)


def _code_lines(module: Module) -> list[str]:
    kinds_ = _kinds_of_lines(module)
    return [line.strip() for line, kind in zip(module.lines, kinds_, strict=True) if kind == "code"]


def referred_once(every: list[Module], functions: Iterable[ast.FunctionDef]) -> int:
    """Functions whose name stands in one other place."""
    words = Counter(
        _name(node)
        for it in every
        for node in ast.walk(it.tree)
        if isinstance(node, ast.Name | ast.Attribute)
    )
    return sum(words[it.name] == 1 for it in functions)


def shapes(every: list[Module]) -> dict[str, list[str]]:
    """The records of a thing that has several, each with its module."""
    places = [
        (node.name, it.file)
        for it in every
        for node in ast.walk(it.tree)
        if isinstance(node, ast.ClassDef) and it.file not in NAMESAKES
    ]
    return {
        what: [f"{name} ({file})" for name, file in places if name in names]
        for what, names in SHAPES.items()
    }


def serialisers(every: list[Module]) -> list[str]:
    """The modules that make a System of bytes."""
    return [it.file for it in every if any(map(_reads_system, ast.walk(it.tree)))]


def _reads_system(node: ast.AST) -> bool:
    if not isinstance(node, ast.FunctionDef) or node.returns is None:
        return False
    given = [_name(it.annotation) for it in node.args.args if it.annotation]
    # Who asks the reader of another module is none.
    asks = any(isinstance(it, ast.Attribute) and it.attr == "read_system" for it in ast.walk(node))
    return "bytes" in given and _name(node.returns) == "System" and not asks


def importing_rows(checkout: Path, every: list[Module]) -> Iterator[tuple[str, int, int]]:
    """Test files and their lines, by what they import of the package."""
    files = {it.file: it.tree for it in every}
    public = {"__init__.py", "version.py", *imported(files["__init__.py"], files)}
    found: dict[str, list[int]] = defaultdict(list)
    for path in (checkout / "tests").rglob("test_*.py"):
        text = path.read_text()
        inner = imported(ast.parse(text), files) - public
        count = sum(not it.startswith("cli/") for it in inner)
        found[_knows(count)].append(text.count("\n"))
    for word, lines in sorted(found.items()):
        yield word, len(lines), sum(lines)


def _knows(count: int) -> str:
    if count >= SEVERAL:
        return f"{SEVERAL} inner modules or more"
    return "1 or 2 inner modules" if count else "commands and public names alone"


def figures(every: list[Module]) -> dict[str, str]:
    """Return the figures, without those of the packages and of what runs."""
    nodes = [node for it in every for node in ast.walk(it.tree)]
    functions = [it for it in nodes if isinstance(it, ast.FunctionDef)]
    lengths = sorted((it.end_lineno or it.lineno) - it.lineno + 1 for it in functions)
    classes = Counter(it.name for it in nodes if isinstance(it, ast.ClassDef))
    between = arrows(every)
    codes = {it for m in every for it in re.findall(r'"(M[BFGR]\d{3})"', "\n".join(m.lines))}
    return {
        "lines": f"{sum(len(it.lines) for it in every):,}",
        "modules": f"{len(every):,}",
        f"modules under {SMALL} lines": f"{sum(len(it.lines) < SMALL for it in every):,}",
        f"modules over {LONG} lines": f"{sum(len(it.lines) > LONG for it in every):,}",
        "packages": f"{len({it.room for it in every}):,}",
        "layers": f"{floors(between):,}",
        "arrows between packages": f"{len(between):,}",
        "functions": f"{len(functions):,}",
        "lines of a function: median": f"{_share(lengths, 50)}",
        "lines of a function: nine of ten have at most": f"{_share(lengths, 90)}",
        "lines of a function: the longest": f"{lengths[-1]}",
        "functions that one place refers to": f"{referred_once(every, functions):,}",
        "names of classes that are there twice": f"{sum(it > 1 for it in classes.values()):,}",
        f"pairs of {EQUAL} equal lines": f"{equal_pairs(every):,}",
        "codes of findings": f"{len(codes):,}",
        **{f"shapes of {what}": f"{len(it)}" for what, it in shapes(every).items()},
        "serialisers of a System": f"{len(serialisers(every))}",
    }


def _share(values: list[int], percent: int) -> int:
    return values[len(values) * percent // 100]


def room_rows(every: list[Module]) -> Iterator[tuple[str, Counter[str]]]:
    """Yield each folder of the package with its lines; other modules are one row."""
    found: dict[str, Counter[str]] = defaultdict(Counter)
    for it in every:
        found[f"{it.room}/" if "/" in it.file else "others"] += kinds(it)
    yield from sorted(found.items())
    yield "all", sum(found.values(), Counter())


def functions_run(checkout: Path) -> dict[str, str]:
    """How many functions of the package run for each command, in how many modules; records made."""
    with tempfile.TemporaryDirectory() as folder:
        asked = {name: [it.format(folder) for it in words] for name, words in COMMANDS.items()}
        return {
            f"functions (modules, records) that run for {name}": _run(checkout, words, folder)
            for name, words in asked.items()
        }


def _run(checkout: Path, words: Iterable[str], cache_home: str) -> str:
    line = [sys.executable, str(Path(__file__)), "--run", *words]
    environment = {**os.environ, "PYTHONPATH": str(checkout), "XDG_CACHE_HOME": cache_home}
    done = subprocess.run(
        line, cwd=checkout, env=environment, capture_output=True, text=True, check=False
    )
    if done.returncode:
        sys.exit(f"{' '.join(line)}: {done.stderr}")
    return done.stderr.rpartition("RAN ")[2].strip()


def run_counted(command: str, *words: str) -> None:
    """Run a command in this process; what of the package ran is the last line of the errors."""
    module = __import__(f"{PACKAGE}.cli.{command}", fromlist=["main"])
    seen: set[CodeType] = set()

    def note(frame: FrameType, event: str, _: object) -> None:
        if event == "call":
            seen.add(frame.f_code)

    sys.setprofile(note)
    code = module.main(list(words))
    sys.setprofile(None)
    ours = {it for it in seen if f"/{PACKAGE}/" in it.co_filename and it.co_name[0] != "<"}
    entered = len({it.co_filename for it in ours})
    made = sum(it.__module__.startswith(PACKAGE) for it in tuple.__subclasses__())
    print("RAN", f"{len(ours):,} ({entered}, {made})", file=sys.stderr)
    sys.exit(code)


def loop_seconds(checkout: Path) -> float:
    """CPU seconds of the fast tests, with what they start."""
    before = getrusage(RUSAGE_CHILDREN)
    line = [sys.executable, "-m", "pytest", *FAST]
    subprocess.run(line, cwd=checkout, stdout=subprocess.DEVNULL, check=True)
    after = getrusage(RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def table(head: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    """Markdown: what stands in the first column is text, the rest numbers."""
    names = list(head)
    lines = [names, ["---", *["--:"] * (len(names) - 1)], *rows]
    return "\n".join(f"| {' | '.join(str(it) for it in line)} |" for line in lines)


def kinds_table(every: list[Module]) -> str:
    """Return the lines of each package, by kind."""
    rows = room_rows(every)
    cells = ([name, it.total(), *(it[kind] for kind in KINDS)] for name, it in rows)
    return table(("lines in", "all", *KINDS), cells)


def rooms_table(checkout: Path, every: list[Module]) -> str:
    """Return what each package is for, as it says itself, and its lines."""
    package = checkout / PACKAGE
    about = {f"{it.name}/": _about(it / "__init__.py") for it in package.iterdir() if it.is_dir()}
    about["others"] = OTHERS
    rows = [(name, it) for name, it in room_rows(every) if name != "all"]
    cells = ((f"`{name}` {about[name]}", f"{it.total():,}", f"{it['code']:,}") for name, it in rows)
    return table(("package", "lines", "code"), cells)


def _about(path: Path) -> str:
    text = ast.get_docstring(ast.parse(path.read_text())) if path.exists() else ""
    return (text or "").partition("\n")[0].replace("``", "`")


def figures_table(checkout: Path, every: list[Module]) -> str:
    """Return the figures, the lines by kind, and what runs for a command."""
    found = sum((kinds(it) for it in every), Counter())
    said = ", ".join(f"{kind} {found[kind] * 100 / found.total():.0f}" for kind in KINDS)
    rows = {**figures(every), **functions_run(checkout), "lines by kind, of a hundred": said}
    return table(("figure", ""), rows.items())


def write(path: Path, word: str, new: str) -> None:
    """Put the text between the markers of a page."""
    mark = f"<!-- {word} -->\n"
    before, _, after = path.read_text().split(mark)
    path.write_text(mark.join((before, f"{new}\n", after)))


def main(words: list[str]) -> None:
    if words[:1] == ["--run"]:
        run_counted(*words[1:])
        return
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("checkout", nargs="?", type=Path, default=ROOT)
    parser.add_argument("--write", action="store_true", help="into the pages that state them")
    parser.add_argument("--loop", action="store_true", help="and the time of the fast tests")
    options = parser.parse_args(words)
    every = modules(options.checkout)
    rooms = rooms_table(options.checkout, every)
    made = {"packages": rooms, "figures": figures_table(options.checkout, every)}
    tests = table(
        ("test files that import", "files", "lines"), importing_rows(options.checkout, every)
    )
    several = [f"{what}: {', '.join(it)}" for what, it in shapes(every).items()]
    several += [f"a System is read by: {', '.join(serialisers(every))}"]
    print(*made.values(), kinds_table(every), tests, *several, sep="\n\n")
    if options.write:
        for word, text in made.items():
            write(options.checkout / "docs" / "contributing" / "architecture.md", word, text)
    if options.loop:
        said = f"The fast tests take {loop_seconds(options.checkout):.0f} seconds of CPU."
        print(said)
        if options.write:
            write(options.checkout / "CONTRIBUTING.md", "loop", said)


if __name__ == "__main__":
    main(sys.argv[1:])
