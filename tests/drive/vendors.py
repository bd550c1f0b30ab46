# SPDX-License-Identifier: Apache-2.0
"""What a node of a vendor's own Python package opens, by its source: names are texts there, or values
of parameters. What has another name, or is written otherwise, is not known."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from programs import Opened

# Role, and where type and name stand, by the call that opens an end.
CALLS = {
    "create_publisher": ("publishes", 0, 1),
    "create_subscription": ("subscribes", 0, 1),
    "create_service": ("serves", 0, 1),
    "create_client": ("calls", 0, 1),
    "ActionServer": ("serves", 1, 2),
    "ActionClient": ("calls", 1, 2),
}
FRAMES = ("header.frame_id", "child_frame_id")
TF_SENT = "sendTransform"
TF = Opened("publishes", "/tf", "tf2_msgs/msg/TFMessage")


class Source(NamedTuple):
    """The ends of a node, and parent and child of the transform that it sends, if it sends one."""

    ends: tuple[Opened, ...] = ()
    frames: tuple[str, str] | None = None


def source_of(package: str, program: str, roots: Sequence[Path]) -> Path | None:
    """Return the file of a program of a package below some folders."""
    for xml in (it for root in roots for it in root.rglob("package.xml")):
        if f"<name>{package}</name>" not in xml.read_text(errors="replace"):
            continue
        setup, inner = xml.with_name("setup.py"), rf"{re.escape(program)}\s*=\s*([\w.]+):"
        found = re.search(inner, setup.read_text()) if setup.is_file() else None
        file = f"{found[1].replace('.', '/')}.py" if found else program
        names = [file, f"src/{file}" if found else f"**/{file}"]
        return next((it for name in names for it in xml.parent.glob(name) if it.is_file()), None)
    return None


def opened(file: Path, values: Mapping[str, Any]) -> Source:
    """Return what a file's node opens with these parameters; nothing if a part is not known."""
    try:
        tree = ast.parse(file.read_text())
        return Source(tuple(ends_of(tree, values)), frames_of(tree, values))
    except (SyntaxError, LookupError):
        return Source()


def ends_of(tree: ast.AST, values: Mapping[str, Any]) -> Iterator[Opened]:
    kinds = {
        name.asname or name.name: f"{it.module.replace('.', '/')}/{name.name}"
        for it in ast.walk(tree)
        if isinstance(it, ast.ImportFrom) and re.search(r"\.(msg|srv|action)$", it.module or "")
        for name in it.names
    }
    for call in (it for it in ast.walk(tree) if isinstance(it, ast.Call)):
        word = called(call)
        if word in CALLS:
            role, kind, name = CALLS[word]
            yield Opened(
                role, text_of(call.args[name], tree, values), kinds[ast.unparse(call.args[kind])]
            )
        elif word == "TransformBroadcaster":
            yield TF


def frames_of(tree: ast.AST, values: Mapping[str, Any]) -> tuple[str, str] | None:
    if not any(isinstance(it, ast.Call) and called(it) == TF_SENT for it in ast.walk(tree)):
        return None
    parent, child = (
        next(text for name, text in assigned(tree) if name.endswith(f".{it}")) for it in FRAMES
    )
    return text_of(parent, tree, values), text_of(child, tree, values)


def called(call: ast.Call) -> str:
    return ast.unparse(call.func).rpartition(".")[2]


def assigned(tree: ast.AST) -> Iterator[tuple[str, ast.expr]]:
    """Yield what is assigned, by the name that it gets."""
    for it in ast.walk(tree):
        if isinstance(it, ast.Assign):
            yield ast.unparse(it.targets[0]), it.value


def text_of(it: ast.expr, tree: ast.AST, values: Mapping[str, Any]) -> str:
    """Return the text of an expression; raises LookupError for another one than a text, a
    parameter, or a name that has one of these."""
    if isinstance(it, ast.Constant):
        return str(it.value)
    for call in (one for one in ast.walk(it) if isinstance(one, ast.Call)):
        if called(call) in ("get_parameter", "declare_parameter"):
            name = text_of(call.args[0], tree, values)
            return str(values[name] if name in values else default_of(name, tree))
    found = {name: value for name, value in assigned(tree) if value is not it}
    return text_of(found[ast.unparse(it)], tree, values)


def default_of(name: str, tree: ast.AST) -> Any:
    calls = (it for it in ast.walk(tree) if isinstance(it, ast.Call))
    for it in (one for one in calls if called(one) == "declare_parameter"):
        if ast.literal_eval(it.args[0]) == name:
            return ast.literal_eval(it.args[1])
    raise LookupError(name)
