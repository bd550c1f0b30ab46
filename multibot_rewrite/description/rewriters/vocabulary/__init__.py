# SPDX-License-Identifier: Apache-2.0
"""The vocabulary: which tag of which plugin holds which name. Data in ``*.vocab``, read lazily.

A file is a list of sections. The whole grammar:

    # a comment
    [element sensor]                     an XML element; names after the first are aliases
    at: gazebo link                      the elements it may be in ("/" is the document)
    @name        declares sensor         the value at this path declares a name of this kind
    plugin/frame uses frame              the value refers to one (kinds are tried in order)
    @type        keep an enumeration     the value is never renamed, and why
    radius       value number above=0    the value is a number; nothing is said of names in it

A section is one of

    [element NAME]     an XML element by its tag; ``[element srdf.group]`` is about ``<group>`` too,
                       where it means something else
    [plugin NAME]      a plugin by its library, without ``lib`` and ``.so``, or by its class
    [hardware NAME]    a ros2_control hardware class, as in ``<plugin>``
    [sensor TYPE]      a ``<sensor>`` by its type
    [block NAME]       lines that several sections share by ``with: NAME``
    [values NAME]      what one of the plugins or hardware classes of another section reads, in
                       ``value`` lines alone: whether names are in it nobody has looked

A path is child steps, then ``@attribute`` for an attribute; a step may ask for an attribute:
``param[@name=mimic]``. After the kinds may stand, in this order or another, then ``# a note``:

    form=NAME          where in the value the names are
    default=TEXT       the literal the consumer falls back to; ``topic/../x`` is the value at ``topic``
                       with its last segment replaced; ``a=true,b=?x`` is x where those siblings have
                       these texts; in it ``{model}`` is the name that the spawner gives, ``{link}``
                       the canonical link, ``{sensor}`` the sensor around, ``{topic}`` the text there
    fill=TEXT          what is written in place of a default below ``{model}/``, if not what is behind
    when=SIBLING=TEXT  only where that sibling has this text is it a name of ours
    empty=WORD         what the consumer makes of an element that is there and empty: ``default``, as
                       if it was not there (usual for a namespace: the root); ``model``, the model's
                       name; ``itself``, the empty text (usual for the rest)
    publishes=TYPE     what is done with a topic of that name; the same ``subscribes=``, ``serves=``
    releases=WORDS     the only releases that read it, without blanks: ``kilted+``, ``<=jazzy``,
                       ``humble,jazzy``; a path may have a line for one release and another one

Any line of a plugin or hardware may say what its value is; a ``value`` line has the type as its first
word, and may be beside a line for the same path that says whose name it is:

    type=TYPE          ``text`` (where none is given), ``number``, ``integer``, ``boolean``, ``vector``,
                       ``pose``, ``color`` or ``any``
    read=FILE:LINE     where the code reads it, below the folder of ``read:``; ``@TAG`` behind it where
                       that is another tag
    required=yes       without it the plugin is not loaded
    one=A|B            the only words it may be
    unit=UNIT          ``m``, ``Hz``, ``rad``: of ``rad`` more than a turn is a mistake
    range=A..B         the least and the most that make sense, either may be left out; ``above=A``:
                       more than that
    checked=FILE:LINE  where the source says so, if not where it is read

Kinds are those of ``naming.SEPARATORS`` and ``collision`` (the name of a collision that the
URDF -> SDF conversion made from a link's). A link, joint, model or group is renamed only where this
file declares it; a frame that is the name of a link is spelled like the link. A ``stem`` is a word
that topics are made of, a ``subtopic`` is below a stem or namespace.

    form=whole       the value is one name (where no form is given)
    form=list        names separated by commas or white space
    form=scoped      ``model::link``: models, then the name
    form=words       any text, ``(key value ...)``: those of its words that this file declares
    form=suffixed    ``link/light``, ``link::visual``: a declared name with something else behind it
    form=member      ``link::sensor``, ``world::model::link::sensor``, ``link/sensor``: below a link
    form=transport   a topic of Gazebo Classic's own: ``~/topic`` or ``~/model/topic``
    form=regex       a regular expression for whole names, alternatives affixed one by one
    form=prefix      put in front of names in code: a postfix cannot reach them (MB422)
    form=lettered    the same behind a letter, which the code drops
    form=remap       a ROS remap rule ``from:=to``: ``to`` is the name, and with the kind ``stem``
                     what ``from`` begins with is one
    form=argument    the same as an argument, ``__ns:=`` and ``__node:=`` among them
    form=collision   a collision, scoped or not, recomputed when its link is renamed

A line ``SETTING: TEXT`` is a setting; given twice, the texts are joined.

    at: ELEMENT...         elements only: where it may be
    select: TYPE           elements only: what it loads decides its section (plugin, hardware, sensor)
    with: BLOCK...         the lines of these blocks too; an own line at the same path wins
    ros: 1 | 2             for that ROS alone, where both have a plugin of this name
    publishes: TOPIC...    topics that no parameter moves, where ``ros/remapping`` is read: remapped;
                           TOPIC=TYPE also says the type (``odom=nav_msgs/msg/Odometry``),
                           ``={PATH:TYPE}`` that it is the one written there, or TYPE; a topic below
                           the value at a path is ``{camera_name}/image_raw``, or with ``../`` in
                           front of the path below that of the element around; ``a=x,../@b=y|z?TOPIC``
                           is there on that condition
    subscribes: TOPIC...   the same
    serves: SERVICE...     the same
    switches: P=TOPIC...   parameter P turns that topic on, P=TOPIC=on: it is on unless P says false;
                           of several for /tf the first is that of odometry
    insert: yes | no       no where the consumer throws on children it does not know (default: yes)
    unique: KIND           bare names of this kind are looked up in the whole world
    hardwired: KIND:NAME... names it looks for whatever the file says: a rename hides them
    opens: WORD...         what it opens beside the names of its rows: ``nothing``; ``model``, names
                           below the one that the spawner gives; ``namespace``, relative names of nodes
                           of its own, which only a namespace keeps apart; ``world``, what is the
                           world's, which a second one would open again; ``address:PATH``,
                           ``file:PATH``: what is written there, ``=DEFAULT`` behind it, conditions and
                           ``?`` before it; ``unknown``: nobody has looked, as where this and every
                           topic, service and namespace is missing
    model_namespace: RELEASES  its relative topics stand below the <model namespace> in these (kilted+)
    process_wide: yes | no its remap rules hold for every node of the process (default: no)
    read: REPOSITORY TAG FOLDER  all that its code reads is here, as it is there: what else is written
                           in it is a mistake
    open: yes | no         with ``read:``: whether it takes anything else, too (default: no)
    about: TEXT            what it is
    source: TEXT           where in which source that can be read, if not in the folder of ``read:``
    releases: WORDS        the only releases that have it: ``kilted+``, ``<=jazzy``, ``humble, jazzy``

A section may be given again, in another file too: it adds lines and topics to the first one; with
``releases`` in these releases alone. Two lines at one path are refused. Files are the built-in ones,
those of installed packages (see ``installed``) and those a call or a command names, in this order.
"""

from __future__ import annotations

import os
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache

from multibot_rewrite.base.bounded import read_text
from multibot_rewrite.base.model import Site, VocabularyError
from multibot_rewrite.base.releases import RELEASES, has_release, is_release_words
from multibot_rewrite.description.rewriters.vocabulary.grammar import (
    FORMS as FORMS,
)
from multibot_rewrite.description.rewriters.vocabulary.grammar import (
    KINDS as KINDS,
)
from multibot_rewrite.description.rewriters.vocabulary.grammar import (
    OF_VALUES,
    assemble,
    merge,
    read_header,
    read_section,
)
from multibot_rewrite.description.rewriters.vocabulary.grammar import (
    TYPES as TYPES,
)
from multibot_rewrite.description.rewriters.vocabulary.grammar import (
    VocabularySection as VocabularySection,
)
from multibot_rewrite.description.rewriters.vocabulary.grammar import (
    is_step as is_step,
)
from multibot_rewrite.description.rewriters.vocabulary.grammar import (
    split_path as split_path,
)
from multibot_rewrite.description.rewriters.vocabulary.grammar import (
    split_step as split_step,
)
from multibot_rewrite.description.rewriters.vocabulary.installed import advice as advice
from multibot_rewrite.description.rewriters.vocabulary.installed import installed
from multibot_rewrite.description.rewriters.vocabulary.values import (
    Value as Value,
)
from multibot_rewrite.description.rewriters.vocabulary.values import (
    Values as Values,
)
from multibot_rewrite.description.rewriters.vocabulary.values import (
    has_values,
    read_values,
    values_of,
)

HERE = os.path.dirname(__file__)
Raw = tuple[str, int, str]
VALUED = ("plugin", "hardware", OF_VALUES)


class Vocabulary:
    """The sections of several files, parsed on demand; build with ``load_vocabulary``.

    ``extended`` tells that some of them are not built in. It is of one ``release``, or has what all of
    them have, where that is empty.
    """

    def __init__(self, texts: Mapping[str, str], release: str, extended: bool = False) -> None:
        self.extended = extended
        self.release = release
        self._raw: dict[tuple[str, str], list[Raw]] = {}
        self._found: dict[tuple[str, str], tuple[VocabularySection, ...]] = {}
        self._values: dict[tuple[str, bool], Values | None] = {}
        for file, text in texts.items():
            self._index(file, text)

    def _index(self, file: str, text: str) -> None:
        preamble, *chunks = ("\n" + text).split("\n[")
        line = 0
        for line, row in enumerate(preamble.split("\n")):
            if row.strip() and not row.startswith("#"):
                raise VocabularyError(f"{file}:{line}: text before the first [section]")
        for chunk in chunks:
            line += 1
            type_, *names = read_header(f"{file}:{line}", chunk.partition("\n")[0])
            for name in names:
                self._raw.setdefault((type_, name), []).append((file, line, chunk))
            line += chunk.count("\n")

    def find(self, type_: str, name: str) -> tuple[VocabularySection, ...]:
        """The rewriters of that type under that name: more than one where ROS 1 and 2 differ.

        Sections of one flavour are one; a later one without ``ros:`` adds to every flavour.
        """
        return self._find((type_, name), ())

    def _find(self, key: tuple[str, str], within: tuple[str, ...]) -> tuple[VocabularySection, ...]:
        """``within`` are the blocks that are being read."""
        if key in self._found or key not in self._raw:
            return self._found.get(key, ())
        made: list[VocabularySection] = []
        for raw in self._raw[key]:
            section = self._read(*raw, within)
            if self._is_here(section.releases):
                self._add(made, section)
        # Whole when others see it; two threads that make it at once both get the first one's.
        return self._found.setdefault(key, tuple(made))

    def _add(self, found: list[VocabularySection], new: VocabularySection) -> None:
        same = [
            at
            for at, old in enumerate(found)
            if new.ros in ("", old.ros) and (self.release or new.releases == old.releases)
        ]
        for at in same:
            found[at] = merge(found[at], new)
        if not same:
            found.append(new)

    def _is_here(self, words: str) -> bool:
        return not self.release or has_release(words, self.release)

    def has(self, type_: str, name: str) -> bool:
        """Is there a section of that type and name, in this release or another?"""
        return (type_, name) in self._raw

    def names(self, type_: str) -> Iterator[str]:
        """Every name and alias of that type."""
        return (name for of, name in self._raw if of == type_)

    def rows_elsewhere(self, type_: str, name: str) -> Iterator[Site]:
        """The rows that this release lacks, each with the words for the releases that have it."""
        for file, line, chunk in self._raw.get((type_, name), ()):
            if "releases" in chunk:
                settings, own = read_section(file, line, chunk.split("\n"))
                words = settings.get("releases", "")
                for site in own.values():
                    if not (self._is_here(words) and self._is_here(site.releases)):
                        yield site._replace(releases=site.releases or words)

    def releases_elsewhere(self, type_: str, name: str) -> tuple[str, ...]:
        """The releases with a section of that name, where this one has none."""
        if self.find(type_, name):
            return ()
        words = [_released(chunk) for *_, chunk in self._raw.get((type_, name), ())]
        return tuple(it for it in RELEASES if any(has_release(word, it) for word in words))

    def values(self, name: str, of_ros_1: bool = False) -> Values | None:
        """What the plugin or hardware of that name reads, in any release; None where nobody looked."""
        key = (name, of_ros_1)
        if key not in self._values:
            raws = [it for type_ in VALUED for it in self._raw.get((type_, name), ())]
            own = [it for it in raws if has_values(it[2]) and _is_of_ros_1(it[2]) == of_ros_1]
            self._values.setdefault(key, self._read_values(own, of_ros_1) if own else None)
        return self._values[key]

    def _read_values(self, raws: Sequence[Raw], of_ros_1: bool) -> Values:
        whole = [it for it in raws if _set(it[2], "read")]
        file, line, chunk = (*whole, *raws)[0]
        names = read_header(f"{file}:{line}", chunk.partition("\n")[0])[1:]
        is_open = not whole or any("yes" in word for it in whole for word in _set(it[2], "open"))
        return values_of(names, of_ros_1, is_open, self._value_rows(raws))

    def _value_rows(self, raws: Iterable[Raw]) -> Iterator[Value]:
        for file, line, chunk in raws:
            yield from read_values(file, line + 1, chunk.split("\n")[1:])
            for block in " ".join(_set(chunk, "with")).split():
                yield from self._value_rows(self._raw.get(("block", block), ()))

    def valued(self) -> Iterator[tuple[str, bool]]:
        """The names that have values; with true for those of ROS 1."""
        named = ((name, raws) for (type_, name), raws in self._raw.items() if type_ in VALUED)
        for name, raws in named:
            found = {_is_of_ros_1(it[2]) for it in raws if has_values(it[2])}
            yield from ((name, of_ros_1) for of_ros_1 in found)

    def places(self) -> dict[str, list[str]]:
        """Each element with a section and the elements it may be in, without reading more."""
        found: dict[str, list[str]] = {}
        elements = ((key[1], raws) for key, raws in self._raw.items() if key[0] == "element")
        for name, all_raws in elements:
            raws = [raw for raw in all_raws if self._is_here(_released(raw[2]))]
            if raws:
                rows = (row for raw in raws for row in _set(raw[2], "at"))
                found[name] = list(dict.fromkeys(word for row in rows for word in row.split()))
        return found

    def sections(self, *types: str) -> list[VocabularySection]:
        """All rewriters of these types, parsed and checked, in file order."""
        return self._parsed(key for key in self._raw if key[0] in types)

    def sections_in(self, files: Container[str]) -> list[VocabularySection]:
        """All rewriters that these files have a part in, parsed and checked, and their values."""
        raws = self._raw.items()
        found = self._parsed(key for key, raw in raws if any(part[0] in files for part in raw))
        own = (part for _, parts in raws for part in parts if part[0] in files)
        tuple(self._value_rows(own))
        return found

    def _parsed(self, keys: Iterable[tuple[str, str]]) -> list[VocabularySection]:
        found = [section for key in keys for section in self.find(*key)]
        return list({(section.file, section.line): section for section in found}.values())

    def _read(self, file: str, line: int, chunk: str, within: tuple[str, ...]) -> VocabularySection:
        rows = chunk.split("\n")
        settings, own = read_section(file, line, rows)
        sites: dict[str, Site] = {}
        for name in settings.get("with", "").split():
            sites |= {site.path: site for site in self._block(f"{file}:{line}", name, within)}
        header = read_header(f"{file}:{line}", rows[0])
        sites |= {
            site.path if self.release else key: site
            for key, site in own.items()
            if self._is_here(site.releases)
        }
        return assemble(file, line, header, settings, list(sites.values()))

    def _block(self, place: str, name: str, within: tuple[str, ...]) -> tuple[Site, ...]:
        if name in within:
            raise VocabularyError(f"{place}: with: {name}: [block {name}] includes itself")
        if not self.has("block", name):
            raise VocabularyError(f"{place}: with: {name}: there is no [block {name}]")
        found = self._find(("block", name), (*within, name))
        return found[0].sites if found else ()


def _released(chunk: str) -> str:
    """The release words of a section that is not read yet; wrong ones are found when it is."""
    words = next((row.strip() for row in _set(chunk, "releases")), "")
    return words if words and is_release_words(words) else ""


def _is_of_ros_1(chunk: str) -> bool:
    return " 1" in _set(chunk, "ros")


def _set(chunk: str, name: str) -> list[str]:
    """What a setting is set to in a section that is not read yet, row by row."""
    return [it.partition("\n")[0] for it in chunk.split(f"\n{name}:")[1:]]


@lru_cache(maxsize=8)
def load_vocabulary(extra: tuple[str, ...], release: str, *, packages: bool = True) -> Vocabulary:
    """The built-in vocabulary, that of installed ``packages``, and the files named in ``extra``, as far
    as they hold in a ``release``; with an empty one all of it, which no document can be read with.

    Raises VocabularyError, naming file and line, for a mistake: at once in what is not built in,
    else in a section that is used.
    """
    builtin = sorted(name for name in os.listdir(HERE) if name.endswith(".vocab"))
    more = _more(extra, packages, builtin)
    texts = {name: _text(name, f"{HERE}/{name}") for name in builtin}
    try:
        texts |= {name: _text(name, path) for name, path in more.items()}
        vocabulary = Vocabulary(texts, release, bool(more))
        vocabulary.sections_in(more)
    except VocabularyError as error:
        raise VocabularyError(f"{error}{advice(str(error)) if packages else ''}") from None
    return vocabulary


def _more(extra: tuple[str, ...], packages: bool, builtin: Sequence[str]) -> dict[str, str]:
    """Name in messages -> path of the files beside the built-in ones, each file once."""
    named = {file.name: file.path for file in (installed() if packages else ())}
    # A user's file may be called like a built-in one.
    named |= {os.path.join(".", path) if path in builtin else path: path for path in extra}
    first: dict[str, str] = {}
    for name, path in named.items():
        first.setdefault(os.path.realpath(path), name)
    return {name: named[name] for name in first.values()}


def _text(name: str, path: str) -> str:
    try:
        return read_text(path)
    except OSError as error:
        raise VocabularyError(f"{name}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise VocabularyError(
            f"{name}: cannot be read: it is not UTF-8; save it as UTF-8"
        ) from None


def check_vocabulary(vocabulary: Vocabulary) -> list[VocabularySection]:
    """Parse every section; raises VocabularyError for the first mistake."""
    return vocabulary.sections(*TYPES)
