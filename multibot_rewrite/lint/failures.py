# SPDX-License-Identifier: Apache-2.0
"""Findings for files that no rule can check."""

from __future__ import annotations

import os
import re
import signal

from multibot_rewrite.base import model
from multibot_rewrite.base.bounded import bytes_if_read
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, Rule
from multibot_rewrite.base.findings.selection import level_of
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.outside import unrepeatable
from multibot_rewrite.description.sources.packages import is_for_ros_1, package_of
from multibot_rewrite.description.sources.read import XACRO
from multibot_rewrite.lint.files.named import descriptions_below
from multibot_rewrite.rules.settings import Settings
from multibot_rewrite.rules.subject import Subject

_PLACE = lazy_compile(
    r"(?P<file>.*?)(?::(?P<line>\d+)(?::(?P<column>\d+))?)?: (?P<text>.*)", re.DOTALL
)
# Why a file cannot be read -> the rule that reports it.
_CODES = {
    model.UNREADABLE: "MB102", model.XACRO_FAILED: "MB103", model.NOT_DEFINED: "MB103",
    model.TEMPLATE: "MB105", model.NO_PACKAGE: "MB119", model.NO_ARGUMENT: "MB145",
}  # fmt: skip
# CMake's configure_file, Jinja, Ruby and empy make files of such files, and of parts of files.
_TEMPLATES = (".in", ".jinja", ".jinja2", ".j2", ".erb", ".em")
_MADE = "a template, in which another program fills in what is missing; lint what it makes"


def failure(path: str, error: model.InputError, settings: Settings) -> Finding:
    """Return the finding for a file that cannot be read."""
    from multibot_rewrite.lint.registry import RULES  # all rules: a file that is read needs few

    message, cause = str(error), error.cause
    if cause not in _CODES and path.endswith(_TEMPLATES):
        message, cause = f"{path}: {_MADE}", model.TEMPLATE
    code = _CODES.get(cause, "MB101")
    level = level_of(settings, code, _level(path, cause, error.name) or RULES[code].level)
    it = _PLACE.fullmatch(message)
    assert it is not None, "an InputError names its file"
    line, column = int(it["line"] or 1), int(it["column"] or 1)
    what, _, hint = it["text"].rpartition("; ")
    file = it["file"].removesuffix(" (expanded)") or path
    return Finding(code, level, what or hint, hint if what else "", file, line, column)


def _level(path: str, cause: str, name: str) -> str:
    """Return the level of a failure that is no fault for certain; "" for the level of its rule."""
    if cause == model.FOR_ROS_1:  # as it should be in a package of ROS 1; elsewhere left over
        return NOTE if is_for_ros_1(path) else WARNING
    # SDF of before 1.3 is converted by libsdformat; a template may be fine when it is filled in.
    if cause in (model.FOR_OLD_GAZEBO, model.TEMPLATE):
        return NOTE
    if cause == model.REFUSED:  # here alone: xacro and urdfdom read some of these
        return WARNING
    # TinyXML-2 looks at no encoding, and Gazebo reads its files itself; launch files stop at others.
    if cause == model.NOT_UTF8 and path.endswith((".sdf", ".world")):
        return WARNING
    if cause == model.NOT_DEFINED:  # a file may be a part of a robot
        return NOTE if name and _is_defined_in_package(path, name) else WARNING
    # It may not be meant for xacro.
    return WARNING if cause == model.XACRO_FAILED and not path.endswith(XACRO) else ""


def _is_defined_in_package(path: str, name: str) -> bool:
    """Return whether another file of the package makes a macro, property or argument of that name."""
    own = package_of(path)
    folder = own[1] if own else os.path.dirname(os.path.abspath(path))
    called = re.escape(name).encode()
    made = re.compile(rb"<xacro:(?:macro|property|arg)\s[^<>]*name=[\"']%s[\"']" % called)
    others = (it for it in descriptions_below(folder) if it != os.path.abspath(path))
    return any(made.search(bytes_if_read(it)) for it in others)


def crash(rule: Rule, subject: Subject, error: Exception) -> Finding:
    """Return the finding for a rule that crashed, so that the document is not wholly checked."""
    file = subject.document.file.removesuffix(" (expanded)")
    hint = "this is a bug in urdf-lint; use --ignore to go on"
    return _crashed(file, f"{rule.code} crashed: {_error_text(error)}", hint)


def breakdown(path: str, error: Exception) -> Finding:
    """Return the finding for a file on which the lint crashed: it was not checked completely."""
    if isinstance(error, MemoryError):
        return _crashed(path, "there is not enough memory for it", "does a macro call itself?")
    return _crashed(path, f"the lint crashed: {_error_text(error)}", "this is a bug in urdf-lint")


def lost(path: str, died_of: int) -> Finding:
    """Return the finding for a file whose process was ended by a signal, or by itself for 0."""
    how = f"by {signal.Signals(died_of).name}" if died_of else "before it was done"
    hint = "too little memory may be the reason: lint fewer files at a time"
    return _crashed(path, f"the process that linted it ended {how}", hint)


def _crashed(path: str, message: str, hint: str) -> Finding:
    """Return a finding of MB001 at the start of a file, which the cache does not keep."""
    unrepeatable()
    return Finding("MB001", ERROR, message, hint, path, 1, 1)


def _error_text(error: Exception) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())


def too_long(path: str, seconds: float) -> Finding:
    """Return the finding for a file that took too long."""
    unrepeatable()
    message = f"it took more than {seconds:g} s, the rest was not checked"
    endless = "does a macro call itself?" if path.endswith(".xacro") else ""
    return Finding("MB004", ERROR, message, endless, path, 1, 1)
