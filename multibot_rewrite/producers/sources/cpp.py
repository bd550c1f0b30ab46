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


def _outer(node: Node, *types: str) -> Node | None:
    """Return the nearest node of one of these types around a node; None without."""
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


def _scope_of(node: Node) -> tuple[str, str]:
    """Return (class, function) that a node of the syntax tree is in."""
    function = node if node.type == "function_definition" else _outer(node, "function_definition")
    name = ""
    if function is not None and (declarator := _declarator(function)) is not None:
        full = text_of(declarator.child_by_field_name("declarator"))
        name = last(full) if "operator" not in full else ""
        if "::" in re.sub(r"<[^<>]*>", "", full):
            return last(re.sub(r"<[^<>]*>", "", full).rpartition("::")[0]), name
    owner = _outer(function or node, "class_specifier", "struct_specifier")
    return last(text_of(owner.child_by_field_name("name"))) if owner else "", name


def _condition(node: Node) -> str:
    """Return the text of the nearest ``if`` around a node, in its function."""
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
    """Return all conditions before a node in its function: around it, and of earlier exits."""
    found, above = [], node
    while above.parent is not None and above.parent.type != "function_definition":
        below, above = above, above.parent
        if above.type == "if_statement" and below != above.child_by_field_name("condition"):
            text = _condition_text(above.child_by_field_name("condition"))
            found.append(negated(text) if below.type == "else_clause" else text)
        elif above.type in _SOMETIMES or (
            # The function may end in a statement before this one.
            above.type == "compound_statement" and _first_exit_in(above) < below.start_byte
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


def _condition_text(node: Node | None) -> str:
    """Return a condition as a text: ``<debug_>``, ``!<debug_>``, or that it is another one."""
    while node is not None and node.type in ("condition_clause", "parenthesized_expression"):
        node = node.child_by_field_name("value") or next(iter(node.named_children), None)
    if node is not None and node.type == "unary_expression" and text_of(node)[:1] == "!":
        return negated(_condition_text(node.child_by_field_name("argument")))
    plain = ("identifier", "field_expression", "call_expression")
    text = evaluated(node) if node is not None and node.type in plain else ""
    return text if text[:1] == "<" and "(" not in text and text != ANY else OTHERWISE


@lru_cache(maxsize=256)
def _first_exit_in(block: Node) -> float:
    """Return where the first statement begins in which the function may end; infinite for none."""
    left = ("if_statement", "preproc_ifdef")
    found = (it.start_byte for it in block.named_children if it.type in left and _may_return(it))
    return next(found, math.inf)


def _may_return(node: Node) -> bool:
    """Return whether a function may end in this statement."""
    if node.type in _LEAVES:
        return True
    return any(_may_return(it) for it in node.named_children if it.type != "lambda_expression")


def _read_class(node: Node, place: Place) -> Iterator[Class]:
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


def _read_call(node: Node, place: Place) -> Iterator[Call | Value]:
    function = node.child_by_field_name("function")
    arguments = node.child_by_field_name("arguments")
    if function is None:
        return
    name, types, on = callee(function)
    given = arguments_of(arguments)
    scope = text_of(function).rpartition("::")[0]
    if name in MAKERS and (types or scope):
        yield _made_object(node, types[0] if types else scope, given, place)
        return
    owner, inside = _scope_of(node)
    call = Call(
        *(owner, inside, name, types, given, on, _condition(node), _at(node, place)),
        _conditions_before(node),
    )
    yield call
    if NAMES_PARAMETER.fullmatch(name):
        yield from _values_of_parameter(call)


def _made_object(node: Node, type_: str, given: tuple[str, ...], place: Place) -> Call:
    """Return the making of an object as a call of its class."""
    owner, inside = _scope_of(node)
    name = "" if MESSAGE.search(type_.partition("<")[0]) else last(type_)
    own = (name, template_arguments(type_), given, "", _condition(node), _at(node, place))
    return Call(owner, inside, *own, _conditions_before(node))


def _values_of_parameter(call: Call) -> Iterator[Value]:
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


def _read_new(node: Node, place: Place) -> Iterator[Call]:
    type_ = text_of(node.child_by_field_name("type"))
    yield _made_object(node, type_, arguments_of(node.child_by_field_name("arguments")), place)


def _read_initialiser(node: Node, place: Place) -> Iterator[Call | Value]:
    """Yield values and calls of a constructor's ``: member_(value)`` or ``: Base<T>(value)``."""
    name = text_of(node.named_children[0]) if node.named_children else ""
    given = arguments_of(node.named_children[-1])
    owner, inside = _scope_of(node)
    if given:
        yield Value(owner, inside, last(name), given[0], place)
    yield Call(owner, "", last(name), template_arguments(name), given, "", "", _at(node, place))


def _read_declaration(node: Node, place: Place) -> Iterator[Call | Value]:
    """Yield the value or call of ``Type name = value;`` or ``Type name(value);``."""
    declarator, value = (node.child_by_field_name(it) for it in ("declarator", "value"))
    if value is None or declarator is None or node.parent is None:
        return
    owner, inside = _scope_of(node)
    if value.type == "argument_list":
        type_ = text_of(node.parent.child_by_field_name("type"))
        given = arguments_of(value)
        yield _made_object(node, type_, given, place)
        text = given[0] if given else ""
    else:
        text = evaluated(value)
    yield Value(owner, inside, last(text_of(declarator).partition("[")[0]), text, place)


def _read_assignment(node: Node, place: Place) -> Iterator[Value]:
    left, right = (node.child_by_field_name(it) for it in ("left", "right"))
    plain = text_of(node.child_by_field_name("operator")) == "="
    text = evaluated(right) if plain else ANY
    variable = ".".join(dotted(left)) or evaluated(left).strip("<>")
    yield Value(*_scope_of(node), variable, text, _at(node, place))


def _read_loop(node: Node, place: Place) -> Iterator[Value]:
    """Yield the variable of a loop over a range."""
    name = text_of(node.child_by_field_name("declarator")).strip("& ")
    yield Value(*_scope_of(node), name, ANY, place)


def _read_default(node: Node, place: Place) -> Iterator[Value]:
    """Yield the default of a function's parameter, or of each member of a declaration."""
    owner, inside = _scope_of(node)
    name = ""
    for at, it in enumerate(node.children):
        field = node.field_name_for_child(at)
        if field == "declarator":
            name = last(text_of(it))
        elif field == "default_value":
            yield Value(owner, inside, name, evaluated(it), place)


def _read_alias(node: Node, place: Place) -> Iterator[Alias]:
    name = text_of(node.child_by_field_name("name") or node.child_by_field_name("declarator"))
    type_ = text_of(node.child_by_field_name("type"))
    yield Alias(_scope_of(node)[0], name, type_)


def _read_macro(node: Node, place: Place) -> Iterator[Value]:
    """Yield the value of ``#define TOPIC "scan"``."""
    name, text = (text_of(node.child_by_field_name(it)) for it in ("name", "value"))
    if text[:1] == text[-1:] == '"' and text.count('"') == 2:
        yield Value("", "", name, text[1:-1], place)


def _read_using(node: Node, place: Place) -> Iterator[Alias]:
    """Yield the alias of ``using a_msgs::msg::Scan;``; none of a namespace."""
    name = text_of(node.named_children[-1])
    if MESSAGE.search(name):
        yield Alias(_scope_of(node)[0], last(name), name)


def _read_parameters(node: Node, place: Place) -> Iterator[Constructor]:
    """Yield the names of a function's parameters."""
    parameters = node.child_by_field_name("parameters")
    full = text_of(node.child_by_field_name("declarator"))
    if parameters is None:
        return
    owner, _ = _scope_of(node)
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
    "class_specifier": _read_class,
    "struct_specifier": _read_class,
    "call_expression": _read_call,
    "new_expression": _read_new,
    "field_initializer": _read_initialiser,
    "init_declarator": _read_declaration,
    "assignment_expression": _read_assignment,
    "for_range_loop": _read_loop,
    "optional_parameter_declaration": _read_default,
    "field_declaration": _read_default,
    "alias_declaration": _read_alias,
    "type_definition": _read_alias,
    "preproc_def": _read_macro,
    "using_declaration": _read_using,
    "function_declarator": _read_parameters,
}
