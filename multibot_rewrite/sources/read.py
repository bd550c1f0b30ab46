"""Where a description comes from: a path, text or bytes, xacro expanded on the way."""

from __future__ import annotations

import os
from collections.abc import Mapping

from multibot_rewrite.bounded import MAX_BYTES, read_bytes
from multibot_rewrite.model import InputError, UsageError

Source = str | bytes | os.PathLike[str]


def args_for(source: Source, other: Source | None, args: Mapping[str, str]) -> Mapping[str, str]:
    """The xacro arguments for ``source``: they are for a URDF, its SRDF, or both."""
    return {} if other is not None and _is_xacro(other) and not _is_xacro(source) else args


def _is_xacro(source: Source) -> bool:
    return not isinstance(source, bytes) and os.fspath(source).endswith(".xacro")


def read_source(
    source: Source, xacro_args: Mapping[str, str], trust: bool = False
) -> tuple[bytes, str]:
    """The bytes of a source and the name for messages; ``trust`` lets a xacro file do anything."""
    if isinstance(source, bytes):
        return source, "<bytes>"
    if isinstance(source, str) and source.lstrip("\ufeff \t\r\n").startswith("<"):
        return _encoded(source), "<text>"
    path = os.fspath(source)
    if path.endswith(".xacro"):
        from multibot_rewrite.sources.access import BOUNDED, TRUSTED
        from multibot_rewrite.sources.expand import expand

        reach = TRUSTED if trust else BOUNDED
        return expand(path, xacro_args, reach=reach), f"{path} (expanded)"
    if xacro_args:
        raise UsageError(f"{path}: xacro arguments given, but the file is not named ….xacro")
    return read_file(path), path


def _encoded(text: str) -> bytes:
    try:
        return text.encode()
    except UnicodeEncodeError as error:
        raise InputError(f"<text>: character {error.start + 1} is half of one: {error}") from None


def read_file(path: str, limit: int = MAX_BYTES) -> bytes:
    """The bytes of a file; raises InputError with the reason, which may be its size."""
    try:
        return read_bytes(path, limit)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", "") or error
        raise InputError(f"{path}: cannot be read: {reason}") from None
