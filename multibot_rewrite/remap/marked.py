"""YAML with the place of every value: what errors in a data file need to name file and line."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, NoReturn, TypeAlias

from multibot_rewrite.model import UsageError

if TYPE_CHECKING:
    import yaml

_BOOLEAN = "tag:yaml.org,2002:bool"
_NULL = "tag:yaml.org,2002:null"
Value: TypeAlias = "str | bool | Mapping[str, Item] | tuple[Item, ...] | None"


class Item(NamedTuple):
    """A value of a YAML file; ``where`` is ``file:line``."""

    where: str
    value: Value


def read_marked(text: str, file: str) -> Item:
    """The one document of a YAML text; raises UsageError naming ``file`` and the line."""
    import yaml  # tens of milliseconds that only stacks need

    # The C parser is ten times quicker; PyYAML is built without it on some platforms.
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        node = yaml.compose(text, Loader=loader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f"{file}:{mark.line + 1}" if mark else file
        reason = getattr(error, "problem", None) or str(error)
        raise UsageError(f"{place}: broken YAML, correct it: {reason}") from None
    except RecursionError:
        raise UsageError(f"{file}: broken YAML, nested too deep") from None
    return Item(f"{file}:1", None) if node is None else _item(node, file, frozenset())


def _item(node: yaml.Node, file: str, above: frozenset[int]) -> Item:
    import yaml

    where = f"{file}:{node.start_mark.line + 1}"
    if id(node) in above:
        raise UsageError(f"{where}: the alias stands inside what it repeats, write it out")
    above |= {id(node)}
    if isinstance(node, yaml.MappingNode):
        return Item(where, _mapping(node, file, above))
    if isinstance(node, yaml.SequenceNode):
        return Item(where, tuple(_item(child, file, above) for child in node.value))
    if node.tag == _NULL:
        return Item(where, None)
    return Item(where, _truth(node.value) if node.tag == _BOOLEAN else str(node.value))


def _truth(word: str) -> bool:
    return word.lower() in ("true", "yes", "on")


def _mapping(node: yaml.MappingNode, file: str, above: frozenset[int]) -> dict[str, Item]:
    found: dict[str, Item] = {}
    for key, value in node.value:
        name = str(key.value)
        if name in found:
            where = f"{file}:{key.start_mark.line + 1}"
            raise UsageError(f"{where}: {name!r} stands here twice, leave one out")
        item = _item(value, file, above)
        # A block value starts a line below its key; the key is what a reader looks for.
        found[name] = item._replace(where=f"{file}:{key.start_mark.line + 1}")
    return found


def table(item: Item, what: str, allowed: Sequence[str] = ()) -> Mapping[str, Item]:
    """The keys of a mapping, an absent value being an empty one; other keys are an error."""
    if item.value is None:
        return {}
    if not isinstance(item.value, Mapping):
        wrong(item, f"{what} is {_shape(item)}, write keys and values")
    for key, value in item.value.items():
        if allowed and key not in allowed:
            wrong(value, unknown("key", key, allowed))
    return item.value


def entries(item: Item, what: str) -> tuple[Item, ...]:
    """The entries of a list; a single word is a list of one."""
    if isinstance(item.value, str):
        return (item,)
    if not isinstance(item.value, tuple):
        wrong(item, f"{what} is {_shape(item)}, write a list")
    return item.value


def words(item: Item, what: str) -> tuple[str, ...]:
    """A list of words."""
    return tuple(word(entry, what) for entry in entries(item, what))


def word(item: Item, what: str) -> str:
    """A text, possibly empty."""
    if not isinstance(item.value, str):
        wrong(item, f"{what} is {_shape(item)}, write a text, in quotes where need be")
    return item.value


def flag(item: Item, what: str) -> bool:
    """True or false."""
    if not isinstance(item.value, bool):
        wrong(item, f"{what} is {_shape(item)}, write true or false")
    return item.value


def wrong(item: Item, message: str) -> NoReturn:
    """Raise UsageError at the place of ``item``."""
    raise UsageError(f"{item.where}: {message}")


def unknown(what: str, name: str, known: Iterable[str], more: Iterable[str] = ()) -> str:
    """That ``name`` is not known, with the nearest of all and the list of ``known``."""
    from difflib import get_close_matches  # only a message needs it

    known = sorted(known)
    near = get_close_matches(name, [*known, *more], 1, 0.4)
    hint = f"did you mean {near[0]!r}? " if near else ""
    return f"{what} {name!r} is not known; {hint}known: {', '.join(known) or 'none'}"


def _shape(item: Item) -> str:
    if isinstance(item.value, str):
        return f"the text {item.value!r}"
    if isinstance(item.value, bool):
        return "true or false"
    if item.value is None:
        return "empty"
    return "a mapping" if isinstance(item.value, Mapping) else "a list"
