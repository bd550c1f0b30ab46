"""The house in figures: ``python benchmarks/rooms.py [CHECKOUT]`` reads the imports and definitions.

A room is a file or folder right below the package; its floor is the longest chain of imports below it.
"""

from __future__ import annotations

import ast
import sys
from collections import Counter
from functools import cache
from pathlib import Path

LONG = 350


def read(package: Path) -> dict[str, ast.Module]:
    """Every module of the package by its path below it."""
    return {
        it.relative_to(package).as_posix(): ast.parse(it.read_text())
        for it in package.rglob("*.py")
    }


def imported(sources: dict[str, ast.Module], file: str) -> set[str]:
    """The modules of the package that a module imports."""
    found = set()
    for node in ast.walk(sources[file]):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("multibot_rewrite"):
            for name in node.names:
                parts = f"{node.module}.{name.name}".split(".")[1:]
                bases = ("/".join(parts[:end]) for end in range(len(parts), -1, -1))
                files = (
                    f"{base}{end}".lstrip("/") for base in bases for end in (".py", "/__init__.py")
                )
                found.update(next(([it] for it in files if it in sources), []))
    return found


def room(file: str) -> str:
    return file.partition("/")[0].removesuffix(".py")


def main() -> None:
    checkout = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[1])
    package = checkout / "multibot_rewrite"
    sources = read(package)
    pairs = [(room(file), room(other)) for file in sources for other in imported(sources, file)]
    arrows = Counter((one, other) for one, other in pairs if one != other)

    @cache
    def floor(name: str) -> int:
        return 1 + max((floor(below) for above, below in arrows if above == name), default=0)

    nodes = [node for tree in sources.values() for node in ast.walk(tree)]
    lengths = sorted(
        it.end_lineno - it.lineno + 1 for it in nodes if isinstance(it, ast.FunctionDef)
    )
    classes = Counter(it.name for it in nodes if isinstance(it, ast.ClassDef))
    lines = [len((package / file).read_text().splitlines()) for file in sources]
    rows = {
        "files": len(sources),
        "lines": sum(lines),
        "lines in functions": sum(lengths),
        f"files over {LONG} lines": sum(it > LONG for it in lines),
        "floors": max(map(floor, map(room, sources))),
        "arrows between rooms": len(arrows),
        "imports between rooms": sum(arrows.values()),
        "functions": len(lengths),
        "function length, median": lengths[len(lengths) // 2],
        "functions over 25 lines": sum(it > 25 for it in lengths),
        "class names used twice": sum(it > 1 for it in classes.values()),
    }
    for name, value in rows.items():
        print(f"{name:26}{value:8,}")


if __name__ == "__main__":
    main()
