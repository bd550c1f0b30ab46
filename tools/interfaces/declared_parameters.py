# SPDX-License-Identifier: Apache-2.0
"""Parameters that nodes declare or ask for in C++ and Python.

A name that is put together has ``<id>`` for what is not in the text: ``name + ".scan_topic"`` is
``<id>.scan_topic``. Sources: rclcpp/node.hpp, nav2_ros_common/node_utils.hpp,
nav2_costmap_2d/layer.hpp (declareParameter puts the layer's name before), controller_interface
(auto_declare), rclpy/node.py.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from typing import NamedTuple

from multibot_rewrite.knowledge.declared import DECLARED, READ
from multibot_rewrite.producers.sources.expressions import is_node
from multibot_rewrite.producers.sources.records import Call, Place, Source, Value
from multibot_rewrite.rules.files.parameter_files import NO_DEFAULT, text_of
from tools.interfaces.parameter_facts import ParameterFact

ID = "<id>"
_UNKNOWN = re.compile(r"<([^<>]*)>")
# What declares or asks for a parameter; those below put the plugin's name before the parameter's.
_DECLARES = re.compile(
    r"(auto_)?declare\w*|add_parameter|searchAndGetParam|get_parameter_or|getParam|declareParam"
)
_READS = re.compile(r"get_parameter|has_parameter|getParam\w*|lookupParam")
_PREFIXING = ("declareParameter", "getParam", "declareParam")
_NAME = re.compile(rf"(?:{ID}|\w)(?:[\w.]|{ID})*")
_NUMBER = re.compile(r"-?\d+(\.\d*)?f?|-?\.\d+|-?\d+\.?\d*e-?\d+")
_BRACES = re.compile(r'<(?:std::)?string\{"([^"]*)"\}>')
_TYPE_WORD = re.compile(r"(?:PARAMETER_)?(BOOL|INTEGER|DOUBLE|STRING)(_ARRAY)?")
_TYPES = {
    "bool": "bool",
    "int": "int",
    "double": "double",
    "float": "double",
    "string": "string",
    "vector<string>": "string_array",
    "vector<double>": "double_array",
}
# ``get_parameter("rate").as_double()`` tells the type of a default that is a variable.
_AS = re.compile(r"as_(bool|int|double|string)(_array)?")
# joint_state_publisher has a method of its own.
_ONE_OF_PYTHON = ("declare_parameter", "_declare_ros_parameter", "declare_ros_parameter")
_OF_PYTHON = {bool: "bool", int: "int", float: "double", str: "string", list: "array"}


class _Default(NamedTuple):
    type: str
    text: str


_NONE = _Default("", NO_DEFAULT)


def cpp_parameters(
    source: Source, package: str, shared: Mapping[str, str]
) -> Iterator[ParameterFact]:
    """Yield the parameters of a C++ file; ``shared`` are the package's constants."""
    known = {**shared, **constants(source.values)}
    read_as, held = _read_as(source.calls), _literals(source.values)
    for call in source.calls:
        how = DECLARED if _DECLARES.fullmatch(call.name) else READ
        if how == READ and not _READS.fullmatch(call.name):
            continue
        name, default = _name_and_default(call, known)
        if name:
            owner = call.owner or call.place.path.rpartition("/")[2].partition(".")[0]
            type_, text = _of_type(_template_type(call.types), default)
            type_ = type_ or read_as.get(name, "") or held.get((call.function, call.given[-1]), "")
            yield ParameterFact(package, owner, name, type_, text, "", "", how, call.place)


def _read_as(calls: Iterable[Call]) -> dict[str, str]:
    """Return the types that parameters are read as, by their names."""
    return {
        call.on[2:-1]: call.name.removeprefix("as_")
        for call in calls
        if call.on.startswith("<@") and _AS.fullmatch(call.name)
    }


def _literals(values: Iterable[Value]) -> dict[tuple[str, str], str]:
    """Return the types of variables of a function that are set to numbers with a point, or to true
    or false; a number without one may be of any type."""
    found: dict[tuple[str, str], set[str]] = {}
    for it in values:
        type_ = _default(it.text, {}).type if it.text.startswith("<") else ""
        if type_ and it.function:
            found.setdefault((it.function, f"<{it.variable}>"), set()).add(type_)
    return {
        at: types.pop() for at, types in found.items() if types <= {"double"} or types == {"bool"}
    }


def shared_constants(values: Iterable[Value]) -> dict[str, str]:
    """Return the constants of a package by their names in capitals, the same in all its files."""
    return {name: text for name, text in constants(values).items() if name.isupper()}


def constants(values: Iterable[Value]) -> dict[str, str]:
    """Variables that are set to one text only, whatever else they are set to at run time.

    The text may have parts in <> that are not known.
    """
    found: dict[str, set[str]] = {}
    for value in values:
        if not value.variable.startswith("@") and re.search(r"\w", _UNKNOWN.sub("", value.text)):
            found.setdefault(value.variable, set()).add(value.text)
    return {name: next(iter(texts)) for name, texts in found.items() if len(texts) == 1}


def _name_and_default(call: Call, known: Mapping[str, str]) -> tuple[str, _Default]:
    given = [it for it in call.given if not is_node(it)]
    at = next((at for at, it in enumerate(given) if _path(it, known)), None)
    if at is None:
        return "", _NONE
    name = _path(given[at], known)
    if call.name in _PREFIXING:
        name = f"{ID}.{name}"
    rest = given[at + 1 :]
    if call.name == "get_parameter_or":
        rest = rest[-1:]
    elif not _DECLARES.fullmatch(call.name):
        rest = []
    return name, _default(rest[0], known) if rest else _NONE


def _path(text: str, known: Mapping[str, str]) -> str:
    """Return the dotted path of a name's text; empty if it holds no word of its own."""
    text = _UNKNOWN.sub(lambda found: _UNKNOWN.sub(ID, known.get(found[1], ID)), text)
    text = re.sub(rf"({ID})+", ID, text)
    text = re.sub(rf"{ID}(?=[a-z])", f"{ID}.", text)
    plain = text.replace(ID, "").strip(".")
    return text if plain and re.search("[a-zA-Z]", plain) and _NAME.fullmatch(text) else ""


def _default(text: str, known: Mapping[str, str]) -> _Default:
    """Return the type and text of a default's expression, which is in <> unless it is a string."""
    if "<" not in text:
        return _Default("string", text_of(text))
    if braces := _BRACES.fullmatch(text):
        return _Default("string", text_of(braces[1]))
    inner = text.strip("<>")
    if word := _TYPE_WORD.fullmatch(inner):
        return _Default(word[0].removeprefix("PARAMETER_").lower().replace("integer", "int"), "")
    if inner in ("true", "false"):
        return _Default("bool", inner)
    if _NUMBER.fullmatch(inner):
        return _Default("double" if re.search("[.ef]", inner) else "int", inner)
    value = known.get(inner, "<>")
    return _NONE if "<" in value else _Default("string", text_of(value))


def _of_type(written: str, default: _Default) -> _Default:
    """Return the type that is written, with the default if it is of that type: {} is none of a text."""
    if not written or written == default.type:
        return default
    return default._replace(type=written) if default.type != "string" else _Default(written, "")


def _template_type(types: tuple[str, ...]) -> str:
    return _TYPES.get(types[0].replace("std::", "").replace(" ", ""), "") if types else ""


def python_parameters(text: str, place: Place, package: str) -> Iterator[ParameterFact]:
    """Yield the parameters of a Python file; nothing if it is not Python 3."""
    try:
        module = ast.parse(text)
    except (SyntaxError, ValueError):
        return
    owner = next((it.name for it in module.body if isinstance(it, ast.ClassDef)), "")
    owner = owner or place.path.rpartition("/")[2].removesuffix(".py")
    calls = (it for it in ast.walk(module) if isinstance(it, ast.Call))
    methods = ((it.func.attr, it) for it in calls if isinstance(it.func, ast.Attribute))
    found = chain.from_iterable(_declared(*it) for it in methods)
    for name, value, line in (*found, *_of_tables(module)):
        type_, default = _of_python(value)
        at = place._replace(line=line)
        yield ParameterFact(package, owner, name, type_, default, "", "", DECLARED, at)


def _of_tables(module: ast.Module) -> Iterator[tuple[str, ast.expr, int]]:
    """Yield what ``for name, default in TABLE: self.declare_parameter(name, ...)`` declares."""
    tables = {
        it.targets[0].id: it.value
        for it in module.body
        if isinstance(it, ast.Assign) and isinstance(it.targets[0], ast.Name)
    }
    for loop in ast.walk(module):
        if not isinstance(loop, ast.For) or not isinstance(loop.target, ast.Tuple):
            continue
        words = [ast.unparse(it) for it in loop.target.elts]
        if f"declare_parameter({words[0]}, " not in ast.unparse(loop):
            continue
        at = next((at for at, word in enumerate(words) if "default" in word), 1)
        named = [it.id for it in ast.walk(loop.iter) if isinstance(it, ast.Name)]
        for row in (row for it in named if it in tables for row in ast.walk(tables[it])):
            if isinstance(row, ast.Tuple) and len(row.elts) == len(words):
                yield _python_name(row.elts[0]), row.elts[at], row.lineno


def _declared(verb: str, call: ast.Call) -> Iterator[tuple[str, ast.expr | None, int]]:
    given = [*call.args, *(it.value for it in call.keywords if it.arg in ("name", "value"))]
    if verb in _ONE_OF_PYTHON and given and (name := _python_name(given[0])):
        yield name, given[1] if len(given) > 1 else None, call.lineno
    if verb != "declare_parameters":
        return
    for node in ast.walk(call):
        if isinstance(node, ast.Tuple) and node.elts and (name := _python_name(node.elts[0])):
            yield name, node.elts[1] if len(node.elts) > 1 else None, node.lineno


def _python_name(node: ast.expr) -> str:
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        parts = (_python_name(it) or ID for it in (node.left, node.right))
        return _path("".join(parts), {})
    if isinstance(node, ast.JoinedStr):
        parts = (_python_name(it) or ID for it in node.values)
        return _path("".join(parts), {})
    return ""


def _of_python(node: ast.expr | None) -> _Default:
    try:
        value = ast.literal_eval(node) if node is not None else None
    except ValueError:
        return _NONE
    return _Default(_OF_PYTHON.get(type(value), ""), text_of(value))
