# SPDX-License-Identifier: Apache-2.0
"""Launch files in XML and YAML -> actions; a text with ``$(name value ...)`` in it -> its parts.

Source: launch and launch_ros jazzy, frontend/expose.py, ``parse`` of each action, of each substitution
and of descriptions/composable_node.py; share/launch/frontend/grammar.lark,
frontend/parse_substitution.py."""

import re
import shlex
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from typing import Any, NamedTuple

from multibot_rewrite.base.bounded import A_VALUE, load_yaml, read_bytes
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.producers.launch.entities import LINE, Entity, root_of
from multibot_rewrite.producers.launch.stand_in import packages, values
from multibot_rewrite.producers.launch.stand_in.names import names
from multibot_rewrite.producers.launch.stand_in.values import TextSubstitution

Parts = list[Any]
_NAME = lazy_compile(r"[A-Za-z][\w-]*")
_ESCAPED = lazy_compile(r"\\(.)", re.DOTALL)
# Text at the top or between these quotes, and a word of a substitution there.
_TEXTS, _WORDS = (
    {it: re.compile(rf"(?:[^\\${it}{ends}]|\\.|\$(?!\())+", re.DOTALL) for it in ("", "'", '"')}
    for ends in ("", " ()")
)
_WORDS[""] = re.compile(r"(?:[^\\$'\" ()]|\\.|\$(?!\())+", re.DOTALL)


# Those that are not made of their words one by one.
_OTHERWISE: Mapping[str, Callable[..., Any]] = {
    "command": lambda line, *_: values.Command(line),
    "eval": lambda *words: values.PythonExpression([it for word in words for it in word]),
    "path-join": lambda *words: packages.PathJoinSubstitution(words),
    "string-join": lambda delimiter, *words: packages.StringJoinSubstitution(words, delimiter),
}


@cache
def known() -> Mapping[str, Callable[..., Any]]:
    """Return what makes each substitution."""
    classes = {**vars(values), **vars(packages)}
    plain = {word: classes[it] for word, it in names().substitutions.items()}
    return {**plain, **_OTHERWISE}


def parse_substitution(value: str) -> Parts:
    """Return the parts of a text; raises ValueError if it is malformed or unknown."""
    parts, at = _parts_of_text(value, 0, _TEXTS[""], "")
    if at < len(value):
        raise ValueError(f"a substitution is not closed: {value[at : at + 40]!r}")
    return parts or [values.TextSubstitution(text="")]


def _parts_of_text(text: str, at: int, plain: re.Pattern[str], quote: str) -> tuple[Parts, int]:
    """Return texts and substitutions from a place on, and where they end."""
    parts: Parts = []
    while True:
        if found := plain.match(text, at):
            parts.append(values.TextSubstitution(text=_ESCAPED.sub(r"\1", found[0])))
            at = found.end()
        elif text.startswith("$(", at):
            part, at = _placed(text, at + 2, quote)
            parts.append(part)
        else:
            return parts, at


def _placed(text: str, at: int, quote: str) -> tuple[Any, int]:
    """Return the substitution whose name begins here, and the offset behind it."""
    found = _NAME.match(text, at)
    name = found[0] if found else ""
    if name in ("arg", "find", "optenv"):
        raise ValueError(f"Unknown substitution: {name}")
    if name not in known():
        raise ValueError(f"$({text[at : at + 40]}: this substitution needs launch itself")
    at += len(name)
    words = []
    while text.startswith(" ", at):
        word, at = _quoted_parts(text, at + 1, quote)
        words.append(word)
    if not text.startswith(")", at):
        raise ValueError(f"$({name} is not closed")
    return known()[name](*words), at + 1


def _quoted_parts(text: str, at: int, quote: str) -> tuple[Parts, int]:
    mark = text[at : at + 1]
    if quote or mark not in ("'", '"'):
        return _parts_of_text(text, at, _WORDS[quote], quote)
    parts, at = _parts_of_text(text, at + 1, _TEXTS[mark], mark)
    return parts or [values.TextSubstitution(text="")], at + 1


Reader = Callable[[Any], Any]
_TYPES = {"int": int, "float": float, "bool": bool, "str": str}
_KINDS = {"yaml", *_TYPES, *(f"list_of_{it}" for it in _TYPES)}


class Form(NamedTuple):
    """The class that a tag stands for, in its module, and what becomes of the entity.

    ``values`` and ``below`` have the argument that each attribute, or the entities of each tag
    below it, becomes, and how it is read. ``needs`` are attributes that have to be there; all other
    entities below become ``actions``."""

    module: str
    name: str
    values: Mapping[str, tuple[str, Reader]]
    below: Mapping[str, tuple[str, Reader]]
    needs: tuple[str, ...]
    actions: str


def description_in(path: str) -> Any:
    """Return the launch description of an XML or YAML file; raises what launch raises for a bad one."""
    made = [_action_of(it) for it in root_of(read_bytes(path), path).below]
    return import_module("launch").LaunchDescription(made)


def _action_of(entity: Entity) -> Any:
    """Return the action of an entity."""
    form = forms().get(entity.tag)
    if entity.tag in ("env", "machine", "param", "remap", "rosparam", "test"):
        raise RuntimeError(f"Unrecognized entity of the type: {entity.tag}")
    if form is None:
        return _unread(entity.tag)
    condition = _condition(entity)
    made = _action_by_form(entity, form)
    if condition is not None:
        made.condition = condition
    return made


def _action_by_form(entity: Entity, form: Form) -> Any:
    for it in form.needs:
        entity.values[it] = entity.take(it)
    named = {key: it for key, it in form.values.items() if key in entity.values}
    given = {it: read(entity.take(key)) for key, (it, read) in named.items()}
    for tag, (argument, read) in form.below.items():
        if found := entity.all(tag):
            given[argument] = read(found)
    if form.actions:
        given[form.actions] = [_action_of(it) for it in entity.below]
        entity.below = []
    entity.check()
    made = getattr(import_module(form.module), form.name)(**given)
    setattr(made, LINE, entity.line)
    return made


def _unread(tag: str) -> Any:
    """Return an action for an unknown element, which raises NotImplementedError when it is run."""

    def refuse(_: Any) -> None:
        raise NotImplementedError(f"<{tag}> is not read: it needs launch itself")

    return import_module("launch.actions").OpaqueFunction(function=refuse)


def _condition(entity: Entity) -> Any:
    words = [it for it in ("if", "unless") if it in entity.values]
    if len(words) > 1:
        raise RuntimeError("if and unless conditions can't be used simultaneously")
    kinds = import_module("launch.conditions")
    classes = {"if": kinds.IfCondition, "unless": kinds.UnlessCondition}
    return next((classes[it](_substitutions(entity.take(it))) for it in words), None)


def _substitutions(value: Any) -> Any:
    return parse_substitution(value if isinstance(value, str) else str(value))


def _truth(value: Any) -> bool:
    return value if isinstance(value, bool) else value.lower() in ("true", "1", "on", "yes")


def _command_words(line: str) -> list[Any]:
    """Return the words of a command: its own blanks separate, not those of values (ExecuteProcess)."""
    found: list[list[Any]] = [[]]
    for it in parse_substitution(line):
        if not isinstance(it, TextSubstitution):
            found[-1].append(it)
            continue
        tokens = shlex.split(it.text)
        found += [[]] * it.text[:1].isspace()
        for at, token in enumerate(tokens):
            found += [[]] if at else []
            found[-1] = [*found[-1], TextSubstitution(text=token)]
        found += [[]] * (it.text[-1:].isspace() and bool(tokens))
    return [it for it in found if it]


def _pair_reader(first: str, second: str) -> Callable[[list[Entity]], list[Any]]:
    def read(entities: list[Entity]) -> list[Any]:
        return [tuple(_substitutions(it) for it in _take(one, first, second)) for one in entities]

    return read


def _take(entity: Entity, *names: str) -> list[Any]:
    found = [entity.take(it) for it in names]
    entity.check()
    return found


def _parameter(entity: Entity) -> Any:
    if "from" not in entity.values:
        return dict([_named_value(entity)])
    allowed = entity.values.pop("allow_substs", False)
    (path,) = _take(entity, "from")
    files = import_module("launch_ros.descriptions")
    allowed = _substitutions(allowed) if isinstance(allowed, str) else allowed
    return files.ParameterFile(_substitutions(path), allow_substs=allowed)


def _named_value(entity: Entity) -> tuple[Any, Any]:
    """Return (name, value) of a parameter; the value is a dict where parameters are below it."""
    name = tuple(_substitutions(entity.take("name")))
    if inner := entity.all("param"):
        entity.check()
        return name, dict(map(_named_value, inner))
    kind = entity.values.pop("type", "yaml")
    if kind not in _KINDS:
        raise ValueError(f"Got invalid type identifier {kind!r}")
    (value,) = _take(entity, "value")
    made = import_module("launch_ros.descriptions").ParameterValue
    return name, made(_typed(value, kind), value_type=_TYPES.get(kind))


def _typed(value: Any, kind: str) -> Any:
    """Return a value as YAML has it, that of XML by its type; its substitutions get one later."""
    if isinstance(value, list):
        return [_typed(it, kind.removeprefix("list_of_")) for it in value]
    if not isinstance(value, str):
        return value
    if "$(" in value or kind == "str":
        return _substitutions(value)
    return load_yaml(value, A_VALUE) if value else value


def _component(entity: Entity) -> Any:
    condition = _condition(entity)
    made = _action_by_form(entity, forms()["composable_node"])
    made._condition = condition
    return made


_MODULES = {
    "": "launch.actions",
    "ros": "launch_ros.actions",
    "made": "launch_ros.descriptions",
    "loops": f"{__package__}.processes",
}
_READERS: Mapping[str, Reader] = {
    **{"": _substitutions, "text": str, "truth": _truth, "words": _command_words},
    "end": lambda _: [import_module("launch.actions").Shutdown()],
}
_named = _pair_reader("name", "value")
_BELOW: Mapping[str, Reader] = {
    **dict.fromkeys(("arg", "env", "extra_arg"), _named),
    "choice": lambda found: [str(*_take(it, "value")) for it in found],
    "composable_node": lambda found: [_component(it) for it in found],
    "keep": lambda found: {tuple(name): value for name, value in _named(found)},
    "param": lambda found: [_parameter(it) for it in found],
    "remap": _pair_reader("from", "to"),
}


@cache
def forms() -> Mapping[str, Form]:
    """Return the form of each tag, by ``launch.yaml``."""
    return {tag: _form(text) for tag, text in names().elements.items()}


def _form(text: str) -> Form:
    """Return the form for ``[module] class: attributes``, with the words of its groups."""
    while "%" in text:
        text = re.sub(r"%(\w+)", lambda it: names().groups[it[1]], text)
    head, _, words = text.partition(":")
    module, _, class_ = head.rpartition(" ")
    values, below, needs = {}, {}, []
    for word in words.split():
        key, _, argument = word.strip("!").partition("=")
        key, _, how = key.partition(":")
        needs += [key] if word[0] == "!" else []
        if key[0] == "<":
            below[key[1:-1]] = argument, _BELOW.get(key[1:-1], _substitutions)
        else:
            values[key] = argument or key, _READERS[how]
    actions, _ = below.pop("*", ("", None))
    return Form(_MODULES[module], class_, values, below, tuple(needs), actions)
