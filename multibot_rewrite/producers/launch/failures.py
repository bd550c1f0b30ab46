# SPDX-License-Identifier: Apache-2.0
"""What goes wrong when a launch file is read: what is missing, and what fails on every machine."""

from __future__ import annotations

import os
import re
from types import FrameType
from typing import TYPE_CHECKING

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.producers.launch.source_packages import NOT_INSTALLED, ROOTS
from multibot_rewrite.producers.launch.unknown_modules import is_unknown

if TYPE_CHECKING:
    from traceback import StackSummary

# What a launch file raises by its own words; what is missing on a machine is raised otherwise, too.
_OF_CODE = (RuntimeError, NameError, TypeError, ValueError, ZeroDivisionError)
_OF_MACHINE = lazy_compile(r"(?:^|[\s\"'=:])/\w")
# ament_index_python and Python say it so; the share folder of a package that is stood in for
# (source_packages.py).
_NOT_FOUND = lazy_compile(
    rf"package '([\w-]+)' not found|{NOT_INSTALLED}/share/([\w-]+)|No module named '(\w+)"
)
_NO_TEXT, _REQUIRED = "Failed to normalize given item", "missing required argument"
# launch says so of a launch configuration that is not set, and of an argument that is not given
# (jazzy launch_configuration.py, declare_launch_argument.py).
_NO_VALUE = lazy_compile(
    r"launch configuration '([\w.-]+)' does not exist|Required launch argument \"([\w.-]+)\" was not"
)
_TRUST = "give --trust if you trust it (SECURITY.md)"
_REFUSED = f"a launch file may compute and read; {_TRUST}"
# The file as Python has it, in launch and in its stand-in; without a description it makes none.
_MODULE = "launch_file"
_MAKES = "generate_launch_description"
_ASKED = lazy_compile(r"(?:getenv|environ\.get)\(\s*[\"'](\w+)[\"']\s*\)")
_STARTED = lazy_compile(r"""\bexecutable\s*=\s*["']([\w./-]+)["']""")
_SHOWN = 8
_NEXT_TRIED = lazy_compile(r" - \w+Error: ")
_OF_ROS_1 = lazy_compile(
    r"Unknown substitution: (?:arg|find|optenv)\b"
    r"|entity of the type: (?:env|machine|param|remap|rosparam|test)\b"
)
_ROS_1 = "it is a launch file of ROS 1; in ROS 2 it is $(find-pkg-share NAME), $(var NAME), exec="


def started_by(text: str) -> str:
    """Return a clause to append: the programs that a launch file's text names; "" for none."""
    programs = shorten(_STARTED.findall(text), _SHOWN)
    return f"; by its text it starts {programs}" if programs else ""


def failure(error: BaseException) -> str:
    """Return what went wrong, in one line; for a missing package also what to do."""
    name = missing_package(error) or missing_module(error)
    if name:
        return not_installed(name)
    if isinstance(error, RecursionError):
        return "it includes or calls itself without an end"
    if isinstance(error, InputError):
        return str(error)
    if known := _known(error):
        return known
    text = " ".join(f"{type(error).__name__}: {error}".split())
    inner = error.__cause__ or error
    if isinstance(inner, FileNotFoundError) and inner.filename:
        # The folder with links to sources is gone when this is read.
        text = text.replace(str(inner.filename), os.path.realpath(inner.filename))
    # launch tries its other forms, too, and says what each of them says.
    if "Caught multiple exceptions " in text and (tried := text.partition("]: - ")[2]):
        text = _NEXT_TRIED.split(tried)[0]
    text += _line(error)
    return f"{text}; {_ROS_1}" if _OF_ROS_1.search(text) else text


def _known(error: BaseException) -> str:
    """Return a known cause and what to do; empty if there are only Python's words."""
    if variable := _variable(error):
        return f"the environment variable {variable} is not set here; set it as for ros2 launch"
    if name := _name_without_value(error):
        hint = f"give it with {name}:=VALUE, or where this is included"
        return f"the launch configuration {name!r} is not set; {hint}"
    if stopped := _stopped(error):
        return stopped
    if isinstance(error, FileNotFoundError) and re.fullmatch(r"[^/.]+", str(error.filename)):
        return f"it starts the program {error.filename!r} itself, which is not installed here"
    if isinstance(error, SystemExit):
        hint = "give it the arguments that it reads from the command line (NAME:=VALUE)"
        return f"it ends itself (sys.exit({error.code!r})); {hint}"
    return _lacking(error)


def _stopped(error: BaseException) -> str:
    """Return what the fences stop, and how to lift them; empty for another fault."""
    if isinstance(error, MemoryError):
        return f"it needs more memory than it gets{_line(error)}; {_TRUST}"
    if _is_of_thread(error):
        return f"it starts a thread{_line(error)}; {_REFUSED}"
    return f"{error}{_line(error)}; {_REFUSED}" if isinstance(error, PermissionError) else ""


def _lacking(error: BaseException) -> str:
    """Return what a launch file, or what it gives to launch, lacks; empty for another fault."""
    if isinstance(error, AttributeError) and error.name == _MAKES:
        return f"it has no function {_MAKES}(): write one that returns a LaunchDescription"
    if is_no_condition(error):
        return "its condition is not a Condition; write IfCondition(...)"
    return ""


def _line(error: BaseException) -> str:
    """Return the line of a launch file in Python that raised an error, for a message."""
    # launch has an error of its own around it.
    frames = reversed(_stack_frames(error.__cause__ or error))
    last = next((it for it in frames if it.filename.endswith("launch.py")), None)
    return f" ({os.path.basename(last.filename)}:{last.lineno})" if last else ""


def _stack_frames(error: BaseException) -> StackSummary:
    from traceback import extract_tb  # slow to import; few launch files fail

    return extract_tb(error.__traceback__)


def lost_file(error: BaseException) -> str:
    """Return what to do about a missing file; empty for another error."""
    lost = isinstance(error.__cause__ or error, FileNotFoundError)
    return "; put it there, or source the built workspace that has it" if lost else ""


def _variable(error: BaseException) -> str:
    """Return the environment variable that os.environ lacks; empty for another fault."""
    # launch has an error of its own around it.
    error = error.__cause__ or error
    frame = _frame(error)
    of_os = frame is not None and frame.f_globals.get("__name__") == "os"
    if of_os and isinstance(error, KeyError):
        return str(error.args[0])
    # os.getenv gives None, which is no part of a path.
    lines = [it.line or "" for it in _stack_frames(error)]
    asked = _ASKED.findall(" ".join(lines)) if isinstance(error, TypeError) else []
    return next((it for it in asked if it not in os.environ), "")


def _is_of_thread(error: BaseException) -> bool:
    """Return whether Python's own module refused to start a thread."""
    frame = _frame(error)
    of_module = frame is not None and frame.f_globals.get("__name__") == "threading"
    return of_module and isinstance(error, RuntimeError)


def not_installed(name: str) -> str:
    """Return the message about a missing package."""
    return f"package {name!r} is not installed here; {ROOTS}"


def missing_package(error: BaseException) -> str:
    """Return the package of ROS that was not found; empty for another fault."""
    found = _NOT_FOUND.search(str(error))
    return (found[1] or found[2] or "") if found else ""


def missing_module(error: BaseException) -> str:
    """Return the Python package that was not found; empty for another fault."""
    found = _NOT_FOUND.search(str(error))
    return (found[3] or "") if found else ""


def is_unset(error: BaseException) -> bool:
    """Return whether a launch configuration is not set, or an argument not given."""
    return bool(_name_without_value(error))


def _name_without_value(error: BaseException) -> str:
    """Return the launch configuration that an error names as not set; or empty."""
    found = _NO_VALUE.search(str(error))
    return (found[1] or found[2]) if found else ""


def is_of_file(error: BaseException) -> bool:
    """Return whether launch fails to read the file, too: it is invalid, of ROS 1 or incomplete."""
    own = (
        *(SyntaxError, NameError, RecursionError, FileNotFoundError, PermissionError),
        *(SystemExit, MemoryError, InputError),
    )
    old = _OF_ROS_1.search(str(error)) is not None
    return (
        isinstance(error.__cause__ or error, own)
        or is_without(error)
        or old
        or _is_of_thread(error)
        or bool(_variable(error))
    )


def is_without(error: BaseException) -> bool:
    """Return whether the file has no function that makes a description."""
    inner = error.__cause__ or error
    return isinstance(inner, AttributeError) and getattr(inner.obj, "__name__", "") == _MODULE


def is_no_text(error: BaseException) -> bool:
    """Return whether a path or other value is given where launch takes only texts and substitutions."""
    return isinstance(error, TypeError) and _NO_TEXT in str(error)


def is_no_condition(error: BaseException) -> bool:
    """Return whether a text or a substitution is given where launch takes only conditions."""
    if not isinstance(error, AttributeError) or error.name != "evaluate":
        return False
    is_text = hasattr(error.obj, "perform") and not hasattr(error.obj, "visit")
    return is_text or isinstance(error.obj, str | bool)


def is_certain(error: BaseException, launch_file: str) -> bool:
    """Return whether it fails on every machine: a file next to it is missing, or its code raises."""
    inner = error.__cause__ or error
    if isinstance(inner, FileNotFoundError):
        folder = os.path.dirname(os.path.realpath(launch_file))
        return os.path.realpath(str(inner.filename or "")).startswith(f"{folder}/")
    frame = _frame(error)
    if is_no_condition(error) or isinstance(error, RecursionError):
        return True
    own = frame is not None and frame.f_code.co_filename.endswith(".launch.py")
    # What is taken of a module that is not there does not fail where it is.
    known = frame is None or not any(map(is_unknown, (frame.f_globals | frame.f_locals).values()))
    # So launch itself says of an include.
    sure = own or is_no_text(error) or _REQUIRED in str(error)
    return sure and known and isinstance(error, _OF_CODE) and not _OF_MACHINE.search(str(error))


def _frame(error: BaseException) -> FrameType | None:
    """Return the frame where it was raised."""
    last = error.__traceback__
    while last is not None and last.tb_next is not None:
        last = last.tb_next
    return last.tb_frame if last is not None else None
