# SPDX-License-Identifier: Apache-2.0
"""What is said of errors that a launch file raises: whose fault it is, and what to do."""

from __future__ import annotations

from linecache import cache

import pytest

from multibot_rewrite import InputError
from multibot_rewrite.producers.launch.failures import (
    failure,
    is_certain,
    is_no_text,
    is_of_file,
    lost_file,
)

UNSET = (
    "the launch configuration 'a.b' is not set; give it with a.b:=VALUE, or where this is included"
)


def caused(error: BaseException, cause: BaseException) -> BaseException:
    error.__cause__ = cause
    return error


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (RuntimeError("launch configuration 'a.b' does not exist"), UNSET),
        (RuntimeError('Required launch argument "a.b" was not provided'), UNSET),
        (RecursionError("x"), "it includes or calls itself without an end"),
        (FileNotFoundError(2, "x", "gazebo"),
         "it starts the program 'gazebo' itself, which is not installed here"),
        (AttributeError("x", name="generate_launch_description"),
         "it has no function generate_launch_description(): write one that returns a"
         " LaunchDescription"),
        (SystemExit(3),
         "it ends itself (sys.exit(3)); give it the arguments that it reads from the command line"
         " (NAME:=VALUE)"),
        (ValueError("two\n lines"), "ValueError: two lines"),
        (MemoryError(),
         "it needs more memory than it gets; give --trust if you trust it (SECURITY.md)"),
        (InputError("a.yaml:1:2: it is wrong; correct it"), "a.yaml:1:2: it is wrong; correct it"),
        (FileNotFoundError(2, "No such file", "/a/../b.yaml"),
         "FileNotFoundError: [Errno 2] No such file: '/b.yaml'"),
        (RuntimeError("Unrecognized entity of the type: rosparam"),
         "RuntimeError: Unrecognized entity of the type: rosparam; it is a launch file of ROS 1; in"
         " ROS 2 it is $(find-pkg-share NAME), $(var NAME), exec="),
    ],
)  # fmt: skip
def test_an_error_is_one_line_with_what_to_do(error: BaseException, said: str) -> None:
    assert failure(error) == said


@pytest.mark.parametrize(
    ("error", "of_file"),
    [
        (SyntaxError("x"), True), (NameError("x"), True), (RecursionError("x"), True),
        (FileNotFoundError("x"), True), (SystemExit(1), True), (ValueError("x"), False),
        (MemoryError(), True), (InputError("a.yaml:1:2: x"), True),
        (caused(RuntimeError("x"), NameError("y")), True),
        (caused(NameError("x"), ValueError("y")), False),
        (RuntimeError("Unknown substitution: arg"), True),
        (RuntimeError("Unknown substitution: args"), False),
        (AttributeError("x", name="y", obj=1), False),
    ],
)  # fmt: skip
def test_what_launch_does_not_read_either(error: BaseException, of_file: bool) -> None:
    assert is_of_file(error) is of_file


def test_a_file_that_is_lost_is_to_be_put_there() -> None:
    put = "; put it there, or source the built workspace that has it"
    lost = FileNotFoundError("x")
    assert lost_file(lost) == lost_file(caused(RuntimeError("x"), lost)) == put
    assert lost_file(ValueError("x")) == ""


def raised(text: str, file: str) -> BaseException:
    """Return what a program of that name raises."""
    cache[file] = (len(text), None, text.splitlines(keepends=True), file)
    try:
        exec(compile(text, file, "exec"), {})
    except Exception as error:
        return error
    raise AssertionError("nothing is raised")


@pytest.mark.parametrize(
    ("text", "file", "certain"),
    [
        ("raise ValueError('x')", "a.launch.py", True), ("raise ValueError('x')", "a.py", False),
        ("1 / 0", "a.launch.py", True), ("nowhere", "a.launch.py", True),
        ("{}['MODEL']", "a.launch.py", True), ("assert 1 > 2", "a.launch.py", True),
        ("class E(Exception): pass\nraise E('x')", "a.launch.py", True),
        ("launch_configurations = {}\nlaunch_configurations['x']", "a.launch.py", False),
        ("raise OSError('x')", "a.launch.py", False), ("[][0]", "a.launch.py", False),
        ("raise ValueError('no /dev/ttyUSB0')", "a.launch.py", False),
        ("raise RuntimeError('a missing required argument x')", "a.py", True),
        ("raise TypeError('Failed to normalize given item of type')", "a.py", True),
        ("raise RecursionError('x')", "a.py", True),
    ],
)  # fmt: skip
def test_what_fails_on_every_machine(text: str, file: str, certain: bool) -> None:
    assert is_certain(raised(text, file), "/ws/a.launch.py") is certain


def test_what_is_no_text() -> None:
    assert is_no_text(TypeError("Failed to normalize given item of type 'x'"))
    assert not is_no_text(ValueError("Failed to normalize given item"))
    assert not is_no_text(TypeError("x"))
