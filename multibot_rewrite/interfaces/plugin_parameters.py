"""C++ of simulator plugins -> the parameters that they read of their ``<plugin>``.

``_sdf->Get<double>("wheel_radius", 0.2)`` says a name, a type and a default; ``HasElement``,
``FindElement`` and helpers that take an element say a name. A parameter whose absence ends the
loading is required. What is read of an element that is a parameter itself is below it:
``joint/p_gain``; ``joint/*`` is below it where the code goes through its children or gives it to a
library.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from multibot_rewrite.interfaces.expressions import text_of
from multibot_rewrite.interfaces.syntax import nodes_of

if TYPE_CHECKING:
    from multibot_rewrite.interfaces.syntax import Node

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
# What is inside of these may be left out.
CONDITIONAL = (
    *("if_statement", "for_statement", "while_statement", "for_range_loop"),
    *("try_statement", "lambda_expression", "conditional_expression", "switch_statement"),
)
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
_NEXT, _ALL = "GetNextElement", "/*"
_ELEMENT = re.compile(r"_?\w*[sS]df\w*|\w*[eE]lem\w*|params?")
_CALLED = re.compile(r"(?:template )?(\w+)(?:<(.*)>)?")
_MISSING = re.compile(
    r"\(\s*!\s*[\w.>-]*->\s*(?:HasElement|FindElement|GetElement)\(\"(\w+)\"\)\s*\)"
)
_THERE = re.compile(r"\(\s*[\w.>-]*->\s*HasElement\(\"(\w+)\"\)\s*\)")
_LITERAL = re.compile(r'-?[\d.]+(?:e-?\d+)?[fu]?|true|false|"[^"]*"')
_NAME = re.compile(r"[A-Za-z_][\w-]*")
_CONSTANT = re.compile(
    r"\b(?:std::string|auto|char)\b[\s*const]*\b(\w+)(?:\[\])?\s*(?:=\s*|\{\s*|\(\s*)\"([\w-]+)\""
)
_COMPLAINS = re.compile(r"err\b|ERROR|throw|FATAL|ASSERT|FailedToLoad")


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


def reads_any(text: str) -> bool:
    """Does the plugin go through whatever children it has?"""
    return bool(_GOES_THROUGH.search(text))


def parameters_of(files: Iterable[tuple[str, str]]) -> tuple[Parameter, ...]:
    """The parameters that files read, each given as its path and text; by name."""
    found: dict[str, Parameter] = {}
    texts = tuple(files)
    own = frozenset(it for _, text in texts for it in _functions(text))
    for path, text in texts:
        needed = set(_required(text))
        reads, variables = _reads(text, own)
        words = _words(text, variables)
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
    """The functions that a file defines."""
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


def _reads(text: str, own: frozenset[str]) -> tuple[list[_Read], dict[str, str]]:
    """What is read, in order, and the parameter that each variable holds."""
    found: list[_Read] = []
    scopes: dict[int, dict[str, str]] = {}
    values: set[str] = set()
    everywhere: dict[str, str] = {}
    constants = dict(_CONSTANT.findall(text))
    for call in nodes_of(text, ("call_expression",)):
        variables = scopes.setdefault(_function_of(call), {})
        elements = {key: name for key, name in variables.items() if key not in values}
        found += _given_away(call, elements, own)
        it = _read(call, variables, constants)
        if it is None:
            continue
        found.append(it)
        variable = _assigned(call)
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


def _read(call: Node, variables: dict[str, str], constants: dict[str, str]) -> _Read | None:
    function, arguments = (call.child_by_field_name(it) for it in ("function", "arguments"))
    if function is None or arguments is None:
        return None
    given = [it for it in arguments.named_children if it.type != "comment"]
    literals = [_literal(it, constants) for it in given]
    called = _CALLED.fullmatch(text_of(function.child_by_field_name("field")))
    if called is None or called[1] not in READS:
        return _by_helper(function, given, literals, variables)
    type_ = _type(called[2] or "") if called[1] == "Get" else ANY
    owner = _owner(function.child_by_field_name("argument"), variables, constants)
    if not literals or not literals[0]:
        line = call.start_point[0] + 1
        return _Read(owner, type_, line, "") if owner and called[1] == "Get" else None
    if not _NAME.fullmatch(literals[0]):
        return None
    above = owner.rpartition("/")[0] if called[1] == _NEXT else owner
    line = given[0].start_point[0] + 1
    return _Read(_below(above, literals[0]), type_, line, _default(given[1:]))


def _default(behind: list[Node]) -> str:
    """The default that is behind a name, if it is a literal."""
    default = text_of(behind[0]) if behind else ""
    return default if _LITERAL.fullmatch(default) else ""


def _below(above: str, name: str) -> str:
    return f"{above}/{name}" if above else name


def _by_helper(
    function: Node, given: list[Node], literals: list[str], variables: dict[str, str]
) -> _Read | None:
    """A function that is given an element and a name, or one of gazebo_ros of ROS 1."""
    line = function.end_point[0] + 1
    called = _CALLED.fullmatch(re.split(r"->|\.|::", text_of(function), maxsplit=1)[-1])
    names = [it for it in literals if _NAME.fullmatch(it)]
    if called and called[1] in NAMED:
        return _Read(NAMED[called[1]], "text", line, "")
    if called and called[1] in FILLS and names:
        behind = given[literals.index(names[0]) + 1 :]
        return _Read(names[0], _type(called[2] or FILLS[called[1]]), line, _default(behind))
    owners = [text_of(it) for it in given if it.type == "identifier"]
    takes = next((it for it in owners if _ELEMENT.fullmatch(it)), "")
    above = variables.get(takes, "")
    return _Read(_below(above, names[0]), ANY, line, "") if takes and names else None


def _type(type_: str) -> str:
    bare = re.sub(r"^(?:gz|ignition|ignition::gazebo)::", "", type_.strip())
    return TYPES.get(bare, ANY)


def _literal(node: Node, constants: dict[str, str]) -> str:
    """The text that an argument is; empty where it is none."""
    if node.type == "string_literal":
        return text_of(node)[1:-1]
    return constants.get(text_of(node), "") if node.type == "identifier" else ""


def _owner(node: Node | None, variables: dict[str, str], constants: dict[str, str]) -> str:
    """The parameter whose element is asked: by a variable, or by the call before it."""
    if node is None:
        return ""
    if node.type == "call_expression":
        it = _read(node, variables, constants)
        return it.name if it else ""
    return variables.get(re.split(r"\.|->", text_of(node))[-1], "")


def _assigned(call: Node) -> str:
    """The variable that a call's result is put in."""
    below, above = call, call.parent
    while above is not None and above.type in ("field_expression", "call_expression"):
        below, above = above, above.parent
    if above is None or above.type not in ("init_declarator", "assignment_expression"):
        return ""
    left = above.child_by_field_name("declarator") or above.child_by_field_name("left")
    return re.split(r"\.|->", text_of(left))[-1].lstrip("*&") if left and left != below else ""


def _required(text: str) -> Iterator[str]:
    """Names whose absence ends the function: ``if (!_sdf->HasElement("x")) return;``, or in the
    else."""
    for it in nodes_of(text, ("if_statement",)):
        if is_conditional(it):
            continue
        condition = text_of(it.child_by_field_name("condition"))
        missing, there = _MISSING.fullmatch(condition), _THERE.fullmatch(condition)
        if missing and _ends(it.child_by_field_name("consequence")):
            yield missing[1]
        elif there and _ends(it.child_by_field_name("alternative")):
            yield there[1]


def _ends(branch: Any) -> bool:
    if branch is None:
        return False
    statements = [branch, *branch.named_children]
    statements += [below for it in branch.named_children for below in it.named_children]
    ends = any(it.type in ("return_statement", "throw_statement") for it in statements)
    return ends and _COMPLAINS.search(text_of(branch)) is not None


def is_conditional(node: Node) -> bool:
    """Is it in a part of its function that may be left out?"""
    above = node.parent
    while above is not None and above.type != "function_definition":
        if above.type in CONDITIONAL:
            return True
        above = above.parent
    return False


def _words(text: str, variables: dict[str, str]) -> dict[str, tuple[str, ...]]:
    """The words that the value of a parameter is compared with, where there are two or more."""
    found: dict[str, dict[str, None]] = {}
    for variable, name in variables.items():
        for it in re.finditer(rf'\b{re.escape(variable)} == "(\w+)"', text):
            found.setdefault(name, {})[it[1]] = None
    return {name: tuple(words) for name, words in found.items() if len(words) > 1}
