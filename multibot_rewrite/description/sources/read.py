# SPDX-License-Identifier: Apache-2.0
"""Where a description comes from: a path, text or bytes, xacro expanded on the way."""

import os
from collections.abc import Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite.base.bounded import MAX_BYTES, read_bytes
from multibot_rewrite.base.lazy import lazy_compile, without_comments
from multibot_rewrite.base.model import UNREADABLE, InputError, UsageError

if TYPE_CHECKING:
    from multibot_rewrite.description.sources.known_arguments import KnownArguments

Source = str | bytes | os.PathLike[str]
XACRO = ".xacro"
# A list of parts, as YAML.
JOIN = ".join"
# Files beside a description, of which a joined part may have several.
BESIDE = ("controllers", "moveit")
_SPACE = lazy_compile(rb"""xmlns:([\w.-]+)\s*=\s*["'][^"'<>]*/xacro/?["']""")


class SourceText(NamedTuple):
    """A source as it was read.

    ``file`` is its name for messages. Of a xacro file ``read`` are all paths that were read for it and
    ``known`` are the arguments that these files know; None for what is no xacro.
    """

    data: bytes
    file: str
    read: tuple[str, ...] = ()
    known: "KnownArguments | None" = None


def args_for(source: Source, other: Source | None, args: Mapping[str, str]) -> Mapping[str, str]:
    """Return the xacro arguments for ``source``: they are for a URDF, its SRDF, or both."""
    return {} if other is not None and _is_xacro(other) and not _is_xacro(source) else args


def _is_xacro(source: Source) -> bool:
    return not isinstance(source, bytes) and is_xacro(os.fspath(source))


def is_xacro(path: str) -> bool:
    """Return whether a file is a xacro, by its name or, as turtlebot3's .urdf files, its contents."""
    if not path.endswith((".urdf", ".srdf", ".sdf", ".xml")):
        return path.endswith(XACRO)
    with suppress(InputError):
        return has_xacro(read_file(path))
    return False


def has_xacro(data: bytes) -> bool:
    """Return whether a text has elements of xacro, under any prefix."""
    if b"xacro" not in data:
        return False
    text = without_comments(data)
    return any(b"<" + prefix + b":" in text for prefix in _SPACE.findall(text))


def read_alone(source: Source, xacro_args: Mapping[str, str], trust: bool = False) -> SourceText:
    """Return a source that is no list of parts, and the files read; ``trust``: no sandbox."""
    if isinstance(source, bytes):
        return SourceText(source, "<bytes>")
    if isinstance(source, str) and source.lstrip("\ufeff \t\r\n").startswith("<"):
        return SourceText(_encoded_text(source), "<text>")
    path = os.fspath(source)
    if is_xacro(path):
        from multibot_rewrite.description.sources.access import BOUNDED, TRUSTED
        from multibot_rewrite.description.sources.expand import expand_whole
        from multibot_rewrite.description.sources.known_arguments import (
            KnownArguments,
            known_arguments,
        )

        data, texts = expand_whole(path, xacro_args, reach=TRUSTED if trust else BOUNDED)
        known = known_arguments(texts.values()) if xacro_args else KnownArguments()
        return SourceText(data, f"{path} (expanded)", tuple(texts), known)
    if xacro_args:
        raise UsageError(f"{path}: it is no xacro; leave out its xacro arguments")
    return SourceText(read_model(path), path, (path,))


def read_model(path: str) -> bytes:
    """Return a plain description's bytes with the models it includes; raises as ``read_file``."""
    data = read_file(path)
    if b"<include" not in data:  # few have one
        return data
    from multibot_rewrite.description.sources.included_models import with_includes

    return with_includes(data, path)


def _encoded_text(text: str) -> bytes:
    try:
        return text.encode()
    except UnicodeEncodeError as error:
        raise InputError(f"<text>: it has a lone surrogate, decode it again: {error}") from None


def read_file(path: str, limit: int = MAX_BYTES) -> bytes:
    """Return the bytes of a file; raises InputError with the reason, which may be its size."""
    try:
        return read_bytes(path, limit)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", "") or error
        more = "; name a file in it" if isinstance(error, IsADirectoryError) else ""
        raise InputError(f"{path}: cannot be read: {reason}{more}", UNREADABLE) from None
