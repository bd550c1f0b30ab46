# SPDX-License-Identifier: Apache-2.0
"""C++ of simulator plugins -> the parameters that they read of their ``<plugin>``.

``_sdf->Get<double>("wheel_radius", 0.2)`` says a name, a type and a default; ``HasElement``,
``FindElement`` and helpers that take an element say a name. A parameter whose absence ends the
loading is required. What is read of an element that is a parameter itself is below it:
``joint/p_gain``; ``joint/*`` is below it where the code goes through its children or gives it to a
library.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite.producers.sources.expressions import nodes_of, text_of
from tools.interfaces.plugin_demands import required_in, words_in

if TYPE_CHECKING:
    from multibot_rewrite.producers.sources.expressions import Node

READS = (
    *("Get", "HasElement", "GetElement", "FindElement", "GetElementImpl", "GetNextElement"),
    *("HasAttribute", "GetAttribute"),
)
# Helpers of gazebo_ros in ROS 1: the name is behind what they fill in.
FILLS = {"getParameter": "", "getParameterBoolean": "bool", "getJoint": "std::string"}
# The same, which know the name themselves.
NAMED = {"GetRobotNamespace": "robotNamespace"}
TYPES = {
    "double": "number",
    "float": "number",
    "math::Angle": "number",
    "int": "integer",
    "int32_t": "integer",
    "unsigned int": "integer",
    "uint32_t": "integer",
    "uint64_t": "integer",
    "size_t": "integer",
    "bool": "boolean",
    "std::string": "text",
    "string": "text",
    "math::Vector3d": "vector",
    "math::Pose3d": "pose",
    "math::Color": "color",
    "Vector3d": "vector",
    "Pose3d": "pose",
}
ANY = "any"
# A plugin that goes through its children reads what they are called, whatever that is.
# So does the base class of some, which is in Gazebo Classic itself.
_GOES_THROUGH = re.compile(
    r"\b_sdf\w*->GetFirstElement\(\)|GetElementTypeNames\("
    r"|\b(?:Harness|Elevator|WheelSlip)Plugin::Load\("
)
# Each of these makes something of an element, whatever is in it.
_CHILDREN = ("GetFirstElement", "GetAnyElement")
# What a variable holds then is a value, no element.
_GETS = re.compile(r"(?:->|\.)(?:template )?Get<")
_NEXT, ALL, _ALL = "GetNextElement", "*", "/*"
_ELEMENT = re.compile(r"_?\w*[sS]df\w*|\w*[eE]lem\w*|params?")
_CALLED = re.compile(r"(?:template )?(\w+)(?:<(.*)>)?")
_LITERAL = re.compile(r'-?[\d.]+(?:e-?\d+)?[fu]?|true|false|"[^"]*"')
_NAME = re.compile(r"[A-Za-z_][\w-]*")
_CONSTANT = re.compile(
    r"\b(?:std::string|auto|char)\b[\s*const]*\b(\w+)(?:\[\])?\s*(?:=\s*|\{\s*|\(\s*)\"([\w-]+)\""
)
_DECLARATION = re.compile(
    r"\b(double|float|(?:unsigned )?int|bool|std::string|(?:ignition::)?math::\w+)\s+(\w+)\s*[;=]"
)
_INTO = re.compile(r"->GetValue\(\)->Get(?:\((\w+)\)|AsString\(\))$")


class Parameter(NamedTuple):
    """A parameter: ``type`` is a word of ``TYPES`` or ``any``; ``words`` are those that its value is
    compared with; ``path`` and ``line`` say where it is read."""

    name: str
    type: str
    path: str
    line: int
    default: str = ""
    required: bool = False
    words: tuple[str, ...] = ()


class _Read(NamedTuple):
    name: str
    type: str
    line: int
    default: str


class _Scope(NamedTuple):
    """Where a call is: the parameter that each variable holds, constants and types by their names."""

    variables: dict[str, str]
    constants: Mapping[str, str]
    types: Mapping[str, str]


def reads_any(text: str) -> bool:
    """Return whether the plugin goes through whatever children it has."""
    return bool(_GOES_THROUGH.search(text))


def parameters_of(
    files: Iterable[tuple[str, str]], headers: Iterable[str] = ()
) -> tuple[Parameter, ...]:
    """Return the parameters that files read, each given as its path and text; by name.

    One that is called ``*`` says that there are more, whose names are computed.
    """
    found: dict[str, Parameter] = {}
    texts = tuple(files)
    own = frozenset(it for _, text in texts for it in _functions(text))
    types = declared_types("\n".join((*headers, *(text for _, text in texts))))
    for path, text in texts:
        needed = set(required_in(text))
        reads, variables = _reads(text, own, types)
        words = words_in(text, variables)
        for it in reads:
            new = Parameter(
                *(it.name, it.type, path, it.line, it.default, it.name in needed),
                words.get(it.name, ()),
            )
            found[it.name] = _merged(found.get(it.name), new)
    below = {name.rpartition("/")[0] for name in found if not name.endswith(_ALL)}
    return tuple(
        found[name]
        for name in sorted(found)
        if not name.endswith(_ALL) or name.removesuffix(_ALL) in below
    )


def _functions(text: str) -> Iterator[str]:
    """Yield the functions that a file defines."""
    for it in nodes_of(text, ("function_definition",)):
        declared = it.child_by_field_name("declarator")
        if declared is not None:
            yield re.split(r"::|[\s*&]+", text_of(declared).partition("(")[0])[-1]


def _merged(old: Parameter | None, new: Parameter) -> Parameter:
    """Two places where one parameter is read: the typed one says where, two types say none."""
    if old is None:
        return new
    first, other = (new, old) if old.type == ANY != new.type else (old, new)
    type_ = first.type if other.type in (ANY, first.type) else ANY
    return first._replace(
        type=type_,
        default=first.default or other.default,
        required=old.required or new.required,
        words=first.words or other.words,
    )


def declared_types(text: str) -> dict[str, str]:
    """Return the types of variables, where all that have the name have the same."""
    found: dict[str, set[str]] = {}
    for type_, name in _DECLARATION.findall(text):
        found.setdefault(name, set()).add(type_of(type_))
    return {name: next(iter(types)) for name, types in found.items() if len(types) == 1}


def _reads(
    text: str, own: frozenset[str], types: Mapping[str, str]
) -> tuple[list[_Read], dict[str, str]]:
    """Return what is read, in order, and the parameter that each variable holds."""
    found: list[_Read] = []
    scopes: dict[int, dict[str, str]] = {}
    values: set[str] = set()
    everywhere: dict[str, str] = {}
    constants = dict(_CONSTANT.findall(text))
    for call in nodes_of(text, ("call_expression",)):
        variables = scopes.setdefault(_function_of(call), {})
        elements = {key: name for key, name in variables.items() if key not in values}
        found += _given_away(call, elements, own)
        it = _read(call, _Scope(variables, constants, types))
        if it is None:
            continue
        found.append(it)
        variable = "" if it.name.endswith(ALL) else _assigned(call)
        if variable:
            variables[variable] = everywhere[variable] = it.name
            (values.add if _GETS.search(text_of(call)) else values.discard)(variable)
    return found, everywhere


def _function_of(node: Node) -> int:
    """Where the function that a node is in begins: its variables are its own."""
    above: Node | None = node
    while above is not None and above.type != "function_definition":
        above = above.parent
    return above.start_byte if above else -1


def _given_away(call: Node, elements: dict[str, str], own: frozenset[str]) -> Iterator[_Read]:
    """Parameters whose children are read by nobody knows what: ``noise.Load(noiseElement)``."""
    function, arguments = (call.child_by_field_name(it) for it in ("function", "arguments"))
    if function is None or arguments is None:
        return
    called, line = re.split(r"->|\.|::", text_of(function))[-1], call.start_point[0] + 1
    if called in own:  # what it reads is known
        return
    owners = arguments.named_children
    if called in _CHILDREN:
        owners = [it for it in (function.child_by_field_name("argument"),) if it is not None]
    for it in owners:
        name = elements.get(text_of(it), "")
        if name:
            yield _Read(name + _ALL, ANY, line, "")


def _read(call: Node, scope: _Scope) -> _Read | None:
    function, arguments = (call.child_by_field_name(it) for it in ("function", "arguments"))
    if function is None or arguments is None:
        return None
    given = [it for it in arguments.named_children if it.type != "comment"]
    literals = [_literal(it, scope.constants) for it in given]
    called = _CALLED.fullmatch(text_of(function.child_by_field_name("field")))
    if called is None or called[1] not in READS:
        return _by_helper(function, given, literals, scope.variables)
    type_ = type_of(called[2] or "") if called[1] == "Get" else ANY
    owner = _owner(function.child_by_field_name("argument"), scope)
    line = call.start_point[0] + 1
    if given and not literals[0] and _is_computed(given[0]) and _is_element(function):
        return _Read(_below(owner, ALL), ANY, line, "")
    if not literals or not literals[0]:
        return _Read(owner, type_, line, "") if owner and called[1] == "Get" else None
    if not _NAME.fullmatch(literals[0]):
        return None
    above = owner.rpartition("/")[0] if called[1] == _NEXT else owner
    line = given[0].start_point[0] + 1
    type_ = _filled(call, scope.types) if type_ == ANY else type_
    return _Read(_below(above, literals[0]), type_, line, _default(given[1:]))


def _is_computed(name: Node) -> bool:
    """Return a variable that the function makes itself: what it is given is seen where it is called."""
    above: Node | None = name
    while above is not None and above.type not in ("function_definition", "lambda_expression"):
        above = above.parent
    declared = above.child_by_field_name("declarator") if above is not None else None
    given = re.findall(r"\w+", text_of(declared).partition("(")[2])
    return name.type == "identifier" and text_of(name) not in given


def _is_element(function: Node) -> bool:
    """Return whether an element is asked, by the name of its variable."""
    asked = re.split(r"\.|->", text_of(function.child_by_field_name("argument")))[-1]
    return _ELEMENT.fullmatch(asked) is not None


def _filled(call: Node, types: Mapping[str, str]) -> str:
    """Return the type of what ``GetElement("a")->GetValue()->Get(variable)`` fills in."""
    behind = ""
    above = call.parent
    while above is not None and above.type in ("field_expression", "call_expression"):
        behind, above = text_of(above), above.parent
    into = _INTO.search(behind)
    if into is None:
        return ANY
    return types.get(into[1], ANY) if into[1] else "text"


def _default(behind: list[Node]) -> str:
    """Return the default that is behind a name, if it is a literal."""
    default = text_of(behind[0]) if behind else ""
    return default if _LITERAL.fullmatch(default) else ""


def _below(above: str, name: str) -> str:
    return f"{above}/{name}" if above else name


def _by_helper(
    function: Node, given: list[Node], literals: list[str], variables: dict[str, str]
) -> _Read | None:
    """Return a function that is given an element and a name, or one of gazebo_ros of ROS 1."""
    line = function.end_point[0] + 1
    called = _CALLED.fullmatch(re.split(r"->|\.|::", text_of(function), maxsplit=1)[-1])
    names = [it for it in literals if _NAME.fullmatch(it)]
    if called and called[1] in NAMED:
        return _Read(NAMED[called[1]], "text", line, "")
    if called and called[1] in FILLS and names:
        behind = given[literals.index(names[0]) + 1 :]
        return _Read(names[0], type_of(called[2] or FILLS[called[1]]), line, _default(behind))
    owners = [text_of(it) for it in given if it.type == "identifier"]
    takes = next((it for it in owners if _ELEMENT.fullmatch(it)), "")
    above = variables.get(takes, "")
    if takes and not names and any(it.type == "subscript_expression" for it in given):
        return _Read(_below(above, ALL), ANY, line, "")
    type_ = type_of(called[2] or "") if called else ANY
    return _Read(_below(above, names[0]), type_, line, "") if takes and names else None


def type_of(type_: str) -> str:
    """Return the word of a type of C++, ``any`` for all others."""
    bare = re.sub(r"^(?:gz|ignition|ignition::gazebo)::", "", type_.strip())
    return TYPES.get(bare, ANY)


def _literal(node: Node, constants: Mapping[str, str]) -> str:
    """Return the text that an argument is; empty where it is none."""
    if node.type == "string_literal":
        return text_of(node)[1:-1]
    return constants.get(text_of(node), "") if node.type == "identifier" else ""


def _owner(node: Node | None, scope: _Scope) -> str:
    """Return the parameter whose element is asked: by a variable, or by the call before it."""
    if node is None:
        return ""
    if node.type == "call_expression":
        it = _read(node, scope)
        return it.name if it else ""
    return scope.variables.get(re.split(r"\.|->", text_of(node))[-1], "")


def _assigned(call: Node) -> str:
    """Return the variable that a call's result is put in."""
    below, above = call, call.parent
    while above is not None and above.type in ("field_expression", "call_expression"):
        below, above = above, above.parent
    if above is None or above.type not in ("init_declarator", "assignment_expression"):
        return ""
    left = above.child_by_field_name("declarator") or above.child_by_field_name("left")
    return re.split(r"\.|->", text_of(left))[-1].lstrip("*&") if left and left != below else ""
