# SPDX-License-Identifier: Apache-2.0
"""Python -> what its classes and functions call, by ``ast``.

A member of an object is written with it: ``self.topic``; what a class has itself, too.
"""

import ast
import re
import warnings
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from multibot_rewrite.producers.sources.records import (
    ANY,
    OTHERWISE,
    Alias,
    Call,
    Class,
    Constructor,
    Place,
    Source,
    Value,
    braced,
    joined,
    negated,
)

# What is given a type and a name, by the names of their parameters.
_TYPES = ("msg_type", "srv_type", "action_type", "srv_class")
_TOPICS = ("topic", "srv_name", "action_name", "name")
# Where the type is.
TYPE_AT = {
    **dict.fromkeys(("create_publisher", "create_subscription"), 0),
    **dict.fromkeys(("create_service", "create_client"), 0),
    **dict.fromkeys(("ActionServer", "ActionClient", "Subscriber"), 1),
    "service_caller": 2,
}
# They give back what they are asked of, if that is a parameter.
_SAME = ("get_parameter_value", "as_string", "as_bool")
ENUMERATED = "<new enumerate>"
MOST_ROUNDS = 32
_PLACE = re.compile(r"\{\}|%s")

# The fields of a statement that run only sometimes.
_LOOP = ("body", "orelse")
_SOMETIMES: dict[type, tuple[str, ...]] = {
    **dict.fromkeys((ast.While, ast.For, ast.AsyncFor, ast.ExceptHandler), _LOOP),
    ast.BoolOp: ("values",),
    ast.Match: ("cases",),
}


class _Part(NamedTuple):
    """A piece of a syntax tree: its function, the nearest condition's text, and all conditions."""

    node: ast.AST
    function: str
    condition: str = ""
    asked: str = ""


def read_python(text: str, place: Place) -> Source:
    """Return what a Python file declares and calls; for one that does not parse only the fault."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        line = getattr(error, "lineno", None) or 1
        return Source(faults=((place._replace(line=line), "does not parse"),))
    names = dict(_imported(tree))
    try:
        parts = [_read_statement(node, names, place) for node in tree.body]
    except RecursionError:
        return Source(faults=((place, "is nested too deeply"),))
    aliases = tuple(Alias("", name, full.replace(".", "::")) for name, full in names.items())
    modules = tuple(dict.fromkeys(_modules(tree)))
    return joined([*parts, Source(aliases=aliases, imports=modules)])


def _imported(tree: ast.AST) -> Iterator[tuple[str, str]]:
    """Yield (name, type) of ROS types: ``from nav_msgs.msg import Odometry``."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            for alias in node.names:
                yield alias.asname or alias.name, f"{node.module or ''}.{alias.name}"
        elif isinstance(node, ast.Import):
            yield from ((it.asname, it.name) for it in node.names if it.asname)


def _modules(tree: ast.AST) -> Iterator[str]:
    """Yield imported modules, and parts that may be modules; relative ones start with a dot."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (it.name for it in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = "." * node.level + (node.module or "")
            yield above
            joint = "" if above.endswith(".") else "."
            yield from (f"{above}{joint}{it.name}" for it in node.names)


def _read_statement(node: ast.stmt, types: dict[str, str], place: Place) -> Source:
    owner = node.name if isinstance(node, ast.ClassDef) else ""
    classes = (
        (Class(owner, tuple(map(_text, node.bases)), (), {}, place._replace(line=node.lineno)),)
        if isinstance(node, ast.ClassDef)
        else ()
    )
    takers: list[Constructor] = []
    calls: list[Call] = []
    values: list[Value] = []
    free = node.name if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) else ""
    for part in _parts_below(_Part(node, free)):
        found, function = part.node, part.function
        if isinstance(found, (ast.FunctionDef, ast.AsyncFunctionDef)):
            takers.append(_read_function(found, owner, function, place))
        elif isinstance(found, ast.Call):
            calls.append(_call(found, owner, part, types, place))
            values += _parameter_values(found, owner, function, place)
        else:
            at = place._replace(line=getattr(found, "lineno", 0))
            values += (
                Value(owner, function, name if function or not owner else f"self.{name}", text, at)
                for name, text in _assigned_values(found)
            )
    return Source(classes, tuple(calls), tuple(values), (), tuple(takers))


def _read_function(node: Any, owner: str, function: str, place: Place) -> Constructor:
    plain = any(_text(it) == "<staticmethod>" for it in node.decorator_list)
    every = [*node.args.posonlyargs, *node.args.args]
    names = every[1:] if owner and "." not in function and not plain else every
    defaults = zip(reversed(every), reversed(node.args.defaults), strict=False)
    alone = zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True)
    given = [(it.arg, _text(default)) for it, default in (*defaults, *alone) if default]
    own = owner if function == "__init__" else function
    words = (*(it.arg for it in names), *(it.arg for it in node.args.kwonlyargs))
    return Constructor(owner, own, words, tuple(given), place.path)


def _assigned_values(node: ast.AST) -> Iterator[tuple[str, str]]:
    """Yield (name, value) for names that a piece of code gives a value."""
    if isinstance(node, ast.Assign):
        for it in node.targets:
            yield from _pairs(it, node.value)
    elif isinstance(node, (ast.AnnAssign, ast.NamedExpr)):
        yield from _pairs(node.target, node.value) if node.value else ()
    elif isinstance(node, (ast.For, ast.comprehension)):
        yield from _loop_variables(node)
    elif isinstance(node, (ast.AugAssign, ast.AsyncFor)):
        yield from _pairs(node.target, None)
    elif isinstance(node, ast.withitem) and node.optional_vars:
        yield from _pairs(node.optional_vars, node.context_expr)
    elif isinstance(node, ast.ExceptHandler) and node.name:
        yield node.name, ANY


def _loop_variables(node: ast.For | ast.comprehension) -> Iterator[tuple[str, str]]:
    """Yield (variable, value) of a loop over a list; behind a number if it is enumerated."""
    target, over = node.target, _iterated(node.iter)
    pair = isinstance(target, ast.Tuple) and len(target.elts) == 2
    if isinstance(target, ast.Tuple) and pair and _text(node.iter) == ENUMERATED:
        yield from _pairs(target.elts[0], None)
        target = target.elts[1]
    if isinstance(target, ast.Name) and not (isinstance(node, ast.comprehension) and node.ifs):
        yield target.id, over
    else:
        yield from _pairs(target, None)


def _iterated(node: ast.expr) -> str:
    """Return ``<each list:a|b>``, or ``<each SIDES>``, for what a loop iterates over."""
    if _text(node) == ENUMERATED and isinstance(node, ast.Call) and node.args:
        return _iterated(node.args[0])
    text = _text(node)
    return f"<each {text[1:-1]}>" if text[:1] == "<" and text.count("<") == 1 else ANY


def _pairs(target: ast.expr, value: ast.expr | None) -> Iterator[tuple[str, str]]:
    """Yield (name, value) for the names that an assignment sets."""
    if isinstance(target, (ast.Tuple, ast.List)):
        same = isinstance(value, (ast.Tuple, ast.List)) and len(value.elts) == len(target.elts)
        each = value.elts if same else [None] * len(target.elts)  # type: ignore[union-attr]
        for one, it in zip(target.elts, each, strict=True):
            yield from _pairs(one, it)
    elif isinstance(target, (ast.Name, ast.Attribute)):
        yield _text(target)[1:-1], _text(value) if value is not None else ANY


def _parts_below(part: _Part) -> Iterator[_Part]:
    """Yield a part and all below it, each with its function and conditions."""
    yield part
    node = part.node
    if isinstance(node, ast.Lambda):
        part = part._replace(asked=_both_conditions(part.asked, OTHERWISE))
    if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
        # What calls it decides when it runs.
        part = _Part(node, part.function)
    for name, value in ast.iter_fields(node):
        below = part
        if isinstance(node, (ast.If, ast.IfExp)) and name != "test":
            below = _part_under(part, node.test, name == "orelse")
        elif isinstance(node, ast.For) and name == "body" and not any(map(_may_return, node.body)):
            below = part._replace(asked=_both_conditions(part.asked, _iterated(node.iter)))
        elif name in _SOMETIMES.get(type(node), ()):
            below = part._replace(asked=_both_conditions(part.asked, OTHERWISE))
        yield from _parts_in_order(value if isinstance(value, list) else [value], below)


def _part_under(part: _Part, test: ast.expr, wrong: bool) -> _Part:
    """Return a part under the condition of an ``if``, or of its ``else`` if ``wrong``."""
    text = ast.unparse(test)
    asked = _condition(test)
    if text.replace('"', "'") == "__name__ == '__main__'":
        return part
    return part._replace(
        condition=f"not ({text})" if wrong else text,
        asked=_both_conditions(part.asked, negated(asked) if wrong else asked),
    )


def _parts_in_order(nodes: list[Any], part: _Part) -> Iterator[_Part]:
    """Yield the parts of some statements; those behind one that may return are conditional."""
    for it in nodes:
        if not isinstance(it, ast.AST):
            continue
        inside = part.function
        if isinstance(it, (ast.FunctionDef, ast.AsyncFunctionDef)):
            inside = f"{part.function}.{it.name}".strip(".")
        elif isinstance(it, ast.ClassDef):
            inside = f"{part.function}.{it.name}.".lstrip(".")
        yield from _parts_below(part._replace(node=it, function=inside))
        if isinstance(it, ast.If) and _may_return(it):
            part = part._replace(asked=_both_conditions(part.asked, OTHERWISE))


def _may_return(node: ast.AST) -> bool:
    """Return whether a function may end in this statement, without an error."""
    inner = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda, ast.ClassDef)
    if isinstance(node, (ast.Return, ast.Continue, ast.Break)):
        return True
    return any(_may_return(it) for it in ast.iter_child_nodes(node) if not isinstance(it, inner))


def _condition(node: ast.expr) -> str:
    """Return the text of a condition; ``OTHERWISE`` for one that is no plain name or call."""
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        return negated(_condition(node.operand))
    is_plain = isinstance(node, (ast.Name, ast.Attribute, ast.Call))
    return _text(node) if is_plain and _text(node) != ANY else OTHERWISE


def _both_conditions(one: str, other: str) -> str:
    return "&".join(dict.fromkeys(filter(None, (*one.split("&"), *other.split("&")))))


def _call(node: ast.Call, owner: str, part: _Part, types: dict[str, str], place: Place) -> Call:
    name = _called_name(node) or _text(node.func).strip("<>")
    given = [_text(it) for it in node.args]
    named = {it.arg or "**": it.value for it in node.keywords}
    typed: tuple[str, ...] = ()
    if name in TYPE_AT:
        of_type = next((named.pop(it) for it in _TYPES if it in named), None)
        at = TYPE_AT[name]
        if of_type is None and len(node.args) > at:
            of_type = node.args[at]
            del given[at]
        if of_type is not None:
            # With the module that it is from.
            head, dot, rest = ast.unparse(of_type).partition(".")
            typed = (f"{types.get(head, head)}{dot}{rest}",)
        topic = next((named.pop(it) for it in _TOPICS if it in named), None)
        given += [_text(topic)] if topic is not None else []
    on = _text(node.func.value) if isinstance(node.func, ast.Attribute) else ""
    own = "" if on == "<this>" else on
    return Call(
        owner,
        part.function,
        name,
        typed,
        tuple(given),
        own,
        part.condition,
        place._replace(line=node.lineno),
        part.asked,
        tuple((key, _text(it)) for key, it in named.items()),
    )


def _parameter_values(node: ast.Call, owner: str, function: str, place: Place) -> Iterator[Value]:
    """Yield values of ``declare_parameter('p', default)`` and of lists in ``declare_parameters``."""
    name, at = _called_name(node), place._replace(line=node.lineno)
    named = {it.arg: it.value for it in node.keywords}
    if name == "declare_parameter":
        key = node.args[0] if node.args else named.get("name")
        default = node.args[1] if len(node.args) > 1 else named.get("value")
        if key is not None and default is not None:
            yield Value(owner, function, f"@{braced(_text(key))}", _text(default), at)
    rows = [it for it in (*node.args, *named.values()) if isinstance(it, (ast.List, ast.Tuple))]
    for it in rows[:1] if name == "declare_parameters" else ():
        for row in (row for row in it.elts if isinstance(row, ast.Tuple) and len(row.elts) > 1):
            key, default = row.elts[:2]
            at = place._replace(line=row.lineno)
            yield Value(owner, function, f"@{braced(_text(key))}", _text(default), at)


def _called_name(node: ast.Call) -> str:
    return node.func.attr if isinstance(node.func, ast.Attribute) else ""


def _text(node: ast.AST) -> str:
    """Return an expression as a text; unknown parts are in <>."""
    return TEXTS.get(type(node), lambda _: ANY)(node)


def _text_of_constant(node: ast.Constant) -> str:
    if isinstance(node.value, str):
        return ANY if {"<", ">"} & {*node.value} else node.value
    return f"<{node.value!r}>"


def _text_of_attribute(node: ast.Attribute) -> str:
    text = _text(node.value)
    if node.attr in ("value", "string_value", "bool_value") and text != "<this>":
        return text
    inner = "self" if text == "<this>" else text[1:-1]
    is_name = text[:1] == "<" and text[-1:] == ">" and inner.replace(".", "").isidentifier()
    return f"<{inner}.{node.attr}>" if is_name else f"<?.{node.attr}>"


def _text_of_sum(node: ast.BinOp) -> str:
    if isinstance(node.op, ast.Mod):
        words = node.right.elts if isinstance(node.right, ast.Tuple) else [node.right]
        return _text_with(_text(node.left), words)
    return _text(node.left) + _text(node.right) if isinstance(node.op, ast.Add) else ANY


def _text_with(text: str, words: list[ast.expr]) -> str:
    """Return a text with these words in its places; each place has one."""
    parts = _PLACE.split(text)
    if len(parts) != len(words) + 1 or "%" in "".join(parts):
        return ANY
    return parts[0] + "".join(
        _text(word) + part for word, part in zip(words, parts[1:], strict=True)
    )


def _text_of_call(node: ast.Call) -> str:
    name = _called_name(node)
    if name in ("get_parameter", "declare_parameter", "get_parameter_or"):
        named = (it.value for it in node.keywords if it.arg == "name")
        key = node.args[0] if node.args else next(named, None)
        return f"<@{braced(_text(key))}>" if key is not None else ANY
    if isinstance(node.func, ast.Attribute):
        return _text_of_method(name, node)
    made = _text(node.func).strip("<>")
    if made == "range":
        return _text_of_range(node)
    return _text(node.args[0]) if made == "str" and node.args else f"<new {made}>"


def _text_of_method(name: str, node: ast.Call) -> str:
    """Return the value of a method call: a node, a filled text or an object."""
    on = _text(node.func.value) if isinstance(node.func, ast.Attribute) else ANY
    if name == "create_node" and node.args:
        return f"<Node:{braced(_text(node.args[0]))}>"
    if name == "format" and not node.keywords:
        return _text_with(on, node.args)
    made = f"<new {name}>" if name[:1].isupper() else ANY
    return on if name in _SAME else made


def _text_of_range(node: ast.Call) -> str:
    """Return a range of a few numbers as their list."""
    ends = [it.value for it in node.args if isinstance(it, ast.Constant)]
    whole = [it for it in ends if isinstance(it, int)]
    if not 0 < len(whole) == len(node.args) < 3:
        return ANY
    numbers = range(*whole)
    return f"<list:{'|'.join(map(str, numbers))}>" if 0 < len(numbers) <= MOST_ROUNDS else ANY


def _text_of_list(node: ast.List | ast.Tuple) -> str:
    """Return a list of texts or numbers."""
    words = [str(it.value) for it in node.elts if isinstance(it, ast.Constant)]
    plain = 0 < len(words) == len(node.elts) <= MOST_ROUNDS and not {*"<>|{}"} & {*"".join(words)}
    return f"<list:{'|'.join(words)}>" if plain else ANY


TEXTS: dict[type, Callable[[Any], str]] = {
    ast.Constant: _text_of_constant,
    ast.BinOp: _text_of_sum,
    ast.JoinedStr: lambda node: "".join(map(_text, node.values)),
    ast.FormattedValue: lambda node: ANY if node.format_spec else _text(node.value),
    ast.Attribute: _text_of_attribute,
    ast.Name: lambda node: "<this>" if node.id == "self" else f"<{node.id}>",
    ast.Call: _text_of_call,
    ast.List: _text_of_list,
    ast.Tuple: _text_of_list,
}
