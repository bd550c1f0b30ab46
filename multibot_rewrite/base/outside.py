# SPDX-License-Identifier: Apache-2.0
"""What a result rests on besides its arguments: answers of the disk and of the environment.

A function that asks them is marked ``outside``. While ``recorded`` runs a job, each call of such a
function is noted with a digest of its answer. ``answer_now`` asks again, so a result that was kept
still holds where all answers are the same.
"""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import wraps
from importlib import import_module
from typing import Any, NamedTuple, ParamSpec, TypeVar

try:
    from _blake2 import blake2b  # hashlib loads OpenSSL, which takes longer than a short lint
except ImportError:  # an interpreter that was built without it
    from hashlib import blake2b

_P = ParamSpec("_P")
_T = TypeVar("_T")
PACKAGE = __name__.partition(".")[0] + "."
# A longer answer is noted by its digest alone.
SHORT = 40


class Question(NamedTuple):
    """A call of a function that is marked ``outside``: its name, and its arguments."""

    function: str
    arguments: tuple[Any, ...]
    named: tuple[tuple[str, Any], ...] = ()


Asked = dict[Question, str]
# Stands among the questions where the same job may have another result.
UNREPEATABLE = Question("", ())
_NOTES: ContextVar[Asked | None] = ContextVar("asked", default=None)


def outside(function: Callable[_P, _T]) -> Callable[_P, _T]:
    """Mark a function whose answer is that of the disk or the environment.

    Arguments are texts, numbers and tuples of them; an answer is that, bytes or a set of texts.
    """
    name = f"{function.__module__}:{function.__qualname__}"

    @wraps(function)
    def asking(*arguments: _P.args, **named: _P.kwargs) -> _T:
        """Return the answer of the function, noted where a job's questions are recorded."""
        notes = _NOTES.get()
        if notes is None:
            return function(*arguments, **named)
        question = Question(name, arguments, tuple(sorted(named.items())))
        try:
            with _noting_in(None):  # what it asks in turn is in its answer
                answer = function(*arguments, **named)
        except Exception as error:  # whatever it is, the caller gets it
            _note(notes, question, _error_digest(error))
            raise
        _note(notes, question, digest(answer))
        return answer

    asking.is_outside = True  # type: ignore[attr-defined]
    return asking


def recorded(job: Callable[[], _T]) -> tuple[_T, Asked | None]:
    """Return the result of a job and what it asked for; None for the latter if it may change."""
    notes: Asked = {}
    with _noting_in(notes):
        result = job()
    return result, None if UNREPEATABLE in notes else notes


def unrepeatable() -> None:
    """Note that the result of the running job may differ next time: it rests on time or memory."""
    notes = _NOTES.get()
    if notes is not None:
        notes[UNREPEATABLE] = ""


def answer_now(question: Question) -> str:
    """Return the digest of today's answer; raises LookupError for an unmarked function."""
    module, _, name = question.function.partition(":")
    function = getattr(import_module(module), name, None) if module.startswith(PACKAGE) else None
    if not getattr(function, "is_outside", False):
        raise LookupError(question.function)
    try:
        with _noting_in(None):
            return digest(function(*question.arguments, **dict(question.named)))  # type: ignore[misc]
    except Exception as error:  # the same error is the same answer
        return _error_digest(error)


def digest(answer: object) -> str:
    """Return a short text that differs if two answers do."""
    if isinstance(answer, bytes):
        return blake2b(answer, digest_size=16).hexdigest()
    if isinstance(answer, (set, frozenset)):
        answer = sorted(answer)
    if isinstance(answer, tuple):
        answer = [digest(it) for it in answer]
    text = repr(answer)
    return text if len(text) <= SHORT else digest(text.encode("utf-8", "backslashreplace"))


def _error_digest(error: Exception) -> str:
    return f"{type(error).__name__} {digest(str(error))}"


def _note(notes: Asked, question: Question, answer: str) -> None:
    """Note the answer to a question, as unrepeatable where it differs from an earlier answer."""
    if notes.setdefault(question, answer) != answer:
        notes[UNREPEATABLE] = ""  # it changed while the job ran


@contextmanager
def _noting_in(notes: Asked | None) -> Iterator[None]:
    """Note answers in ``notes`` while the block runs; with None nothing is noted."""
    before = _NOTES.set(notes)
    try:
        yield
    finally:
        _NOTES.reset(before)


@outside
def is_file(path: str) -> bool:
    """Return whether a path leads to a file, also by a link."""
    return os.path.isfile(path)


@outside
def is_folder(path: str) -> bool:
    """Return whether a path leads to a folder, also by a link."""
    return os.path.isdir(path)


@outside
def is_there(path: str) -> bool:
    """Return whether anything exists at a path, behind a link as well."""
    return os.path.exists(path)


@outside
def real_path(path: str) -> str:
    """Return the path with links resolved."""
    return os.path.realpath(path)


@outside
def variable(name: str) -> str | None:
    """Return a variable of the environment; None if it is not set."""
    return os.environ.get(name)


@outside
def file_state(path: str) -> tuple[int, ...]:
    """Return time and size of a file, which change when it is written; empty for no file."""
    try:
        it = os.stat(path)
    except (OSError, ValueError):
        return ()
    return it.st_mtime_ns, it.st_size


def kept_bytes(path: str, most: int) -> bytes:
    """Return the first bytes of a large file, taken as unchanged by time and size; raises OSError."""
    file_state(path)
    with _noting_in(None), open(path, "rb") as file:
        return file.read(most)
