# SPDX-License-Identifier: Apache-2.0
"""All that the program says: messages of the code, words of rules, help, notes of data files."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from parsed import sources
from paths import ROOT

from multibot_rewrite.cli.declared.commands import COMMANDS, PROGRAMS
from multibot_rewrite.lint import catalogue

PACKAGE = ROOT / "multibot_rewrite"
# Where the notes of data files are: what comes behind one of these keys, or is an item of a list.
_NOTE = re.compile(r"^\s*(?:\w+:|-|\"(?:description|title)\":)?\s*(\S.*? \S.*)$")
_DATA = {".yaml", ".vocab", ".schema", ".json", ".js"}
# A value in a message is a word.
VALUE = "X"
_FENCED = re.compile(r"^( *)(`{3,}).*?^\1\2`*$", re.MULTILINE | re.DOTALL)
_INDENTED = re.compile(r"^    .*$", re.MULTILINE)
_QUOTED = re.compile(r"`[^`]*`")
_LINK = re.compile(r"!?\[([^\]]*)\]\([^)]*\)")
_PART = re.compile(r"\n\s*\n|\n\s*(?:[-*]|\d+\.) |\||\n#+ .*\n|\), \[|\); \[")
_FULL_STOP = re.compile(r"(?<=[.!?])[)'\"*]*\s+")
# A message and the help of an option are one line: a semicolon stands between what they say.
_IN_A_LINE = re.compile(r"(?<=[.!?;])[)'\"]*\s+|\n")


@cache
def messages() -> tuple[tuple[str, str], ...]:
    """Every text of more than one word in the code that is no docstring: with file and line."""
    return tuple(
        (f"multibot_rewrite/{path}:{line}", text)
        for path, tree in sources().items()
        for line, text in _texts(tree)
        if " " in text
    )


def _texts(it: ast.AST) -> Iterator[tuple[int, str]]:
    """Those below a node; a docstring and a comment of several lines are expressions alone."""
    if isinstance(it, (ast.Constant, ast.JoinedStr, ast.BinOp)):
        text = _joined(it)
        if text:
            yield it.lineno, text
            return
    if isinstance(it, ast.Expr) and isinstance(it.value, ast.Constant):
        return
    for one in ast.iter_child_nodes(it):
        yield from _texts(one)


def _joined(it: ast.AST) -> str:
    """Return the text of an expression, with a word for each value; empty for one that is no text."""
    if isinstance(it, ast.Constant):
        return it.value if isinstance(it.value, str) else ""
    if isinstance(it, ast.JoinedStr):
        return "".join(_joined(one) or VALUE for one in it.values)
    if isinstance(it, ast.BinOp) and isinstance(it.op, ast.Add):
        left, right = _joined(it.left), _joined(it.right)
        return (left or VALUE) + (right or VALUE) if left or right else ""
    return ""


def rule_words() -> Iterator[tuple[str, str]]:
    """Yield what each rule says, with its code."""
    for code, it in catalogue.rules().items():
        yield from ((f"{code} {name}", getattr(it, name)) for name in ("what", "why", "fix"))


def help_words() -> Iterator[tuple[str, str]]:
    """Yield what the help of each command says, with its name; no example and no list of exit codes."""
    for it in (*COMMANDS.values(), *PROGRAMS.values()):
        yield from ((it.name, text) for text in (it.about, *it.more.split("\n\n")))
        yield from ((it.name, text) for text in it.exit_codes.split("; "))
        for option in (option for group in it.groups for option in group.options):
            yield f"{it.name} {option.names[-1]}", option.help


def notes() -> Iterator[tuple[str, str]]:
    """Every line of the data files with more than one word, without comments: with file and line."""
    for path in sorted(it for it in PACKAGE.rglob("*") if it.suffix in _DATA):
        for at, line in enumerate(path.read_text().splitlines(), 1):
            found = None if line.lstrip().startswith(("#", "//")) else _NOTE.match(line)
            if found:
                yield f"{path.relative_to(ROOT)}:{at}", found[1]


def long_sentences(text: str, most: int) -> Iterator[str]:
    """Return the sentences with more words; what is quoted is a word."""
    return _longer(_FULL_STOP.split(_QUOTED.sub(VALUE, text)), most)


def long_parts(line: str, most: int) -> Iterator[str]:
    """Return the parts of a message between semicolons with more words."""
    return _longer(_IN_A_LINE.split(_QUOTED.sub(VALUE, line)), most)


def long_sentences_of_a_page(page: Path, most: int) -> Iterator[str]:
    """Those of its prose, cells of tables and items of lists."""
    text = _INDENTED.sub("", _FENCED.sub("\n\n", page.read_text()))
    for part in _PART.split(_QUOTED.sub(VALUE, text)):
        yield from long_sentences(_LINK.sub(r"\1", part), most)


def _longer(sentences: list[str], most: int) -> Iterator[str]:
    for it in sentences:
        if sum(bool(re.search(r"\w", word)) for word in it.split()) > most:
            yield " ".join(it.split())
