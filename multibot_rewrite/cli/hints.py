# SPDX-License-Identifier: Apache-2.0
"""What was probably meant by an option that a command does not have."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from multibot_rewrite.base.nearest import CHOICE, extensions, nearest, other_words
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.cli.declared.commands import COMMANDS, PROGRAMS

# A beginning of so few letters says nothing.
_BEGUN = 2


def option_hint(wrong: str, command: str, known: Collection[str], has_fleet: bool) -> str:
    """Return what to write in place of an unknown option, behind a semicolon; "" if nothing is known.

    What its name means in other tools and earlier versions comes first, then an option of this command
    that begins with it, a key of the fleet file, an option of another command, and one of like letters.
    """
    word = f"-{wrong.removeprefix('-').replace('_', '-')}"
    if own := other_words("options").get(f"{command} {word}"):
        return f"; use {own}"
    other = other_words("options").get(word, "")
    first_word = other.replace(",", "").partition(" ")[0]
    meant = first_word if first_word.startswith("-") else ""
    if meant in known:
        return f"; use {other}"
    bare = wrong.lstrip("-")
    begun = (it for it in known if len(bare) > _BEGUN and it.startswith(f"--{bare}"))
    if first := next(begun, ""):
        return f"; did you mean '{first}'?"
    if has_fleet and (keys := _fleet_keys(wrong) or _fleet_keys(meant)):
        return f"; write the key {' or '.join(f'{it}:' for it in keys)} into the fleet file"
    if meant:
        return f"; {meant} does that, which {_takers(meant)}"
    return f"; use {other}" if other else "".join(f"; {it}" for it in _by_letters(wrong, known))


def _fleet_keys(wrong: str) -> list[str]:
    """Return the keys of a fleet file that the option may mean: one, those that begin so, or none."""
    from multibot_rewrite.fleet.file.fleet_data import schema

    word = wrong.lstrip("-").replace("-", "_")
    top = schema()["properties"]
    key = word if word in top else other_words("keys").get(word, word)
    return [key] if key in top else extensions(key, top)


def _by_letters(wrong: str, known: Collection[str]) -> Iterator[str]:
    """Yield the commands that have the option, and the command's own one that is most like it."""
    if takers := _takers(wrong):
        yield f"{takers} it"
    if near := _nearest(wrong.lstrip("-"), known):
        yield f"did you mean '{near}'?"


def _nearest(word: str, known: Iterable[str]) -> str:
    """Return the known option that is a part of the word (output-format: format), or is written
    like it and begins with the same letter; "" if none does."""
    # Dashes are in all of them: compared with these, every short word is like every other.
    full = {name.lstrip("-"): name for name in known if name.startswith("--")}
    parts = (it for it in reversed(word.split("-")) if it in full)
    alike = sorted(it for it in full if it[:1] == word[:1])
    return full.get(next(parts, "") or nearest(word, alike, CHOICE), "")


def _takers(option: str) -> str:
    """Return the commands that have an option, with a verb: ``multibot init takes``; "" if none has."""
    every = {**PROGRAMS, **{f"multibot {name}": it for name, it in COMMANDS.items()}}
    options = {name: [one for of in it.groups for one in of.options] for name, it in every.items()}
    names = [name for name, own in options.items() if any(option in it.names for it in own)]
    verb = "takes" if len(names) == 1 else "take"
    return f"{shorten(names)} {verb}" if names else ""
