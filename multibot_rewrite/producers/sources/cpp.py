# SPDX-License-Identifier: Apache-2.0
"""C++ -> what its classes call.

What is looked for is data: ``HANDLERS`` has a function for each kind of syntax.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from multibot_rewrite.producers.sources.expressions import (
    MAKERS,
    MESSAGE,
    NAMES_PARAMETER,
    arguments_of,
    callee,
    dotted,
    evaluated,
    is_node,
    last,
    nodes_of,
    template_arguments,
    text_of,
)
from multibot_rewrite.producers.sources.records import (
    ANY,
    OTHERWISE,
    Alias,
    Call,
    Class,
    Constructor,
    Place,
    Plugin,
    Source,
    Value,
    braced,
    negated,
)

if TYPE_CHECKING:
    from multibot_rewrite.producers.sources.expressions import Node

LONGEST_CONDITION = 60
_EXPORT = re.compile(r"PLUGINLIB_EXPORT_CLASS\(\s*([\w:<>]+)\s*,\s*([\w:<>]+)\s*(?:,\s*)?\)")
COMPONENT = re.compile(r"^[ \t]*RCLCPP_COMPONENTS_REGISTER_NODE\(\s*([\w:]+)\s*\)", re.MULTILINE)
_INCLUDE = re.compile(r"^[ \t]*#[ \t]*include[ \t]*[<\"]([^>\"\n]+)[>\"]", re.MULTILINE)
# Below these a thing happens only sometimes, or later.
_SOMETIMES = {
    *("for_statement", "for_range_loop", "while_statement", "do_statement", "case_statement"),
    *("catch_clause", "lambda_expression", "conditional_expression", "preproc_if", "preproc_ifdef"),
    *("preproc_else", "preproc_elif"),
}
_LEAVES = {"return_statement", "break_statement", "continue_statement", "goto_statement"}
_MACRO = re.compile(r"\b[A-Z][A-Z0-9_]*_(?:PUBLIC|EXPORT|LOCAL)\b")


def read_cpp(text: str, place: Place) -> Source:
    """Return what a C++ file declares and calls."""
    clean = _MACRO.sub(lambda found: " " * len(found[0]), text)
    found: dict[type, list[Any]] = {kind: [] for kind in _COLUMNS}
    for node in nodes_of(clean, tuple(HANDLERS)):
        for item in HANDLERS[node.type](node, place):
            found[type(item)].append(item)
    found[Plugin] = [Plugin(last(one), last(base)) for one, base in _EXPORT.findall(text)]
    # A registered component is made as a main would.
    components = COMPONENT.findall(text)
    found[Call] += [Call("", "main", last(it), (), (), "", "", place) for it in components]
    read = Source(*(tuple(found[kind]) for kind in _COLUMNS))
    return read._replace(imports=tuple(dict.fromkeys(_INCLUDE.findall(text))))


_COLUMNS = (Class, Call, Value, Alias, Constructor, Plugin)


def _up(node: Node, *types: str) -> Node | None:
    above = node.parent
    while above is not None and above.type not in types:
        above = above.parent
    return above


def _declarator(node: Node) -> Node | None:
    """Return the function's declarator, below pointers and references."""
    found = node.child_by_field_name("declarator")
    while found is not None and found.type != "function_declarator":
        found = found.child_by_field_name("declarator") or next(iter(found.named_children), None)
    return found


def _around(node: Node) -> tuple[str, str]:
    """Return the class and function that something is in."""
    function = node if node.type == "function_definition" else _up(node, "function_definition")
    name = ""
    if function is not None and (declarator := _declarator(function)) is not None:
        full = text_of(declarator.child_by_field_name("declarator"))
        name = last(full) if "operator" not in full else ""
        if "::" in re.sub(r"<[^<>]*>", "", full):
            return last(re.sub(r"<[^<>]*>", "", full).rpartition("::")[0]), name
    owner = _up(function or node, "class_specifier", "struct_specifier")
    return last(text_of(owner.child_by_field_name("name"))) if owner else "", name


def _condition(node: Node) -> str:
    """Return the text of the nearest ``if`` around it, in its function."""
    above = node
    while above.parent is not None and above.parent.type not in ("function_definition",):
        below, above = above, above.parent
        if above.type == "if_statement" and below != above.child_by_field_name("condition"):
            text = text_of(above.child_by_field_name("condition"))[1:-1]
            wrong = below.type == "else_clause"
            text = f"not ({text})" if wrong else text
            return text if len(text) <= LONGEST_CONDITION else text[: LONGEST_CONDITION - 1] + "…"
    return ""


def _conditions_before(node: Node) -> str:
    """Return all conditions before it in its function: around it, and where the function may end."""
    found, above = [], node
    while above.parent is not None and above.parent.type != "function_definition":
        below, above = above, above.parent
        if above.type == "if_statement" and below != above.child_by_field_name("condition"):
            text = _test(above.child_by_field_name("condition"))
            found.append(negated(text) if below.type == "else_clause" else text)
        elif above.type in _SOMETIMES or (
            # The function may end in a statement before this one.
            above.type == "compound_statement" and _left_at(above) < below.start_byte
        ):
            found.append(OTHERWISE)
    if _is_built_sometimes(above):
        found.append(OTHERWISE)
    return "&".join(dict.fromkeys(it for it in reversed(found) if it))


def _is_built_sometimes(node: Node) -> bool:
    """Return whether a function exists only as its code was built, header guards aside."""
    above = node.parent
    while above is not None:
        if above.type.startswith("preproc_") and not text_of(above)[:60].startswith("#ifndef"):
            return True
        above = above.parent
    return False


def _test(node: Node | None) -> str:
    """Return a condition as a text: ``<debug_>``, ``!<debug_>``, or that it is another one."""
    while node is not None and node.type in ("condition_clause", "parenthesized_expression"):
        node = node.child_by_field_name("value") or next(iter(node.named_children), None)
    if node is not None and node.type == "unary_expression" and text_of(node)[:1] == "!":
        return negated(_test(node.child_by_field_name("argument")))
    plain = ("identifier", "field_expression", "call_expression")
    text = evaluated(node) if node is not None and node.type in plain else ""
    return text if text[:1] == "<" and "(" not in text and text != ANY else OTHERWISE


@lru_cache(maxsize=256)
def _left_at(block: Node) -> float:
    """Return where the first statement of a block begins in which the function may end."""
    left = ("if_statement", "preproc_ifdef")
    found = (it.start_byte for it in block.named_children if it.type in left and _may_leave(it))
    return next(found, math.inf)


def _may_leave(node: Node) -> bool:
    if node.type in _LEAVES:
        return True
    return any(_may_leave(it) for it in node.named_children if it.type != "lambda_expression")


def _class(node: Node, place: Place) -> Iterator[Class]:
    body, name = node.child_by_field_name("body"), node.child_by_field_name("name")
    if body is None or name is None:
        return
    clause = next((it for it in node.children if it.type == "base_class_clause"), None)
    named = ("type_identifier", "qualified_identifier", "template_type")
    bases = tuple(text_of(it) for it in clause.named_children if it.type in named) if clause else ()
    above = node.parent
    heads = above.child_by_field_name("parameters") if above is not None else None
    parameters = []
    for it in heads.named_children if heads else ():
        # ``typename T = a::B`` -> ``T=a::B``.
        word, _, default = text_of(it).partition("=")
        own = word.split()[-1]
        parameters.append(f"{own}={default.strip()}" if default else own)
    members = {
        last(text_of(name)): text_of(field.child_by_field_name("type"))
        for field in body.named_children
        if field.type == "field_declaration"
        for name in field.children_by_field_name("declarator")
        if not text_of(name).startswith(("&", "*"))
    }
    yield Class(last(text_of(name)), bases, tuple(parameters), members, _at(node, place))


def _at(node: Node, place: Place) -> Place:
    return place._replace(line=node.start_point[0] + 1)


def _call(node: Node, place: Place) -> Iterator[Call | Value]:
    function = node.child_by_field_name("function")
    arguments = node.child_by_field_name("arguments")
    if function is None:
        return
    name, types, on = callee(function)
    given = arguments_of(arguments)
    scope = text_of(function).rpartition("::")[0]
    if name in MAKERS and (types or scope):
        yield _made(node, types[0] if types else scope, given, place)
        return
    owner, inside = _around(node)
    call = Call(
        *(owner, inside, name, types, given, on, _condition(node), _at(node, place)),
        _conditions_before(node),
    )
    yield call
    if NAMES_PARAMETER.fullmatch(name):
        yield from _parameter(call)


def _made(node: Node, type_: str, given: tuple[str, ...], place: Place) -> Call:
    owner, inside = _around(node)
    name = "" if MESSAGE.search(type_.partition("<")[0]) else last(type_)
    own = (name, template_arguments(type_), given, "", _condition(node), _at(node, place))
    return Call(owner, inside, *own, _conditions_before(node))


def _parameter(call: Call) -> Iterator[Value]:
    """Yield values of ``get_parameter("p", variable)``, ``declare_parameter(node, "p", default)``."""
    texts = [it for it in call.given if not is_node(it)]
    parameter = braced(texts[0]) if texts else ""
    at = (call.owner, call.function)
    for other in texts[1:]:
        if other.startswith("<") and call.name.startswith("get") and "(" not in other:
            yield Value(*at, other.strip("<>"), f"<@{parameter}>", call.place)
        elif not other.startswith("<"):
            yield Value(*at, f"@{parameter}", other, call.place)
    if len(texts) > 1 and not call.name.startswith("get") and texts[1].startswith("<"):
        yield Value(*at, f"@{parameter}", texts[1], call.place)


def _made_new(node: Node, place: Place) -> Iterator[Call]:
    type_ = text_of(node.child_by_field_name("type"))
    yield _made(node, type_, arguments_of(node.child_by_field_name("arguments")), place)


def _initialised(node: Node, place: Place) -> Iterator[Call | Value]:
    """Yield values and calls of a constructor's ``: member_(value)`` or ``: Base<T>(value)``."""
    name = text_of(node.named_children[0]) if node.named_children else ""
    given = arguments_of(node.named_children[-1])
    owner, inside = _around(node)
    if given:
        yield Value(owner, inside, last(name), given[0], place)
    yield Call(owner, "", last(name), template_arguments(name), given, "", "", _at(node, place))


def _declared(node: Node, place: Place) -> Iterator[Call | Value]:
    """Yield the value or call of ``Type name = value;`` or ``Type name(value);``."""
    declarator, value = (node.child_by_field_name(it) for it in ("declarator", "value"))
    if value is None or declarator is None or node.parent is None:
        return
    owner, inside = _around(node)
    if value.type == "argument_list":
        type_ = text_of(node.parent.child_by_field_name("type"))
        given = arguments_of(value)
        yield _made(node, type_, given, place)
        text = given[0] if given else ""
    else:
        text = evaluated(value)
    yield Value(owner, inside, last(text_of(declarator).partition("[")[0]), text, place)


def _assigned(node: Node, place: Place) -> Iterator[Value]:
    left, right = (node.child_by_field_name(it) for it in ("left", "right"))
    plain = text_of(node.child_by_field_name("operator")) == "="
    text = evaluated(right) if plain else ANY
    variable = ".".join(dotted(left)) or evaluated(left).strip("<>")
    yield Value(*_around(node), variable, text, _at(node, place))


def _each(node: Node, place: Place) -> Iterator[Value]:
    """Yield the variable of a loop over a range."""
    name = text_of(node.child_by_field_name("declarator")).strip("& ")
    yield Value(*_around(node), name, ANY, place)


def _default(node: Node, place: Place) -> Iterator[Value]:
    """Yield the default of a function's parameter, or of each member of a declaration."""
    owner, inside = _around(node)
    name = ""
    for at, it in enumerate(node.children):
        field = node.field_name_for_child(at)
        if field == "declarator":
            name = last(text_of(it))
        elif field == "default_value":
            yield Value(owner, inside, name, evaluated(it), place)


def _alias(node: Node, place: Place) -> Iterator[Alias]:
    name = text_of(node.child_by_field_name("name") or node.child_by_field_name("declarator"))
    type_ = text_of(node.child_by_field_name("type"))
    yield Alias(_around(node)[0], name, type_)


def _macro(node: Node, place: Place) -> Iterator[Value]:
    """Yield the value of ``#define TOPIC "scan"``."""
    name, text = (text_of(node.child_by_field_name(it)) for it in ("name", "value"))
    if text[:1] == text[-1:] == '"' and text.count('"') == 2:
        yield Value("", "", name, text[1:-1], place)


def _used(node: Node, place: Place) -> Iterator[Alias]:
    """Yield the alias of ``using a_msgs::msg::Scan;``; none of a namespace."""
    name = text_of(node.named_children[-1])
    if MESSAGE.search(name):
        yield Alias(_around(node)[0], last(name), name)


def _taking(node: Node, place: Place) -> Iterator[Constructor]:
    """Yield the names of a function's parameters."""
    parameters = node.child_by_field_name("parameters")
    full = text_of(node.child_by_field_name("declarator"))
    if parameters is None:
        return
    owner, _ = _around(node)
    names, defaults = [], []
    for it in parameters.named_children:
        name = re.split(r"[\s&*]", text_of(it.child_by_field_name("declarator")))[-1]
        if it.type in ("parameter_declaration", "optional_parameter_declaration"):
            names.append(name)
        if (value := it.child_by_field_name("default_value")) is not None:
            defaults.append((name, evaluated(value)))
    own = owner or last(full.rpartition("::")[0])
    yield Constructor(own, last(full), tuple(names), tuple(defaults), place.path)


HANDLERS: dict[str, Callable[[Any, Place], Iterator[Any]]] = {
    "class_specifier": _class,
    "struct_specifier": _class,
    "call_expression": _call,
    "new_expression": _made_new,
    "field_initializer": _initialised,
    "init_declarator": _declared,
    "assignment_expression": _assigned,
    "for_range_loop": _each,
    "optional_parameter_declaration": _default,
    "field_declaration": _default,
    "alias_declaration": _alias,
    "type_definition": _alias,
    "preproc_def": _macro,
    "using_declaration": _used,
    "function_declarator": _taking,
}
