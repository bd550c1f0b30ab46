# SPDX-License-Identifier: Apache-2.0
"""What was probably meant by an unknown option."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.nearest import CHOICE, extensions, nearest, other_words, typing_mistakes
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.cli.declared.commands import COMMANDS, PROGRAMS

# A beginning of so few letters says nothing.
_BEGUN = 2


def option_hint(wrong: str, command: str, known: Collection[str], has_fleet: bool) -> str:
    """Return what to write in place of an unknown option, behind a semicolon; "" if nothing is known.

    What its name means in other tools and earlier versions comes first, then an option of this command
    that begins with it, a key of the fleet file, an option of another command, and one that it is but
    for a typing mistake or two: of this command, or one that has a meaning itself.
    """
    if meant := _hint_for(wrong, command, known, has_fleet):
        return f"; {meant}"
    near = _nearest_option(wrong, known)
    if near and near not in known:
        return f"; {_hint_for(near, command, known, has_fleet, near)}"
    return f"; did you mean '{near}'?" if near else ""


def _hint_for(
    option: str, command: str, known: Collection[str], has_fleet: bool, name: str = "it"
) -> str:
    """Return a hint for an unknown option, called ``name``: what does the same; "" for none."""
    word = f"-{option.removeprefix('-').replace('_', '-')}"
    if own := other_words("options").get(f"{command} {word}"):
        return f"use {own}"
    other = other_words("options").get(word, "")
    first_word = other.replace(",", "").partition(" ")[0]
    meant = first_word if first_word.startswith("-") else ""
    if meant in known:
        return f"use {other}"
    bare = option.lstrip("-")
    begun = (it for it in known if len(bare) > _BEGUN and it.startswith(f"--{bare}"))
    if first := next(begun, ""):
        return f"did you mean '{first}'?"
    if has_fleet and (keys := _fleet_keys(option) or _fleet_keys(meant)):
        return f"write the key {' or '.join(f'{it}:' for it in keys)} into the fleet file"
    if meant:
        return f"{meant} does that, which {_commands_with(meant)}"
    takers = _commands_with(option)
    return f"use {other}" if other else takers and f"{takers} {name}"


def _fleet_keys(wrong: str) -> list[str]:
    """Return the keys of a fleet file that an option may mean, equal or with that beginning."""
    from multibot_rewrite.fleet.file.fleet_data import schema

    word = wrong.lstrip("-").replace("-", "_")
    top = schema()["properties"]
    key = word if word in top else other_words("keys").get(word, word)
    return [key] if key in top else extensions(key, top)


def _nearest_option(wrong: str, known: Collection[str]) -> str:
    """Return the option that was probably meant, or ""."""
    # It is an own one that is a part of the word (output-format: format), or is it but for two
    # typing mistakes, or another that begins with it or like it, but for one in three letters; else
    # an own one that is much like it.
    word, found = wrong.lstrip("-"), []
    for option in dict.fromkeys((*known, *other_words("options"), *commands_of())):
        name, is_own = option.lstrip("-"), option in known
        is_begun = len(word) > _BEGUN and name.startswith(word)
        is_part = is_own and name in word.split("-")[1:]
        many = 0 if is_part else 1 if is_begun else typing_mistakes(word, name)
        is_alike = name[0] == word[0] or (is_own and 2 * many < len(name))
        if option.startswith("--") and is_alike and many <= min(2, len(name) // (3 - 2 * is_own)):
            found.append((many, not is_own, option))
    near = nearest(word, sorted(it[2:] for it in known if it.startswith(f"--{word[0]}")), CHOICE)
    return min(found)[2] if found else near and f"--{near}"


def commands_of() -> Mapping[str, Sequence[str]]:
    """Return the commands that have an option, by its name."""
    every = {**PROGRAMS, **{f"multibot {name}": it for name, it in COMMANDS.items()}}
    return lists_by_key(
        (option, name)
        for name, it in every.items()
        for group in it.groups
        for one in group.options
        for option in one.names
    )


def _commands_with(option: str) -> str:
    """Return the commands that have an option, with a verb: ``multibot init takes``; "" if none has."""
    names = commands_of().get(option, ())
    verb = "takes" if len(names) == 1 else "take"
    return f"{shorten(names)} {verb}" if names else ""
