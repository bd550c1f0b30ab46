# SPDX-License-Identifier: Apache-2.0
"""The release that is asked for reaches every fact: nobody inside the package falls back on another."""

from __future__ import annotations

import ast
from collections.abc import Iterator

import pytest
from parsed import sources

pytestmark = pytest.mark.slow
WORDS = ("release", "distro", "environment")
# The public calls, which ask ROS_DISTRO.
PUBLIC = (
    "description/library.py",
    "library/one_file.py",
    "library/systems.py",
    "library/loaded_fleet.py",
    "refactor/adopt.py",
    "related_files/join.py",
    "refactor/rename.py",
    "base/releases.py",
)
# A lint without a command has no other.
NEWEST = {
    "base/releases.py",
    "cli/declared/commands.py",
    "description/sources/release_said.py",
    "proposal/propose.py",
    "rules/settings.py",
}

Function = ast.FunctionDef | ast.AsyncFunctionDef


def functions(tree: ast.AST) -> Iterator[Function]:
    return (it for it in ast.walk(tree) if isinstance(it, Function))


def optional(function: Function) -> Iterator[str]:
    """Yield the parameters that a caller may leave out."""
    given = function.args
    named = [*given.posonlyargs, *given.args]
    yield from (it.arg for it in named[len(named) - len(given.defaults) :])
    yield from (
        it.arg
        for it, default in zip(given.kwonlyargs, given.kw_defaults, strict=True)
        if default is not None
    )


def place(function: Function) -> tuple[str, int] | None:
    """Return the word for the release and how many positional arguments reach it."""
    names = [it.arg for it in (*function.args.posonlyargs, *function.args.args)]
    for word in WORDS[:2]:
        if word in names:
            return word, names.index(word) + 1
    return None


def is_cached(function: Function) -> bool:
    return any("cache" in ast.unparse(it) for it in function.decorator_list)


def passed(call: ast.Call, word: str, count: int) -> bool:
    starred = any(isinstance(it, ast.Starred) for it in call.args)
    named = {it.arg for it in call.keywords}
    return starred or len(call.args) >= count or bool(named & {word, None})


def test_no_function_has_a_release_of_its_own() -> None:
    found = {
        f"{file}: {function.name}"
        for file, tree in sources().items()
        for function in functions(tree)
        if file not in PUBLIC and set(optional(function)) & set(WORDS)
    }
    assert found == set()


def test_the_newest_release_is_named_where_no_other_can_be_meant() -> None:
    found = {
        file
        for file, tree in sources().items()
        for it in ast.walk(tree)
        if isinstance(it, ast.Name) and it.id == "NEWEST_LTS"
    }
    assert found == NEWEST


def test_every_call_of_what_is_made_once_names_the_release() -> None:
    """mypy does not see what a function behind ``lru_cache`` asks for; it sees the rest."""
    asking = {
        function.name: found
        for tree in sources().values()
        for function in tree.body
        if isinstance(function, Function) and is_cached(function) and (found := place(function))
    }
    assert {"built_in", "built_in_nodes", "builtin_tree", "load_definitions"} <= asking.keys()
    forgotten = [
        f"{file}:{call.lineno}: {call.func.id}"
        for file, tree in sources().items()
        for call in ast.walk(tree)
        if isinstance(call, ast.Call)
        and isinstance(call.func, ast.Name)
        and call.func.id in asking
        and not passed(call, *asking[call.func.id])
    ]
    assert forgotten == []
