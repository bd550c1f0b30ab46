# SPDX-License-Identifier: Apache-2.0
"""The parameters that nodes declare, and the checks of a value by their declarations.

They are known by the sources of their packages where those are there, which
generate_parameter_library reads as YAML files, else by installed NoDL documents and by what is
known. The checks are those of generate_parameter_library and of ``demanded.schema``.

Source: https://github.com/PickNikRobotics/generate_parameter_library (README, "YAML Syntax").

Source: PickNikRobotics/rsl and generate_parameter_library, parameter_validators (README, "Built-In
Validators"); control_filters of ros2_controllers take nan as well."""

import math
import os
from collections.abc import Callable, Iterator, Sequence
from operator import eq, ge, gt, le, lt
from typing import Any, NamedTuple, TypeGuard

import yaml

from multibot_rewrite.base.bounded import compose_yaml, load_yaml
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.outside import outside
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.description.sources.packages import entries, package_folder
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.knowledge.declared import (
    DEMANDED,
    YAML,
    Declared,
    declared_by,
    says_something,
)
from multibot_rewrite.knowledge.nodl.lookup import Identity, file_of, find_interfaces, load
from multibot_rewrite.knowledge.records import NodeParameters
from multibot_rewrite.related_files.yaml_text import pairs

# The types of parameters; an array may have a length behind it: double_array_fixed_6.
_TYPES = ("bool", "double", "int", "string", "none")
_MAP = "__map_"
NO_DEFAULT = ""
EMPTY = '""'


class FileParameter(NamedTuple):
    """A parameter of such a file; ``owner`` is the file's top key."""

    owner: str
    path: str
    type: str
    default: str
    bounds: str
    read_only: str
    line: int


def file_parameters(text: str) -> tuple[FileParameter, ...]:
    """Return the parameters of a file; empty if it is another kind of YAML."""
    try:
        root = compose_yaml(text, "")
    except InputError:
        return ()
    found = (it for owner, below in pairs(root) for it in _parameters(owner.value, below, ()))
    return tuple(it for it in found if it.path)


def _parameters(owner: str, node: yaml.Node, path: tuple[str, ...]) -> Iterator[FileParameter]:
    """Yield the parameters in a part of such a file, at a path below its top key."""
    keys = {key.value: value for key, value in pairs(node)}
    type_ = keys.get("type")
    if isinstance(type_, yaml.ScalarNode) and type_.value.partition("_")[0] in _TYPES:
        made = yaml.SafeLoader("").construct_object
        given = {key: made(value, deep=True) for key, value in keys.items()}
        yield FileParameter(
            owner,
            ".".join(path),
            str(given["type"]),
            text_of(given.get("default_value")),
            _checks_as_text(given.get("validation")),
            "read_only" if given.get("read_only") is True else "",
            node.start_mark.line + 1,
        )
        return
    for key, below in pairs(node):
        word = key.value
        # ``__map_joints`` stands for each of the names in the parameter ``joints``.
        step = f"<{word.removeprefix(_MAP)}>" if word.startswith(_MAP) else word
        yield from _parameters(owner, below, (*path, step))


def _checks_as_text(validation: object) -> str:
    """Return ``gt_eq(0.0) size_lt([5])``: each check with its arguments."""
    if not isinstance(validation, dict):
        return ""
    words = (f"{str(name).removesuffix('<>')}({text_of(it)})" for name, it in validation.items())
    return " ".join(sorted(words))


def text_of(value: object) -> str:
    """Return a default as it is written in tables."""
    if value is None:
        return NO_DEFAULT
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list | tuple):
        return f"[{', '.join(text_of(it) for it in value)}]"
    return " ".join(str(value).split()) or EMPTY


NODL = "nodl"
# Folders of a package that have files of generate_parameter_library, and what those are called.
_FOLDERS = ("src", "param", "params", "parameters", "config", "include", "")
_CALLED = lazy_compile(r".*param(?!.*?param)\w*\.ya?ml")


def facts_of_node(
    node: NodeParameters | None, type_: str, file: str, roots: tuple[str, ...]
) -> tuple[Declared, ...]:
    """Return what a node's packages declare, by its sources if present; ``type_``: a controller's."""
    named = type_.partition("/")[0] if "/" in type_ else ""
    package = node.package if node else named
    own = _in_sources(package, file, roots) if package else ()
    if own or node is None:
        return own
    # What one class of a package, or one of its nodes, demands beside the others.
    one = (type_,) if named else (f"{node.package}/{node.name}",)
    others = {it.partition("/")[0] for it in node.types} - {node.package, named}
    shared = (it for it in node.declared_in if not named or it not in others)
    owners = (node.package, *shared, *one)
    known = (it for owner in owners for it in declared_by(owner))
    # What the installed NoDL document of the node declares.
    given = nodl_parameters(node.package, node.name)
    source = f"NoDL of {node.package}/{node.name}"
    said = (Declared(*it, "", "", NODL, source) for it in given if says_something(it[0]))
    return (*said, *known)


@outside
def nodl_parameters(package: str, node: str) -> tuple[tuple[str, str], ...]:
    """Return names and types of the parameters in a node's installed NoDL document; none without."""
    try:
        installed = find_interfaces(())
        file = file_of(installed, Identity(package, node))
        found = load(file, installed).parameters if file else ()
    except (UsageError, OSError):
        return ()
    return tuple((it.name, it.type) for it in found)


def _in_sources(package: str, file: str, roots: tuple[str, ...]) -> tuple[Declared, ...]:
    """Return the parameters in generate_parameter_library files of a package's sources, if found."""
    folder = package_folder(package, file, roots)
    found: list[Declared] = []
    places = [os.path.join(folder, it) for it in _FOLDERS] if folder else []
    paths = (os.path.join(it, name) for it in places for name in sorted(entries(it)))
    for path in (it for it in paths if _CALLED.fullmatch(os.path.basename(it))):
        try:
            text = read_file(path).decode()
        except (InputError, UnicodeDecodeError):
            continue
        known = "type:" in text and "ros__parameters" not in text
        found += (
            Declared(it.path, it.type, it.bounds, "", YAML, f"{path}:{it.line}")
            for it in (file_parameters(text) if known else ())
            if says_something(it.path)
        )
    return tuple(found)


def of_release(facts: Sequence[Declared], release: str) -> list[Declared]:
    """Return the declared parameters that the release has."""
    return [it for it in facts if has_release(it.releases, release)]


def of_parameter(facts: Sequence[Declared], release: str) -> list[Declared]:
    """Return the facts about one parameter in a release; demands count only where it is declared."""
    found = of_release(facts, release)
    elsewhere = any(it.how != DEMANDED for it in facts)
    return [] if elsewhere and all(it.how == DEMANDED for it in found) else found


_Number = Callable[[float, float], bool]
# Check -> whether a number holds it, and its words.
_NUMBERS: dict[str, tuple[_Number, str]] = {
    "gt": (gt, "above"),
    "lt": (lt, "below"),
    **dict.fromkeys(("gt_eq", "lower_bounds"), (ge, "at least")),
    **dict.fromkeys(("lt_eq", "upper_bounds"), (le, "at most")),
}
_SIZES: dict[str, tuple[_Number, str]] = {
    "fixed_size": (eq, "with a size of"),
    "size_gt": (gt, "with a size above"),
    "size_lt": (lt, "with a size below"),
}
_OR_NAN = "_or_nan"


def beyond(check: str, arguments: str, value: Any) -> str:
    """Return what a value has to be and is not; empty if it is, or if nobody can read the check."""
    name = check.rpartition("::")[2]
    try:
        given = load_yaml(arguments, "") if arguments else []
    except InputError:
        return ""
    given = given if isinstance(given, list) else [given]
    if name.endswith(_OR_NAN):
        name = name.removesuffix(_OR_NAN)
        if isinstance(value, float) and math.isnan(value):
            return ""
    first: Any = given[0] if given else None
    if name in _NUMBERS and is_number(value) and is_number(first):
        holds, words = _NUMBERS[name]
        return "" if holds(value, first) else f"{words} {first}"
    if name in _SIZES and isinstance(value, str | list) and is_number(first):
        holds, words = _SIZES[name]
        return "" if holds(len(value), first) else f"{words} {first}"
    return _SHAPES[name](first, value) if name in _SHAPES else _beyond_several(name, given, value)


def _beyond_several(name: str, given: list[Any], value: Any) -> str:
    """Return what a value has to be by a check with several arguments and is not; empty if it is."""
    first: Any = given[0] if given else None
    if name in ("lower_bounds", "upper_bounds") and isinstance(value, list) and is_number(first):
        holds, words = _NUMBERS[name]
        every = all(holds(it, first) for it in value if is_number(it))
        return "" if every else f"{words} {first} in each place"
    if name == "bounds" and is_number(value) and len(given) == 2:
        return "" if given[0] <= value <= given[1] else f"from {given[0]} to {given[1]}"
    if name == "not_empty" and value in ("", []):
        return "not empty"
    if name == "not_empty" and isinstance(value, list) and "" in value:
        return "without an empty name"  # it is taken, and no interface has that name
    return _beyond_choices(name, first, value)


def _beyond_choices(name: str, choices: Any, value: Any) -> str:
    """Return what a value has to be by a check with a list of texts and is not; empty if it is."""
    if not isinstance(choices, list) or not all(isinstance(it, str) for it in choices):
        return ""
    words = ", ".join(choices)
    if name == "one_of" and isinstance(value, str) and value not in choices:
        return f"one of {words}"
    if name == "subset_of" and isinstance(value, list) and not set(value) <= set(choices):
        return f"of {words}"
    return ""


def _limits(_: Any, value: Any) -> str:
    """Return how many values a list has to have: of three axes, or six; empty if it has them."""
    known = not isinstance(value, list) or len(value) in (3, 6)
    return "" if known else "with three values (x, y, theta), or six from Lyrical on"


def _square(side: Any, value: Any) -> str:
    """Return how many values a square matrix has to have; empty if it has them."""
    known = not isinstance(value, list) or len(value) in (side, side * side)
    return "" if known else f"with {side * side} values, or {side} on its diagonal"


def _polygon(_: Any, value: Any) -> str:
    """Return what a footprint has to be and is not, as nav2_util parseVVF reads it; empty if right."""
    if not isinstance(value, str) or value in ("", "[]"):
        return ""
    points = polygon_of(value)
    if points is None:
        return "a list of points as text, [[x, y], ...]"
    return "" if len(points) >= 3 else "of three points or more"


def polygon_of(text: str) -> list[tuple[float, float]] | None:
    """Return the points of a footprint; None for a text that is none."""
    inner = text.strip()
    if not (inner.startswith("[") and inner.endswith("]") and inner.count("[") == inner.count("]")):
        return None
    try:
        read = load_yaml(inner, "")
    except InputError:
        return None
    points = read if isinstance(read, list) else []
    pairs = all(isinstance(it, list) and len(it) == 2 for it in points)
    if not pairs or any(isinstance(it, bool) for point in points for it in point):
        return None
    try:
        return [(float(x), float(y)) for x, y in points]
    except (TypeError, ValueError):
        return None


def _unique(_: Any, value: Any) -> str:
    """Return that no value may be in a list twice; empty if none is."""
    twice = isinstance(value, list) and len(set(value)) < len(value)
    return "without one twice" if twice else ""


def _some(_: Any, value: Any) -> str:
    """Return that one value of a list has to be true; empty if one is."""
    none = isinstance(value, list) and True not in value
    return "true in one place or more" if none else ""


def _stem(endings: Any, value: Any) -> str:
    """Return which endings a text must not have; empty if it has none of them."""
    ended = isinstance(value, str) and value.endswith(tuple(endings))
    return f"without {' or '.join(endings)}, which its reader adds" if ended else ""


_SHAPES: dict[str, Callable[[Any, Any], str]] = {
    it.__name__[1:]: it for it in (_limits, _square, _polygon, _unique, _some, _stem)
}


def is_number(value: Any) -> TypeGuard[float]:
    """Return whether a value is a number, and no truth value."""
    return isinstance(value, int | float) and not isinstance(value, bool)
