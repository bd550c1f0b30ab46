# SPDX-License-Identifier: Apache-2.0
"""The sections of definition files, each parsed when it is first asked for."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import DefinitionsError, SiteRow
from multibot_rewrite.base.releases import RELEASES, has_release, is_release_words, share_release
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import (
    OF_VALUES,
    PluginDefinition,
    assemble,
    read_header,
    read_section,
)
from multibot_rewrite.description.rewriters.plugin_definitions.values import (
    Value,
    Values,
    has_values,
    read_values,
    values_of,
)

Raw = tuple[str, int, str]
VALUED = ("plugin", "hardware", OF_VALUES)


class Definitions:
    """The sections of several files, parsed on demand; build with ``load_definitions``.

    ``extended`` tells that some of them are not built in. It is of one ``release``, or has what all of
    them have, where that is empty; ``ros`` says whose plugins count where ROS 1 and ROS 2 have them.
    """

    def __init__(
        self, texts: Mapping[str, str], release: str, extended: bool = False, ros: str = ""
    ) -> None:
        self.extended = extended
        self.release = release
        self.ros = ros
        self._raw: dict[tuple[str, str], list[Raw]] = {}
        self._found: dict[tuple[str, str], tuple[PluginDefinition, ...]] = {}
        self._values: dict[tuple[str, bool], Values | None] = {}
        for file, text in texts.items():
            preamble, *chunks = ("\n" + text).split("\n[")
            line = 0
            for line, row in enumerate(preamble.split("\n")):
                if row.strip() and not row.startswith("#"):
                    raise DefinitionsError(f"{file}:{line}: move this below the first [section]")
            for chunk in chunks:
                line += 1
                type_, *names = read_header(f"{file}:{line}", chunk.partition("\n")[0])
                for name in names:
                    self._raw.setdefault((type_, name), []).append((file, line, chunk))
                line += chunk.count("\n")

    def find(self, type_: str, name: str) -> tuple[PluginDefinition, ...]:
        """Return the sections of that type and name: more than one if ROS 1 and 2 differ.

        Sections of one flavour are one; a later one without ``ros:`` adds to every flavour.
        """
        found = self.of_every_ros(type_, name)
        own = () if len(found) < 2 else tuple(it for it in found if it.ros in ("", self.ros))
        return own if own and self.ros else found

    def of_every_ros(self, type_: str, name: str) -> tuple[PluginDefinition, ...]:
        """Return the sections of that type and name for ROS 1 and ROS 2."""
        return self._find((type_, name), ())

    def _find(self, key: tuple[str, str], within: tuple[str, ...]) -> tuple[PluginDefinition, ...]:
        """Return the sections of a key; ``within`` are the blocks that are being read."""
        if key in self._found or key not in self._raw:
            return self._found.get(key, ())
        made: list[PluginDefinition] = []
        for raw in self._raw[key]:
            section = self._parse(*raw, within)
            if not self._is_in_release(section.releases):
                continue
            here = [
                at
                for at, old in enumerate(made)
                if section.ros in ("", old.ros)
                and (self.release or section.releases == old.releases)
            ]
            for at in here:
                made[at] = merge(made[at], section)
            if not here:
                made.append(section)
        # Whole when others see it; two threads that make it at once both get the first one's.
        return self._found.setdefault(key, tuple(made))

    def _is_in_release(self, words: str) -> bool:
        return not self.release or has_release(words, self.release)

    def has(self, type_: str, name: str) -> bool:
        """Return whether a section of that type and name exists, in this release or another."""
        return (type_, name) in self._raw

    def names(self, type_: str) -> Iterator[str]:
        """Yield every name and alias of that type."""
        return (name for of, name in self._raw if of == type_)

    def rows_elsewhere(self, type_: str, name: str) -> Iterator[SiteRow]:
        """Yield the rows that this release lacks, with the releases that have them."""
        for file, line, chunk in self._raw.get((type_, name), ()):
            if "releases" in chunk:
                settings, own = read_section(file, line, chunk.split("\n"))
                words = settings.get("releases", "")
                for site in own.values():
                    if not (self._is_in_release(words) and self._is_in_release(site.releases)):
                        yield site._replace(releases=site.releases or words)

    def releases_elsewhere(self, type_: str, name: str) -> tuple[str, ...]:
        """Return the releases with a section of that name, if this one has none."""
        if self.find(type_, name):
            return ()
        words = [_released(chunk) for *_, chunk in self._raw.get((type_, name), ())]
        return tuple(it for it in RELEASES if any(has_release(word, it) for word in words))

    def values(self, name: str, of_ros_1: bool = False) -> Values | None:
        """Return the values that the plugin or hardware reads, in any release, or None."""
        key = (name, of_ros_1)
        if key not in self._values:
            raws = [it for type_ in VALUED for it in self._raw.get((type_, name), ())]
            own = [it for it in raws if has_values(it[2]) and _is_of_ros_1(it[2]) == of_ros_1]
            self._values.setdefault(key, self._read_values(name, own, of_ros_1) if own else None)
        return self._values[key]

    def _read_values(self, name: str, raws: Sequence[Raw], of_ros_1: bool) -> Values:
        whole = [it for it in raws if _rows_of_setting(it[2], "read")]
        file, line, chunk = (*whole, *raws)[0]
        type_, *names = read_header(f"{file}:{line}", chunk.partition("\n")[0])
        # What several classes read alike is written once.
        first = name if type_ == OF_VALUES else names[0]
        is_open = not whole or any(
            "yes" in word for it in whole for word in _rows_of_setting(it[2], "open")
        )
        return values_of((first, *names), of_ros_1, is_open, self._value_rows(raws))

    def _value_rows(self, raws: Iterable[Raw]) -> Iterator[Value]:
        """Yield the values of unread sections, and of the blocks that they include."""
        for file, line, chunk in raws:
            yield from read_values(file, line + 1, chunk.split("\n")[1:])
            for block in " ".join(_rows_of_setting(chunk, "with")).split():
                yield from self._value_rows(self._raw.get(("block", block), ()))

    def valued(self) -> Iterator[tuple[str, bool]]:
        """Yield (name, whether it is for ROS 1) for each name that has values."""
        named = ((name, raws) for (type_, name), raws in self._raw.items() if type_ in VALUED)
        for name, raws in named:
            found = {_is_of_ros_1(it[2]) for it in raws if has_values(it[2])}
            yield from ((name, of_ros_1) for of_ros_1 in found)

    def places(self) -> dict[str, list[str]]:
        """Return each element with a section and the elements it may be in, without reading more."""
        found: dict[str, list[str]] = {}
        elements = ((key[1], raws) for key, raws in self._raw.items() if key[0] == "element")
        for name, all_raws in elements:
            raws = [raw for raw in all_raws if self._is_in_release(_released(raw[2]))]
            if raws:
                rows = (row for raw in raws for row in _rows_of_setting(raw[2], "at"))
                found[name] = list(dict.fromkeys(word for row in rows for word in row.split()))
        return found

    def sections(self, *types: str) -> list[PluginDefinition]:
        """Return all rewriters of these types, parsed and checked, in file order."""
        return self._all_parsed(key for key in self._raw if key[0] in types)

    def sections_in(self, files: Container[str]) -> list[PluginDefinition]:
        """Return all rewriters with a part in these files, parsed and checked, and their values."""
        raws = self._raw.items()
        found = self._all_parsed(key for key, raw in raws if any(part[0] in files for part in raw))
        own = (part for _, parts in raws for part in parts if part[0] in files)
        tuple(self._value_rows(own))
        return found

    def _all_parsed(self, keys: Iterable[tuple[str, str]]) -> list[PluginDefinition]:
        found = [section for key in keys for section in self.find(*key)]
        return list({(section.file, section.line): section for section in found}.values())

    def _parse(self, file: str, line: int, chunk: str, within: tuple[str, ...]) -> PluginDefinition:
        """Return the section of a text that begins at a line."""
        rows = chunk.split("\n")
        settings, own = read_section(file, line, rows)
        sites: dict[str, SiteRow] = {}
        for name in settings.get("with", "").split():
            place = f"{file}:{line}"
            if name in within:
                raise DefinitionsError(f"{place}: with: {name}: it includes itself; remove it")
            if not self.has("block", name):
                raise DefinitionsError(f"{place}: with: {name}: there is no [block {name}]; add it")
            found = self._find(("block", name), (*within, name))
            sites |= {site.path: site for site in (found[0].sites if found else ())}
        header = read_header(f"{file}:{line}", rows[0])
        sites |= {
            site.path if self.release else key: site
            for key, site in own.items()
            if self._is_in_release(site.releases)
        }
        return assemble(file, line, header, settings, list(sites.values()))


def _released(chunk: str) -> str:
    """Return the unchecked release setting of a section that is not read yet."""
    words = next((row.strip() for row in _rows_of_setting(chunk, "releases")), "")
    return words if words and is_release_words(words) else ""


def _is_of_ros_1(chunk: str) -> bool:
    return " 1" in _rows_of_setting(chunk, "ros")


def _rows_of_setting(chunk: str, name: str) -> list[str]:
    """Return the rows of a setting in a section that is not read yet."""
    return [it.partition("\n")[0] for it in chunk.split(f"\n{name}:")[1:]]


def merge(first: PluginDefinition, second: PluginDefinition) -> PluginDefinition:
    """Return two sections of one thing as one: a user's file may add to what is known.

    Raises DefinitionsError if both have one path or set one setting differently.
    """
    there = lists_by_key((site.path, site) for site in first.sites)
    # Of two sections with one block: its lines are not there twice.
    of_blocks = {(it.section, it.path) for it in first.sites if it.section[:6] == "block "}
    new = [it for it in second.sites if (it.section, it.path) not in of_blocks]
    for site in new:
        if any(share_release(site.releases, it.releases) for it in there.get(site.path, ())):
            raise DefinitionsError(
                f"{second.file}:{site.line}: {site.path} is in {first.file} already; remove one"
            )
    below = _agreed_setting(first, second, "model_namespace")
    sites = first.sites + tuple(new)
    return first._replace(
        sites=tuple(site._replace(below_model=below) for site in sites),
        model_namespace=below,
        at=first.at + tuple(name for name in second.at if name not in first.at),
        blocks=first.blocks + tuple(name for name in second.blocks if name not in first.blocks),
        select=_agreed_setting(first, second, "select"),
        unique=_agreed_setting(first, second, "unique"),
        helper=_agreed_setting(first, second, "helper"),
        wired=first.wired + second.wired,
        switches=first.switches + second.switches,
        hardwired=first.hardwired + second.hardwired,
        inserts=first.inserts and second.inserts,
        process_wide=first.process_wide or second.process_wide,
        tags=first.tags | second.tags,
        opens=tuple(dict.fromkeys((*first.opens, *second.opens))),
    )


def _agreed_setting(first: PluginDefinition, second: PluginDefinition, setting: str) -> str:
    """Return a setting of two sections; raises DefinitionsError where both have it differently."""
    old, new = getattr(first, setting), getattr(second, setting)
    if old and new and old != new:
        place = f"{second.file}:{second.line}"
        raise DefinitionsError(f"{place}: {setting}: is {old!r} in {first.file}; write the same")
    return str(old or new)
