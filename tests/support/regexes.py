# SPDX-License-Identifier: Apache-2.0
"""The regular expressions of the package, found in its source: none is listed by hand."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from contextlib import suppress
from fnmatch import translate
from functools import cache, lru_cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from paths import ROOT

from multibot_rewrite.base.lazy import with_gaps

PACKAGE = ROOT / "multibot_rewrite"
_LOCAL = (ast.FunctionDef, ast.Lambda, ast.DictComp, ast.GeneratorExp, ast.ListComp)
_HOLDERS = (ast.Assign, ast.AnnAssign)
USES = ("match", "fullmatch", "search", "sub", "subn", "split", "findall", "finditer")
# A word in place of each that ``re.escape`` gets at run time.
WORD = "nam"


class Regex(NamedTuple):
    """A regular expression, where it is made, and by which methods it is used; empty for unknown."""

    pattern: str | bytes
    flags: int
    place: str
    uses: frozenset[str]


class UnresolvedError(Exception):
    """An expression whose value is known at run time alone."""


@lru_cache(maxsize=1)
def trees() -> Mapping[Path, ast.Module]:
    """Return the syntax tree of each module of the package."""
    return {it: ast.parse(it.read_text()) for it in sorted(PACKAGE.rglob("*.py"))}


@lru_cache(maxsize=1)
def uses_of_names() -> Mapping[tuple[str, str], frozenset[str]]:
    """Return the methods of patterns that are asked of each name: of a private one in its module."""
    found: dict[tuple[str, str], set[str]] = defaultdict(set)
    for path, tree in trees().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.Attribute) and node.attr in USES:
                found[_key(_last(node.value), _module(path))].add(node.attr)
    return {key: frozenset(uses) for key, uses in found.items()}


def _key(name: str, module: str) -> tuple[str, str]:
    return name, module if name.startswith("_") else ""


def _module(path: Path) -> str:
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def _last(node: ast.expr) -> str:
    """Return the name that an expression ends with; that of the table for an entry of one."""
    if isinstance(node, ast.Subscript):
        return _last(node.value)
    if isinstance(node, ast.Name):
        return node.id
    return node.attr if isinstance(node, ast.Attribute) else ""


def calls() -> Iterator[tuple[str, ast.Call, tuple[ast.AST, ...]]]:
    """Each call that makes a pattern: its module, the call, and what it is in, the innermost last."""
    for path, tree in trees().items():
        module = _module(path)
        if module != "multibot_rewrite.base.lazy":
            yield from ((module, call, inside) for call, inside in _calls(tree, ()))


def _calls(
    node: ast.AST, inside: tuple[ast.AST, ...]
) -> Iterator[tuple[ast.Call, tuple[ast.AST, ...]]]:
    if isinstance(node, ast.Call) and _use_of(node):
        yield node, inside
    for child in ast.iter_child_nodes(node):
        yield from _calls(child, (*inside, node))


def _use_of(call: ast.Call) -> str:
    """``compile`` or the function of ``re`` that is called; empty for any other call."""
    name = ast.unparse(call.func)
    if name == "lazy_compile":
        return "compile"
    module, _, use = name.rpartition(".")
    return use if module == "re" and use in (*USES, "compile") else ""


def made_by(module: str, call: ast.Call, inside: tuple[ast.AST, ...]) -> list[Regex]:
    """Return the patterns that a call makes; UnresolvedError if known at run time alone."""
    holder = _holder(inside)
    if holder is not None and not any(isinstance(it, ast.FunctionDef) for it in inside):
        # A table that the module has made.
        made = [
            it
            for name in _names(holder)
            for it in _patterns_in(getattr(import_module(module), name))
        ]
        if made and any(isinstance(it, _LOCAL) for it in inside):
            uses = _uses(inside, module)
            return [Regex(it.pattern, it.flags, f"{module}:{call.lineno}", uses) for it in made]
    try:
        return _made_by(module, call, inside, WORD)
    except TypeError:
        return _made_by(module, call, inside, WORD.encode())


def _holder(inside: tuple[ast.AST, ...]) -> ast.Assign | ast.AnnAssign | None:
    return next((it for it in reversed(inside) if isinstance(it, _HOLDERS)), None)


def _names(holder: ast.Assign | ast.AnnAssign) -> list[str]:
    targets = holder.targets if isinstance(holder, ast.Assign) else [holder.target]
    return [it.id for one in targets for it in ast.walk(one) if isinstance(it, ast.Name)]


def _patterns_in(value: object) -> Iterator[Any]:
    if isinstance(value, Mapping):
        value = tuple(value.values())
    if isinstance(value, (tuple, list)):
        yield from (found for it in value for found in _patterns_in(it))
    elif hasattr(value, "pattern"):
        yield value


def _made_by(
    module: str, call: ast.Call, inside: tuple[ast.AST, ...], word: str | bytes
) -> list[Regex]:
    values = _Values(import_module(module), inside, word)
    use = _use_of(call)
    flags = [it.value for it in call.keywords if it.arg == "flags"]
    if use == "compile":
        flags += call.args[1:2]
    elif use in ("search", "match", "fullmatch", "findall", "finditer"):
        flags += call.args[2:3]
    flag = int(values.of(flags[0])) if flags else 0
    uses = frozenset([use]) if use != "compile" else _uses(inside, module)
    place = f"{module}:{call.lineno}"
    pattern = values.of(call.args[0])
    if isinstance(pattern, re.Pattern):
        return []
    return [Regex(pattern, flag, place, uses)]


def _uses(inside: tuple[ast.AST, ...], module: str) -> frozenset[str]:
    """By what the pattern is used that is bound to a name here; empty where no one says."""
    holder = _holder(inside)
    made_by = [it for it in inside if isinstance(it, ast.FunctionDef)]
    if made_by and isinstance(inside[-1], ast.Return) and made_by[-1].name.startswith("_"):
        return uses_here(module)
    if holder is None or any(isinstance(it, ast.Call) for it in inside[inside.index(holder) :]):
        return frozenset()
    found = [uses_of(it, module) for it in _names(holder)]
    return frozenset().union(*found) if all(found) else frozenset()


def uses_of(name: str, module: str) -> frozenset[str]:
    """Return the methods asked of a name, or of the table that it is in."""
    own = uses_of_names().get(_key(name, module), frozenset())
    tables = tables_of_names().get((name, module), ())
    return own.union(*(uses_of(it, module) for it in tables if it != name))


@cache
def uses_here(module: str) -> frozenset[str]:
    """Return the methods that a module asks of patterns that no constant holds."""
    tree = next(tree for path, tree in trees().items() if _module(path) == module)
    asked = [it for it in ast.walk(tree) if isinstance(it, ast.Attribute) and it.attr in USES]
    # Any text can be split.
    local = (it for it in asked if not _last(it.value).isupper() and it.attr != "split")
    return frozenset(it.attr for it in local if _last(it.value) != "re")


@lru_cache(maxsize=1)
def tables_of_names() -> Mapping[tuple[str, str], frozenset[str]]:
    """Return the names of the tables of a module that hold a name."""
    found: dict[tuple[str, str], set[str]] = defaultdict(set)
    for path, tree in trees().items():
        for node in tree.body:
            if isinstance(node, ast.Assign) and isinstance(node.value, (ast.Dict, ast.Tuple)):
                held = {it.id for it in ast.walk(node.value) if isinstance(it, ast.Name)}
                for name in held:
                    found[name, _module(path)].update(map(_last, node.targets))
    return {key: frozenset(names) for key, names in found.items()}


class _Values:
    """What expressions are worth, with a word in place of what is escaped at run time."""

    def __init__(self, module: ModuleType, inside: tuple[ast.AST, ...], word: str | bytes) -> None:
        self.module, self.inside, self.word = module, inside, word

    def of(self, node: ast.expr) -> Any:
        if not any(isinstance(it, _LOCAL) for it in self.inside):
            # Of a module: it has made this before.
            return eval(ast.unparse(node), vars(self.module))
        of_kind = getattr(self, f"_{type(node).__name__.lower()}", None)
        if of_kind is None:
            raise UnresolvedError(ast.unparse(node))
        return of_kind(node)

    def _constant(self, node: ast.Constant) -> Any:
        return node.value

    def _joinedstr(self, node: ast.JoinedStr) -> str:
        return "".join(str(self.of(it)) for it in node.values)

    def _formattedvalue(self, node: ast.FormattedValue) -> Any:
        return self.of(node.value)

    def _attribute(self, node: ast.Attribute) -> Any:
        return getattr(self.of(node.value), node.attr)

    def _tuple(self, node: ast.Tuple) -> tuple[Any, ...]:
        return tuple(map(self.of, node.elts))

    def _boolop(self, node: ast.BoolOp) -> Any:
        return self._of_either(*node.values)

    def _ifexp(self, node: ast.IfExp) -> Any:
        return self._of_either(node.body, node.orelse)

    def _name(self, node: ast.Name) -> Any:
        name = node.id
        for above in reversed(self.inside):
            if not isinstance(above, (ast.FunctionDef, ast.Lambda)):
                continue
            made = [
                it.value
                for it in ast.walk(above)
                if isinstance(it, ast.Assign) and any(_last(one) == name for one in it.targets)
            ]
            if len(made) == 1:
                return self.of(made[0])
            names = {it.arg for it in ast.walk(above) if isinstance(it, ast.arg)}
            if made or name in names:
                raise UnresolvedError(name)
        if not hasattr(self.module, name):
            raise UnresolvedError(name)
        return getattr(self.module, name)

    def _binop(self, node: ast.BinOp) -> Any:
        left, right = self.of(node.left), self.of(node.right)
        if isinstance(node.op, ast.Add):
            return left + right
        if isinstance(node.op, ast.BitOr):
            return left | right
        if isinstance(node.op, ast.Mod):
            return left % right
        raise UnresolvedError(ast.unparse(node))

    def _of_either(self, *nodes: ast.expr) -> Any:
        for node in nodes:
            with suppress(UnresolvedError):
                return self.of(node)
        raise UnresolvedError(ast.unparse(nodes[0]))

    def _call(self, node: ast.Call) -> Any:
        called, words = ast.unparse(node.func), (self.word, self.word[::-1], self.word)
        if called == "re.escape":
            return self.word
        if called == "with_gaps":
            return with_gaps(words, self.of(node.args[1]))
        if not isinstance(node.func, ast.Attribute):
            raise UnresolvedError(called)
        if node.func.attr == "join":
            return self.of(node.func.value).join(self._joined(node.args[0]))
        if node.func.attr == "encode":
            return self._encoded(node.func.value)
        if node.func.attr in ("format", "replace"):
            whole = self.of(node.func.value)
            return getattr(whole, node.func.attr)(*map(self.of, node.args))
        raise UnresolvedError(called)

    def _encoded(self, node: ast.expr) -> bytes:
        try:
            return bytes(self.of(node).encode())
        except UnresolvedError:
            return self.word if isinstance(self.word, bytes) else self.word.encode()

    def _joined(self, node: ast.expr) -> list[Any]:
        """Two words in place of those that are joined, each escaped or with wildcards."""
        text = ast.unparse(node)
        words = [self.word, self.word[::-1]]
        if text.startswith(("map(re.escape,", "(re.escape(")):
            return words
        if text.startswith("map(translate,"):
            return [translate(f"*{it}*{it}*{it}") for it in words]
        raise UnresolvedError(text)
