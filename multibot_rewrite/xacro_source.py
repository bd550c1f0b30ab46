"""Expand xacro through its own API. The only import of xacro."""

from __future__ import annotations

import os
from collections.abc import Mapping

from multibot_rewrite.model import InputError

_HINTS = (
    ("Undefined substitution argument", "give it as NAME:=VALUE"),
    ("ament_index_python", "$(find ...) needs a sourced ROS 2, or ament_index_python"),
    ("package", "source the workspace that holds it"),
    ("No such file", "check the include path"),
)


def expand(path: str, arguments: Mapping[str, str]) -> bytes:
    """The URDF text of a xacro file, UTF-8; raises InputError with xacro's reason."""
    if not os.path.isfile(path):
        raise InputError(f"{path}: cannot be read: No such file or directory")
    import xacro

    try:
        document = xacro.process_file(path, mappings=dict(arguments))
    except Exception as error:  # xacro runs the file's own Python expressions
        raise InputError(_message(path, error)) from None
    text: str = document.toprettyxml(indent="  ")
    return text.encode()


def _message(path: str, error: Exception) -> str:
    reason = " ".join(str(error).split()) or type(error).__name__
    hint = next((hint for word, hint in _HINTS if word in reason), "run xacro on it to see more")
    return f"{path}: xacro failed: {reason}; {hint}"
