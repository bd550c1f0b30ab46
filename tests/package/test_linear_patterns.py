# SPDX-License-Identifier: Apache-2.0
"""No regular expression of the package goes back over a text: steps are counted, not seconds.

A pattern that takes longer than linearly has a text on which a reader does not end, or takes minutes:
a URDF with twenty comments was one. The patterns are found in the source, and the texts are made of
what each pattern repeats.
"""

from __future__ import annotations

import ast
import json
import random
import re
import warnings
from collections.abc import Iterator
from functools import lru_cache

import pytest
from backtracking import MATCH_ALONE, Matcher, program_of, worst
from regexes import PACKAGE, Regex, UnresolvedError, calls, made_by, trees

from multibot_rewrite.description.sources.expand import LONG
from multibot_rewrite.knowledge.parameters import built_in_nodes

# Made of what only a run knows, each with a reason; the patterns that stand for it are in ``declared``.
AT_RUN_TIME = {
    "multibot_rewrite.knowledge.parameters": "all guesses of our definitions, which are tried here",
}
# Not linear, and its text is bounded before.
BOUNDED = {
    r"(.{9,}) \1(?= |$)": f"a message of fewer than {LONG} characters, as the code asks before"
}
# Twice as long costs twice as much; a few steps at the ends may be more.
LINEAR = 1.4


@lru_cache(maxsize=1)
def found() -> tuple[list[Regex], set[str]]:
    """Return the patterns of the package, and the modules with one that is known at run time alone."""
    patterns: list[Regex] = []
    open_: set[str] = set()
    for module, call, inside in calls():
        try:
            patterns += made_by(module, call, inside)
        except UnresolvedError:
            open_.add(module)
    return patterns, open_


def declared() -> Iterator[Regex]:
    """Yield what stands for the patterns that are made at run time."""
    uses = frozenset(("search", "fullmatch"))
    for path in PACKAGE.rglob("*.json"):
        for text in set(_patterns_in(json.loads(path.read_text()))):
            yield Regex(text, 0, path.name, uses)
    guessing = built_in_nodes("jazzy").guessing
    yield Regex(guessing.pattern, guessing.flags, "guesses", frozenset(("fullmatch",)))


def _patterns_in(value: object) -> Iterator[str]:
    inner = list(value.values()) if isinstance(value, dict) else []
    if isinstance(value, dict) and isinstance(value.get("pattern"), str):
        yield value["pattern"]
    for it in inner or (value if isinstance(value, list) else []):
        yield from _patterns_in(it)


@lru_cache(maxsize=1)
def every() -> dict[tuple[str | bytes, int], frozenset[str]]:
    """Each pattern once, with all that is asked of it: what is not known is taken for all methods."""
    each: dict[tuple[str | bytes, int], frozenset[str]] = {}
    for it in (*found()[0], *declared()):
        key = it.pattern, int(it.flags)
        each[key] = each.get(key, frozenset()) | (it.uses or {"search", "match", "fullmatch"})
    return each


def modes(uses: frozenset[str]) -> list[str]:
    """Return the ways of the matcher that stand for methods: a search tries all places."""
    asked = {it if it in MATCH_ALONE else "search" for it in uses}
    return sorted(asked - {"match"} if "search" in asked else asked)


def test_each_pattern_is_found() -> None:
    """One that is not is made in a way that nobody looks at: make it so that it can be read here."""
    patterns, at_run_time = found()
    assert at_run_time == set(AT_RUN_TIME)
    assert len(patterns) > 400


def test_no_pattern_is_made_in_another_way() -> None:
    """By a name of ``re``, or by another module: it would not be found."""
    others = []
    for path, tree in trees().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.module in ("re", "sre_compile", "regex"):
                others.append(path.name)
            if isinstance(node, ast.Import):
                others += [path.name for it in node.names if it.name == "re" and it.asname]
            if isinstance(node, ast.Attribute) and ast.unparse(node).startswith("re."):
                # As a value, to be called elsewhere.
                others += (
                    [path.name] if node.attr == "compile" and not _is_called(tree, node) else []
                )
    assert others == []


def _is_called(tree: ast.AST, function: ast.Attribute) -> bool:
    return any(isinstance(it, ast.Call) and it.func is function for it in ast.walk(tree))


@pytest.mark.slow
@pytest.mark.parametrize("part", range(8))
def test_each_pattern_is_linear(part: int) -> None:
    slow = []
    for number, ((pattern, flags), uses) in enumerate(every().items()):
        if number % 8 != part or pattern in BOUNDED:
            continue
        for use in modes(uses):
            ratio, attack = worst(pattern, flags, use)
            if ratio > LINEAR:
                slow.append((pattern, use, round(ratio, 1), attack))
    assert slow == []


@pytest.mark.slow
def test_what_is_bounded_is_there() -> None:
    assert set(BOUNDED) <= {pattern for pattern, _ in every()}


# What was in the package once, and the texts of textbooks.
SLOW = {
    "the root behind comments": (rb"\A(?:<[?!].*?>\s*)*<model>", re.DOTALL, "search"),
    "a class of characters": (r"\[(?:\\.|[^\]])*\]", 0, "search"),
    "directives": (rb"</?([^\s/>]+)(?:[^>\"']|\"[^\"]*\")*>", 0, "search"),
    "installed folders": (r"install\(\s*DIR\s+([^)]*?)\s+TO", 0, "search"),
    "a message": (rb"\A(?:\s|#[^\n]*\n|---\s*\n)*nodes:", 0, "match"),
    "a comment without an end": (r"<!--.*?-->", re.DOTALL, "search"),
    "a tag without an end": (r"<robot\b[^>]*\sname=", 0, "search"),
    "white space at an end": (r"\s+$", 0, "search"),
    "lines of blanks": (r"^\s*name:", re.MULTILINE, "search"),
    "a number": (r"[0-9]+\.?[0-9]*", 0, "fullmatch"),
    "a word with an end": (r"\w+\.launch", 0, "search"),
    "what comes twice": (r"(a+)\1b", 0, "match"),
    "nested": (r"(a+)+b", 0, "match"),
    "alternatives": (r"(?:a|a)*b", 0, "match"),
    "a look ahead": (r"a(?=.*b)", 0, "search"),
    "three gaps": (r"a.+b.+c.+d", 0, "fullmatch"),
}


@pytest.mark.sample(6)
@pytest.mark.parametrize("name", SLOW)
def test_a_slow_pattern_is_noticed(name: str) -> None:
    pattern, flags, use = SLOW[name]
    assert worst(pattern, flags, use)[0] > LINEAR


@pytest.mark.parametrize(
    ("pattern", "use"),
    [
        (r"[a-z]+", "search"),
        (r"\Ax*y", "search"),
        (r"(?:a|b)*c", "fullmatch"),
        (r"<!--(?s:.*?)(?:-->|\Z)", "search"),
        (r"(?<!\s)\s+$", "search"),
    ],
)
def test_a_linear_pattern_is_none_of_them(pattern: str, use: str) -> None:
    assert worst(pattern, 0, use)[0] <= LINEAR


# All that the matcher knows of: it must match what Python matches, or its steps mean nothing.
KNOWN = [
    r"(a|b)*?c", r"\bab+\b", r"(?<=a)b(?!c)", r"^a.*$", r"(?m)^b|c$", r"([ab])\1", r"a{2,4}",
    r"(?:a?){3}b", r"[^a]\w\s", r"(?i)AB", r"a(?s:.)b", r"(?=(a+))\1b", r"\Aa|b\Z", r"a\B", r"(?!)",
    r"[a-b ]+?(?<!a)c", r"(a*)*b?",
]  # fmt: skip


@pytest.mark.parametrize("pattern", KNOWN)
def test_the_matcher_matches_as_python_does(pattern: str) -> None:
    chosen, program, real = random.Random(pattern), program_of(pattern), re.compile(pattern)
    for _ in range(300):
        text = "".join(chosen.choice("abcAB \n") for _ in range(chosen.randint(0, 9)))
        matcher = Matcher(program, 10**6)
        for at in range(len(text) + 1):
            match = real.match(text, at)
            assert matcher.match(text, at) == (match.end() if match else None)
        whole = real.fullmatch(text)
        assert matcher.match(text, whole=True) == (whole.end() if whole else None)


# A checker of regular expressions that others wrote finds nothing in those of the package.
with warnings.catch_warnings():
    # It reads patterns by modules that Python calls deprecated since 3.11.
    warnings.simplefilter("ignore", DeprecationWarning)
    from regexploit.ast.sre import SreOpParser
    from regexploit.redos import find


# Patterns of fnmatch, which never goes back behind a star (Python 3.11 and later: an atomic group).
UNREAD = "from_ATOMIC_GROUP"


def attacks(pattern: str | bytes, flags: int) -> list[str]:
    """Return the texts on which the checker says that a pattern takes long."""
    text = pattern if isinstance(pattern, str) else pattern.decode("latin-1")
    return [it.example() for it in find(SreOpParser().parse_sre(text, flags))]


@pytest.mark.slow
def test_the_checker_finds_nothing() -> None:
    found = {}
    for module, call, inside in calls():
        try:
            patterns = made_by(module, call, inside)
        except UnresolvedError:
            continue
        for it in patterns:
            try:
                slow = attacks(it.pattern, 0 if isinstance(it.pattern, bytes) else it.flags)
            except AttributeError as error:
                assert UNREAD in str(error), it
                continue
            if slow:
                found[it.place] = it.pattern, slow[0]
    assert found == {}


def test_the_checker_works() -> None:
    assert attacks(r"(a+)+b", 0)
    assert attacks(rb"install\(\s*DIR\s+([^)]*?)\s+TO", 0)
