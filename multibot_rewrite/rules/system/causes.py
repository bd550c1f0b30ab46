# SPDX-License-Identifier: Apache-2.0
"""Sentences for findings: the likely cause, the name that was meant, and what to do about it."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import islice, zip_longest
from typing import NamedTuple

from multibot_rewrite.base.conventions import ROWS
from multibot_rewrite.base.findings.finding import Remap, Setting
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.nearest import CHOICE, COMPARED, MISTYPED, nearest
from multibot_rewrite.base.rosnames import check_topic_name, expand
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.rules.system.instead import COMMON
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.records import ACTION, COMPONENT, HOST, PLUGIN, SPAWNER, End

# What a node does with a name, by the role of its endpoint.
DOES, TO_DO = ({role: said.split(" | ")[at] for (role,), said in ROWS["roles"]} for at in (0, 1))
# rcl has no rule for an action: it is made of these.
ACTION_PARTS = " and one rule for each of its _action/ names"
# FILE:LINE, as plans have the place of a plugin.
_PLACE = lazy_compile(r"(.+):(\d{1,9})")


class Cause(NamedTuple):
    """Why something is so, and what to do; the fields are those of ``Finding``."""

    hint: str
    file: str = ""
    line: int = 0
    remaps: tuple[Remap, ...] = ()
    settings: tuple[Setting, ...] = ()


def to_set(name: str, value: str, *nodes: str) -> Cause:
    """Return the parameter that these nodes are to have; an empty cause without a node."""
    said = f"set {name}: {value or repr('')} of {shorten(nodes)}" if nodes else ""
    return Cause(said, settings=tuple(Setting(it, name, value) for it in nodes))


def names_another(robot: str, owner: str, remaps: Sequence[Remap] = ()) -> Cause:
    """Return why nodes of a robot have a name of another one, and what gives them its own."""
    hint = f"correct the namespace, remap rule or parameter of {robot} that names {owner}"
    for node, old, new in remaps[:1]:
        rule = f"{old}:={new.removeprefix(node.rpartition('/')[0] + '/')}"
        hint += f"; pass the rule {rule} to {shorten([it.node for it in remaps])}"
    return Cause(hint, remaps=tuple(remaps))


def caused(hint: str, place: str) -> Cause:
    """Return the cause at ``place``, which is ``file:line`` or something else."""
    found = _PLACE.fullmatch(place)
    return Cause(hint, found[1], int(found[2])) if found else Cause(hint)


def plugin_of(plan: Index | None, node: str) -> tuple[str, str]:
    """Return (plugin that starts a planned node, its place); both empty without one."""
    place = str(plan.node[node].plugin) if plan and node in plan.node else ""
    if not (plan and place):
        return "", ""
    plain = plan.of_names.without_robot(node, plan.robot_of.get(node, ""))
    return f"plugin {plain.rpartition('/')[2]}", place


def remap_rule(planned: End) -> str:
    """Return the remap rule that gives an end its planned name; empty where none is needed."""
    if not planned.code_name or name_without_rules(planned) == planned.name:
        return ""
    namespace = planned.node.rpartition("/")[0] + "/"
    return f"{planned.code_name}:={planned.name.removeprefix(namespace)}"


def name_without_rules(planned: End) -> str:
    """Return the full name that the name in the node's code has without any remap rule."""
    if check_topic_name(planned.code_name):
        return ""
    namespace, _, node = planned.node.rpartition("/")
    return expand(planned.code_name, namespace or "/", node)


def names_without_rules(plan: Index, planned: End) -> tuple[str, ...]:
    """Return the names that an end may have without its remap rules or its namespace."""
    in_root = f"/{planned.code_name.strip('/').removeprefix('~/')}"
    robot = plan.robot_of.get(planned.node) or plan.robot(planned.name)
    plain = plan.of_names.without_robot(planned.name, robot)
    names = (name_without_rules(planned), in_root, plain)
    return tuple(name for name in names if name not in ("", "/", planned.name))


def use_absolute(name: str) -> str:
    """Return the hint about a relative name in the node's own namespace."""
    return f"the node resolves a relative name in its own namespace: write {name} in its parameters"


def why_not_remapped(plan: Index, planned: End) -> Cause:
    """Return why a name is still the one in the code, although a rule should remap it."""
    rule = remap_rule(planned)
    plugin, place = plugin_of(plan, planned.node)
    if plugin:
        # It may have the rule: what it loads is not given it in every release.
        missing = f"no remap rule {rule} of {plugin} is applied"
        text = missing if rule else f"{plugin} has no namespace or remap rule for it"
        return caused(f"{text}, see {place}", place)
    if not rule:
        return Cause("another remap rule, or an absolute name in its parameters, changes it")
    return Cause(f"the remap rule {rule} is not applied")


def how_to_remap(plan: Index, planned: End) -> str:
    """Return how to pass the rule to a node of the node set; empty for a plugin, which has a file."""
    rule = remap_rule(planned)
    if not rule or plugin_of(plan, planned.node)[1]:
        return ""
    parts = f",{ACTION_PARTS}" if planned.kind == ACTION else ""
    return f"; pass {how_to_pass(plan, planned.node, rule, 'it')}{parts}"


def how_to_pass(plan: Index, node: str, rule: str, what: str = "") -> str:
    """Return where a rule for a node goes, and how it is written there; ``what`` is what to call it."""
    way, taker = _way_in(plan, node)
    what = what or rule
    if way == PLUGIN:
        tag = f"<remapping>{rule}</remapping> in <ros> of the plugin of {taker}"
        return f"{what} in the description: {tag}"
    if way == HOST:
        # In the process of another node a rule says whose it is.
        led = f"{node.rpartition('/')[2]}:{rule}"
        return f"{what} to {taker}, whose process it is in: {_as_written(_way_in(plan, taker)[0], led)}"
    if way == SPAWNER:
        return f"{what} to its spawner: {_as_written(way, rule)}"
    if way == COMPONENT:
        return f"{what} where it is loaded into its container: {_as_written(way, rule)}"
    return f"{what} with {_as_written(way, rule)}"


def _way_in(plan: Index, node: str) -> tuple[str, str]:
    """Return (how a planned node gets its rules, the node that takes them for it)."""
    planned = plan.node.get(node)
    return (planned.way, planned.taker) if planned else ("", "")


def _as_written(way: str, rule: str) -> str:
    source, _, target = rule.partition(":=")
    pair = f"remappings=[({source!r}, {target!r})]"
    if way == SPAWNER:
        return f'--controller-ros-args "-r {rule}"'
    if way == COMPONENT:
        return f"{pair} of its ComposableNode"
    return f"--ros-args -r {rule}, or with {pair} in the launch file"


def why_other_name(plan: Index, node: str, match: str) -> Cause:
    """Return why a planned node runs under another name, which is ``match``."""
    robot = plan.robot_of[node]
    plugin, place = plugin_of(plan, node)
    plain = plan.of_names.without_robot(node, robot)
    space = plan.of_names.tag(robot)
    namespaced = node == f"/{space}{plain}"
    if match not in (plain, f"/{plain.rpartition('/')[2]}"):
        return Cause(f"{match} is running; is it this node under another name?")
    if plugin:
        missing = "namespace" if namespaced else "separate name for each robot"
        return caused(f"{match} is running: {plugin} has no {missing}, see {place}", place)
    way, taker = _way_in(plan, node)
    if way == HOST:
        return Cause(f"{match} is running in the process of {taker}: start {taker} as planned")
    above, _, last = node.rpartition("/")
    missing, rule = "name", Remap(match, "__node", last)
    if namespaced:
        missing, rule = "namespace", Remap(match, "__ns", above)
    option = f"--ros-args -r {rule.old}:={rule.new}"
    if way == COMPONENT:
        option = f"{missing}={rule.new!r} of its ComposableNode"
    elif namespaced:
        option = f"namespace={above[1:]!r} in the launch file, or {option}"
    why = f"{match} is running: it was started without the robot's {missing}"
    return Cause(f"{why}; use {option}", remaps=(rule,))


_DIGITS = lazy_compile(r"_?\d+")
_Rest = tuple[int | str, ...]


class Spelled:
    """Known names by how they are written: no name is compared with all."""

    def __init__(self, names: Iterable[str]) -> None:
        self.by_letters: dict[str, list[str]] = defaultdict(list)
        # The other words and the place of one -> that without its number -> the word, and the name.
        self.beside: dict[_Rest, dict[str, list[tuple[str, str]]]] = {}
        for name in names:
            self.by_letters[letters(name)].append(name)
            parts = name.split("/")
            for at in {1, len(parts) - 1}:
                words = self.beside.setdefault(_other_parts(parts, at), defaultdict(list))
                words[_DIGITS.sub("", parts[at])].append((parts[at], name))


NONE = Spelled(())


def alike(
    name: str, known: Spelled, type_: str, may_be: Callable[[str], bool] = lambda _: True
) -> str:
    """Return a known name that differs in case, dashes or one misspelled word only; empty for none."""
    same = known.by_letters.get(letters(name), ())
    folded = next((it for it in same if it != name and may_be(it)), "")
    if folded or type_.startswith(COMMON):
        return folded
    parts = name.split("/")
    for at in (1, len(parts) - 1):
        others = _with_other_word(parts, at, known)
        near = {word: it for word, it in others if it != name and may_be(it)}
        swapped = (it for it in near if sorted(it) == sorted(parts[at]))
        slips = [it for it in near if _is_slip(it, parts[at])]
        found = next(swapped, "") or nearest(parts[at], slips, MISTYPED)
        if found:
            return near[found]
    return ""


def _with_other_word(parts: list[str], at: int, known: Spelled) -> Iterator[tuple[str, str]]:
    """Yield (known name, its word there) of names that differ in one word alone, not in its number."""
    own, words = _DIGITS.sub("", parts[at]), known.beside.get(_other_parts(parts, at), {})
    found = (it for bare, others in words.items() if bare != own for it in others)
    return islice(found, COMPARED)


def _other_parts(parts: list[str], at: int) -> _Rest:
    """Return the parts of a name but that at one place, which is kept."""
    return at, *parts[:at], *parts[at + 1 :]


def _is_slip(one: str, other: str) -> bool:
    """Return whether each part between underscores is nearly equal: not cmd_vel_out and cmd_vel_ui."""
    parts = list(zip_longest(one.split("_"), other.split("_"), fillvalue=""))
    return all(here == there or nearest(here, (there,), CHOICE) for here, there in parts)


@lru_cache(maxsize=4096)
def letters(name: str) -> str:
    """Return the letters, digits and slashes of a name, in lower case."""
    return "".join(it for it in name.lower() if it.isalnum() or it == "/")
