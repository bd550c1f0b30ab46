"""YAML with the place of every value: what errors in a data file need to name file and line."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, NoReturn, TypeAlias

from multibot_rewrite.model import UsageError
from multibot_rewrite.nearest import did_you_mean_one_of

if TYPE_CHECKING:
    import yaml

_BOOLEAN = "tag:yaml.org,2002:bool"
_NULL = "tag:yaml.org,2002:null"
_LINE = "\n"
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
        return Item(f"{file}:1", None) if node is None else _item(node, file, frozenset())
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        # A document that ends too early is at fault on the line after its last.
        place = f"{file}:{min(mark.line, text.count(_LINE)) + 1}" if mark else file
        reason = getattr(error, "problem", None) or str(error).partition("\n")[0]
        raise UsageError(f"{place}: broken YAML, correct it: {reason}") from None
    except RecursionError:
        raise UsageError(f"{file}: broken YAML, nested too deep") from None


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
        where = f"{file}:{key.start_mark.line + 1}"
        if not isinstance(key.value, str):
            raise UsageError(f"{where}: a key is a mapping or a list, write a name")
        if key.value in found:
            raise UsageError(f"{where}: {key.value!r} stands here twice, leave one out")
        # A block value starts a line below its key; the key is what a reader looks for.
        found[key.value] = _item(value, file, above)._replace(where=where)
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


def word(item: Item, what: str) -> str:
    """A text, possibly empty."""
    if not isinstance(item.value, str):
        wrong(item, f"{what} is {_shape(item)}, write a text, in quotes where need be")
    return item.value


def table_of(keys: Mapping[str, Item], key: str) -> Mapping[str, Item]:
    """The mapping of a key, empty where it is absent."""
    return table(keys[key], key) if key in keys else {}


def entries_of(keys: Mapping[str, Item], key: str) -> tuple[Item, ...]:
    """The list of a key, empty where it is absent; a single word is a list of one."""
    return entries(keys[key], key) if key in keys else ()


def entries(item: Item, what: str) -> tuple[Item, ...]:
    """The entries of a list; a single word is a list of one."""
    if isinstance(item.value, str):
        return (item,)
    if not isinstance(item.value, tuple):
        wrong(item, f"{what} is {_shape(item)}, write a list")
    return item.value


def words_of(keys: Mapping[str, Item], key: str) -> tuple[str, ...]:
    """The words listed by a key, none where it is absent."""
    return tuple(word(entry, key) for entry in entries_of(keys, key))


def word_of(keys: Mapping[str, Item], key: str, otherwise: str = "") -> str:
    """The text of a key, ``otherwise`` where it is absent."""
    return word(keys[key], key) if key in keys else otherwise


def flag_of(keys: Mapping[str, Item], key: str, otherwise: bool = False) -> bool:
    """True or false as a key says, ``otherwise`` where it is absent."""
    if key not in keys:
        return otherwise
    value = keys[key].value
    if not isinstance(value, bool):
        wrong(keys[key], f"{key} is {_shape(keys[key])}, write true or false")
    return value


def wrong(item: Item, message: str) -> NoReturn:
    """Raise UsageError at the place of ``item``."""
    raise UsageError(f"{item.where}: {message}")


def unknown(what: str, name: str, known: Iterable[str], more: Iterable[str] = ()) -> str:
    """That ``name`` is not known, with the nearest of all and the list of ``known``."""
    known = sorted(known)
    near = did_you_mean_one_of(name, [*known, *more])
    return f"{what} {name!r} is not known; {near}{near and ' '}known: {', '.join(known) or 'none'}"


def _shape(item: Item) -> str:
    if isinstance(item.value, str):
        return f"the text {item.value!r}"
    if isinstance(item.value, bool):
        return "true or false"
    if item.value is None:
        return "empty"
    return "a mapping" if isinstance(item.value, Mapping) else "a list"
