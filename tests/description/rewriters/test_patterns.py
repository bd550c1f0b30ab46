# SPDX-License-Identifier: Apache-2.0
"""Regular expressions of a file: what std::regex matches, in a time that every name allows."""

from __future__ import annotations

import random
import shutil
import string
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from counted_steps import growth
from paths import fixture_text

from multibot_rewrite.description.rewriters.patterns import Pattern, PatternError

LETTERS = string.ascii_letters + string.digits + "_"
GXX = shutil.which("g++")
REFEREE = fixture_text("patterns_referee.txt")


def test_a_letter_digit_or_underscore_means_itself() -> None:
    for it in LETTERS:
        pattern = Pattern(f"a(b{it}c|d)")
        assert pattern.matches(f"ab{it}c") and pattern.matches("ad")
        assert not pattern.matches(f"ab{it}") and not pattern.matches("abc")


@pytest.mark.parametrize(
    ("pattern", "yes", "no"),
    [
        (".*_wheel", ("left_wheel", "_wheel"), ("wheel", "left_wheel_2", "a\n_wheel")),
        ("(left|right)_(wheel|arm)", ("left_arm", "right_wheel"), ("left_", "leftright_arm")),
        ("(?:left|right)_arm", ("left_arm",), ("arm",)),
        ("joint_[0-9]+", ("joint_0", "joint_17"), ("joint_", "joint_x")),
        ("joint_\\d{2,3}", ("joint_12", "joint_123"), ("joint_1", "joint_1234")),
        ("joint_[[:alpha:]]{2}", ("joint_ab",), ("joint_a1", "joint_a")),
        ("a{0,2}b{1,}", ("b", "aabbb"), ("aaab", "aa")),
        ("[^|]l", ("fl",), ("|l",)),
        ("[a\\-c]", ("-", "a", "c"), ("b",)),
        ("[]a]", (), ("a", "]", "a]")),
        ("a|", ("a", ""), ("b",)),
        ("(^a|b)$", ("a", "b"), ("ab",)),
        ("a+?b*?", ("a", "aab"), ("b",)),
        ("\\x61\\u0062\\.", ("ab.",), ("abc",)),
        # ECMA-262: a dot is no end of a line; a range has both its ends.
        (".", ("a", "\t"), ("\n", "\r")),
        ("[a-c]", ("a", "b", "c"), ("d", "-")),
        ("[a-a]", ("a",), ("b",)),
        # A letter beyond ASCII is two bytes.
        ("..", ("é", "ab"), ("éé",)),
    ],
)
def test_it_matches_whole_names(pattern: str, yes: tuple[str, ...], no: tuple[str, ...]) -> None:
    it = Pattern(pattern)
    assert [name for name in (*yes, *no) if it.matches(name)] == [*yes]


# C++ [re.grammar] and ECMA-262: what each class has, and a character that it has not.
CLASSES = {
    "alpha": ("aZ", "1"), "digit": ("09", "a"), "d": ("09", "a"), "alnum": ("aZ9", "_"),
    "lower": ("az", "A"), "upper": ("AZ", "a"), "punct": ("._-", "a"), "xdigit": ("aF9", "g"),
    "space": (" \t\n", "a"), "s": (" \t\n", "a"), "blank": (" \t", "\n"), "w": ("aZ9_", "-"),
}  # fmt: skip


def test_each_class_has_its_characters() -> None:
    for name, (inside, outside) in CLASSES.items():
        whole = Pattern(f"[[:{name}:]]")
        assert [it for it in inside + outside if whole.matches(it)] == [*inside], name
    for name in ("d", "w", "s"):
        whole, other = Pattern(f"\\{name}"), CLASSES[name][1]
        assert [it for it in CLASSES[name][0] + other if whole.matches(it)] == [*CLASSES[name][0]]
        assert Pattern(f"\\{name.upper()}").matches(other)
    for name, character in (("n", "\n"), ("t", "\t"), ("r", "\r"), ("f", "\f"), ("v", "\v")):
        assert Pattern(f"\\{name}").matches(character)
        assert not Pattern(f"\\{name}").matches("x")
    assert Pattern("\\0").matches("\0") and not Pattern("\\0").matches("0")
    for name in "123456789bBcxu":
        with pytest.raises(PatternError):
            Pattern(f"a\\{name}")


@pytest.mark.parametrize(
    "pattern",
    [
        "*",
        "(a",
        "a)",
        "[a",
        "a{2,1}",
        "a{",
        "a{99999999}",
        "^*",
        "[b-a]",
        "[[:foo:]]",
        "\\",
        "(a)\\1",
        "a\\b",
        "(?=a)",
        "(?!a)",
        "((((a{9}){9}){9}){9}){9}",
        "(" * 40 + "a" + ")" * 40,
        "a" * 501,
    ],
)
def test_what_is_no_pattern_or_too_large_is_refused(pattern: str) -> None:
    with pytest.raises(PatternError):
        Pattern(pattern)


HARD = ("(a+)+c", "(a|a)*c", "(a*)*c", "(a*a*a*a*a*a*)c", "(.*.*.*.*.*)+c", "(a|a)(a|a)" * 20 + "c")


@pytest.mark.parametrize("pattern", HARD)
def test_a_name_takes_as_long_as_it_has_letters(pattern: str) -> None:
    def prepared(letters: int) -> Callable[[], object]:
        return lambda: Pattern(pattern).matches("a" * letters)

    assert growth(prepared, 500, 2_000) < 1.1


ATOMS = (
    *"abc_1./-]}",
    *(".", "[ab]", "[^a]", "[a-c]", "[[:alpha:]]", "[[:digit:]_]", "\\d", "\\w", "\\s", "\\W"),
    *("\\.", "\\x61", "\\u0062", "[\\d_]", "[a\\-c]", "[]", "[^]", "[a-]", "[-a]", "^", "$", "é"),
    *("[b-a]", "[[:foo:]]", "\\q", "[^\\d]", "[.]", "\\0", "[a-c-e]", "(?:a)", "[*]"),
)
COUNTS = ("", "", "", "", "*", "+", "?", "{2}", "{1,}", "{0,2}", "*?", "{2}?", "{,2}", "{2,1}")


def made(rng: random.Random, depth: int = 1) -> str:
    """Return a pattern, perhaps a faulty one."""

    def piece() -> str:
        way = rng.random()
        if depth and way < 0.25:
            return f"({made(rng, depth - 1)})"
        if depth and way < 0.35:
            return f"{made(rng, depth - 1)}|{made(rng, depth - 1)}"
        return rng.choice(ATOMS)

    return "".join(piece() + rng.choice(COUNTS) for _ in range(rng.randint(1, 3)))


def verdict(pattern: str, name: str) -> str:
    try:
        return str(int(Pattern(pattern).matches(name)))
    except PatternError:
        return "error"


@pytest.mark.deep
@pytest.mark.skipif(GXX is None, reason="g++ is missing: apt install g++")
def test_it_agrees_with_std_regex(tmp_path: Path) -> None:
    (tmp_path / "referee.cc").write_text(REFEREE)
    subprocess.run([str(GXX), "-o", "referee", "referee.cc"], cwd=tmp_path, check=True, timeout=120)
    rng = random.Random(13)
    pairs = [
        (pattern, "".join(rng.choice("abc_1./]}é-") for _ in range(rng.randint(0, 5))))
        for pattern in (made(rng) for _ in range(400))
        for _ in range(3)
    ]
    asked = "".join(f"{pattern}\n{name}\n" for pattern, name in pairs)
    run = subprocess.run(
        [tmp_path / "referee"], input=asked.encode(), capture_output=True, timeout=100, check=True
    )
    said = run.stdout.decode().split()
    found = [(*pair, verdict(*pair)) for pair in pairs]
    assert found == [(*pair, word) for pair, word in zip(pairs, said, strict=True)]
    assert min(said.count(word) for word in ("0", "1", "error")) > 40
