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
    [values NAME...]   what plugins or hardware classes of other sections read alike, in ``value``
                       lines alone: whether names are in it nobody has looked

A path is child steps, then ``@attribute`` for an attribute; a step may ask for an attribute:
``param[@name=mimic]``. After the kinds may stand, in this order or another, then ``# a note``:

    form=NAME          where in the value the names are
    default=TEXT       the literal the consumer falls back to; ``topic/../x`` is the value at ``topic``
                       with its last segment replaced; ``a=true,b=?x`` is x where those siblings have
                       these texts; in it ``{model}`` is the name that the spawner gives, ``{link}``
                       the canonical link, ``{sensor}`` the sensor around, ``{topic}`` the text there
    fill=TEXT          what is written in place of a default below ``{model}/``, if not what is behind
    when=SIBLING=TEXT  only where that sibling has this text is it a name of ours
    when=sent          a topic of the world, as its wind, but where something in this file has it, too
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
    form=below       an absolute name, ``/robot/description``: what it is below is the name
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
                           is there on that condition; of what publishes /tf the first frame is the
                           parent, the second the child
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
    helper: NAME           a node of this name beside its own, which only its namespace moves
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
from collections.abc import Sequence
from functools import lru_cache

from multibot_rewrite.base.bounded import read_text
from multibot_rewrite.base.model import VocabularyError
from multibot_rewrite.description.rewriters.vocabulary.grammar import (
    FORMS,
    KINDS,
    TYPES,
    VocabularySection,
    is_step,
    split_path,
    split_step,
)
from multibot_rewrite.description.rewriters.vocabulary.installed import advice, installed
from multibot_rewrite.description.rewriters.vocabulary.library import Vocabulary
from multibot_rewrite.description.rewriters.vocabulary.values import Value, Values

__all__ = [
    "FORMS",
    "KINDS",
    "TYPES",
    "Value",
    "Values",
    "Vocabulary",
    "VocabularySection",
    "advice",
    "check_vocabulary",
    "is_step",
    "load_vocabulary",
    "split_path",
    "split_step",
]
HERE = os.path.dirname(__file__)


@lru_cache(maxsize=16)
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
