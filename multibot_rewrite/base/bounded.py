# SPDX-License-Identifier: Apache-2.0
"""Files, YAML and JSON of anybody, read within bounds: the only calls of the two parsers.

The parsers themselves have none: PyYAML's in C ends the process where lists are nested deeply, an alias
of aliases stands for more nodes than memory holds, Python refuses to convert very long numbers.
A fault in YAML is an InputError with its place, so that no reader forgets one of the kinds that PyYAML
raises: an unknown tag, a list as a key, a date that is none. Faults of JSON are the parser's own.
"""

from __future__ import annotations

import errno
import os
import re
import stat
from collections.abc import Callable, Mapping
from functools import cache, partial
from itertools import accumulate
from math import radians
from typing import TYPE_CHECKING, Any, NoReturn

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.outside import outside

if TYPE_CHECKING:
    import yaml

MAX_BYTES = 16 * 1024 * 1024
# A plan or snapshot has some ten kB a robot.
MAX_FLEET_BYTES = 256 * 1024 * 1024
# No file of a robot comes near: parameters have 10 levels, RViz's groups 20.
MAX_DEPTH = 100
# What aliases may stand for, together: MoveIt's files repeat some hundred values.
MAX_REPEATED = 100_000
MAX_DIGITS = 100
# What to do about a text that is no YAML.
CORRECT = "correct the YAML"
# Where a text is from that is no file, such as an argument of a launch.
A_VALUE = "the value"
_SEVERAL = ("there is more than one document", "delete everything from the second --- on")
# What YAML 1.1 takes for something else where no quotes are around it, however it is capitalized.
QUOTED = frozenset(["~", "null", "true", "false", "yes", "no", "on", "off", "y", "n"])
# Where `<(xacro ...)` and standard input are.
_OF_A_SHELL = ("/dev/", "/proc/")
_TAG = "tag:yaml.org,2002:"
_TEXT = f"{_TAG}str"
# Of YAML 1.1, as PyYAML has them.
_TRUTH = [it for word in ("yes", "no", "true", "false", "on", "off") for it in
          (word, word.capitalize(), word.upper())]  # fmt: skip
_NOTHING = ("", "~", "null", "Null", "NULL")
# What PyYAML converts without a look at what Python cannot.
_CONVERTED = ("int", "float", "bool", "timestamp")
# Tags that launch files and xacro give PyYAML (launch_param_builder utils.py, xacro __init__.py) -> the
# number that a text is.
ANGLES: Mapping[str, Callable[[float], float]] = {"!degrees": radians, "!radians": float}
# A block list or mapping is indented more than the one around it, or the one around that.
_INDENTED = rf"[ \t\-?:]{{{MAX_DEPTH // 2}}}"
# A list or mapping in brackets that holds no other one, and nothing where a bracket is a character.
_IN_BRACKETS = r"[\[{][^]\[{}\"'#]*[]}]"
_STEPS = {ord("["): 1, ord("{"): 1, ord("]"): -1, ord("}"): -1}
_NO_BRACKETS = bytes(set(range(256)) - _STEPS.keys() - {ord('"')})

# The texts that an editor has open, by the files' real paths, in a process that answers one question.
OPEN_TEXTS: dict[str, bytes] = {}


def open_text(path: str) -> bytes | None:
    """Return the text of a file as an editor has it open; None where none has."""
    return OPEN_TEXTS.get(os.path.realpath(path)) if OPEN_TEXTS else None


@outside
def read_bytes(path: str, limit: int = MAX_BYTES) -> bytes:
    """Return the bytes of a file or device; raises OSError (also if too large) and ValueError."""
    if (text := open_text(path)) is not None:
        return text
    _refuse_pipe(path)
    with open(path, "rb") as file:
        # Not the limit at once: the memory for it takes longer to get than most files to read.
        size = min(os.fstat(file.fileno()).st_size, limit)
        data = file.read(size + 1)
        if size < len(data) <= limit:  # it grows, or has no size, as a device
            data += file.read(limit)
    if len(data) > limit:
        raise OSError(errno.EFBIG, f"it is over the limit of {limit:,} bytes", path)
    return data


@outside
def read_start(path: str, most: int) -> bytes:
    """Return the first bytes of a file; raises OSError, also for a pipe, and ValueError."""
    _refuse_pipe(path)
    with open(path, "rb") as file:
        return file.read(most)


def _refuse_pipe(path: str) -> None:
    if stat.S_ISFIFO(os.stat(path).st_mode) and not path.startswith(_OF_A_SHELL):
        raise OSError(errno.EINVAL, "it is a pipe, and reading it may never end: give a file", path)


def bytes_if_read(path: str) -> bytes:
    """Return the bytes of a file, or none if it cannot be read."""
    try:
        return read_bytes(path)
    except (OSError, ValueError):
        return b""


def read_text(path: str) -> str:
    """Return a file's text with plain line ends; raises as ``read_bytes``, or UnicodeDecodeError."""
    text = read_bytes(path).decode().removeprefix("\ufeff")  # utf-8-sig is a module to be loaded
    return text.replace("\r\n", "\n").replace("\r", "\n") if "\r" in text else text


def own_text(module: str, name: str) -> str:
    """Return the text of a file of this package in the folder of ``module``, a ``__file__``."""
    return read_text(os.path.join(os.path.dirname(module), name))


def own_rows(module: str, name: str) -> list[list[str]]:
    """Return the rows of a table of this package, next to ``module``; ``|`` is between columns."""
    lines = own_text(module, name).splitlines()
    rows = (it.split("|") for it in lines if it and not it.startswith("#"))
    return [[column.strip() for column in row] for row in rows]


def compose_yaml(text: str, file: str, remedy: str = CORRECT) -> yaml.Node | None:
    """Return PyYAML's node of the one document; raises InputError with the place in ``file``."""
    import yaml

    node: yaml.Node | None = _parsed_within_bounds(
        partial(yaml.compose, Loader=_loader()), text, file, remedy
    )
    return node


def compose_own_yaml(text: str) -> yaml.Node | None:
    """Return the root node of YAML of this package: no limits; all but booleans and null is text."""
    import yaml

    return yaml.compose(text, Loader=_plain_loader())


def load_yaml(text: str, file: str, remedy: str = CORRECT) -> Any:
    """Return the value of the one document; raises InputError with the place in ``file``."""
    import yaml

    return _parsed_within_bounds(partial(yaml.load, Loader=_loader()), text, file, remedy)


def load_own_yaml(module: str, name: str) -> Any:
    """Return the value of a YAML file of this package, next to ``module``, without limits."""
    import yaml

    return yaml.load(own_text(module, name), _loader())


def _parsed_within_bounds(parse: Callable[[str], Any], text: str, file: str, remedy: str) -> Any:
    """Return what ``parse`` makes of a YAML text; raises InputError if it is wrong or too large."""
    import yaml

    try:
        _check_bounds(text)
        return parse(text)
    except (yaml.YAMLError, UnicodeEncodeError) as error:
        raise InputError(_yaml_fault(error, text, file, remedy)) from None


def _yaml_fault(error: Exception, text: str, file: str, remedy: str) -> str:
    """Return place, cause and remedy in one line."""
    mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    if mark is None:
        return f"{file}: not valid YAML: {' '.join(str(error).split())}; {remedy}"
    line, column = mark.line + 1, mark.column + 1
    if line > text.count("\n") + 1:  # behind the end of a document that is not complete
        line, column = text.count("\n") + 1, len(text) - text.rfind("\n")
    problem = " ".join(str(error.problem or error.context).split())  # type: ignore[attr-defined]
    if "expected a single document" in str(getattr(error, "context", "")):
        problem, remedy = _SEVERAL
    elif text[mark.index : mark.index + 1] == "\t":
        problem, remedy = "a tab", "indent with spaces; YAML does not allow tabs"
    return f"{file}:{line}:{column}: not valid YAML: {problem}; {remedy}"


def load_json(data: bytes | str, made: Callable[[dict[str, Any]], object] | None = None) -> Any:
    """Return the value of a JSON text; ``made`` replaces each object; raises JSONDecodeError."""
    import json

    raw = data if isinstance(data, bytes) else data.encode("utf-8", "surrogatepass")
    text = data if isinstance(data, str) else data.decode("utf-8-sig")
    if _json_depth(raw) > MAX_DEPTH:
        raise json.JSONDecodeError(f"it is nested deeper than {MAX_DEPTH} levels", text, 0)

    def whole(digits: str) -> int:
        """Return the number of these digits; raises JSONDecodeError for too many."""
        if len(digits) > MAX_DIGITS:
            # Where it is does not matter to whoever made it.
            raise json.JSONDecodeError(_too_many_digits(digits), text, text.index(digits))
        return int(digits)

    return json.loads(text, parse_int=whole, object_hook=made)


def _too_many_digits(number: str) -> str:
    return f"a number of {len(number):,} characters, over the limit of {MAX_DIGITS}"


def _json_depth(data: bytes) -> int:
    """Return how deeply brackets are nested, those in strings aside."""
    plain = re.sub(rb"\\.", b"", data, flags=re.DOTALL) if b"\\" in data else data
    # Without what is between two quotes, whether they are of one string or of two: what is left of
    # many megabytes is little, and a bracket is inside a string or outside as before.
    left = plain.translate(None, _NO_BRACKETS).replace(b'""', b"")
    outside = b"".join(left.split(b'"')[::2])
    return max(accumulate(map(_STEPS.__getitem__, outside)), default=0)


@cache
def _loader() -> type[yaml.SafeLoader]:
    """Return the safe YAML loader, in C if PyYAML has it; its errors have the place."""
    import yaml

    base: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    loader: Any = type("BoundedLoader", (base,), {})
    for kind in _CONVERTED:
        construct = base.yaml_constructors[_TAG + kind]
        loader.add_constructor(_TAG + kind, _with_digit_limit(construct, kind))
    for tag, read in ANGLES.items():
        construct = partial(lambda read, own, node: read(float(own.construct_scalar(node))), read)
        loader.add_constructor(tag, _with_digit_limit(construct, tag))
    return loader  # type: ignore[no-any-return]


@cache
def _plain_loader() -> type[yaml.SafeLoader]:
    """Return a loader that reads numbers and dates as text, without PyYAML's search for patterns."""
    import yaml

    words = {**dict.fromkeys(_TRUTH, f"{_TAG}bool"), **dict.fromkeys(_NOTHING, f"{_TAG}null")}
    kinds = {yaml.SequenceNode: f"{_TAG}seq", yaml.MappingNode: f"{_TAG}map"}

    def resolve(_: object, kind: Any, value: str, implicit: tuple[bool, bool]) -> str:
        if kind is yaml.ScalarNode:
            return words.get(value, _TEXT) if implicit[0] else _TEXT
        return kinds[kind]

    own: Any = type("PlainLoader", (_loader(),), {"resolve": resolve})
    return own  # type: ignore[no-any-return]


def _with_digit_limit(construct: Any, kind: str) -> Any:
    """Return a YAML constructor that raises ConstructorError for a wrong or too long value."""
    from yaml.constructor import ConstructorError

    def checked(loader: Any, node: yaml.Node) -> Any:
        if len(node.value) > MAX_DIGITS:
            raise ConstructorError(None, None, _too_many_digits(node.value), node.start_mark)
        try:
            return construct(loader, node)
        except (ArithmeticError, AttributeError, LookupError, ValueError):
            # `2024-13-01`, `!!int x`
            message = f"{node.value!r} is not a value of the kind {kind}"
            raise ConstructorError(None, None, message, node.start_mark) from None

    return checked


def _check_bounds(text: str) -> None:
    """Raise yaml's ComposerError for what nests or repeats too much."""
    # A quick look, which suffices for nearly all files.
    flat = re.sub(_IN_BRACKETS, "", re.sub(_IN_BRACKETS, "", text))  # without two levels
    flow = flat.count("[") + flat.count("{") + 2
    aliases = "*" in text and "&" in text
    if flow < MAX_DEPTH and not aliases and not re.search(_INDENTED, text):
        return
    import yaml

    above: list[tuple[str | None, int]] = []
    # Nodes so far, and those that each anchor stands for.
    count, repeated = 0, 0
    anchored: dict[str | None, int] = {}
    for event in yaml.parse(text, Loader=_loader()):
        if isinstance(event, yaml.CollectionStartEvent):
            above.append((event.anchor, count))
            if len(above) > MAX_DEPTH:
                _raise_composer_error(event, f"it is nested deeper than {MAX_DEPTH} levels")
        elif isinstance(event, yaml.CollectionEndEvent):
            anchor, before = above.pop()
            if anchor is not None:
                anchored[anchor] = count - before
        elif isinstance(event, yaml.AliasEvent):
            if any(event.anchor == anchor for anchor, _ in above):
                _raise_composer_error(event, "the alias is inside the value that it repeats")
            repeated += anchored.get(event.anchor, 1)
            count += anchored.get(event.anchor, 1)
            if repeated > MAX_REPEATED:
                _raise_composer_error(
                    event, f"the aliases stand for more than {MAX_REPEATED:,} values"
                )
        count += isinstance(event, yaml.NodeEvent)


def _raise_composer_error(event: yaml.Event, problem: str) -> NoReturn:
    from yaml.composer import ComposerError

    raise ComposerError(None, None, problem, event.start_mark)  # type: ignore[arg-type]
