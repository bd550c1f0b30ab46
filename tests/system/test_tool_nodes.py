# SPDX-License-Identifier: Apache-2.0
"""Which nodes are none of a robot's, by name."""

from __future__ import annotations

import pytest

from multibot_rewrite.system import words


@pytest.mark.parametrize(
    ("node", "more", "tool"),
    [
        ("/a/rviz2", (), True),
        ("/a/driver", (), False),
        # Without a slash a pattern is of any namespace, with one of the full name.
        ("/a/driver", ("driver",), True),
        ("/a/driver", ("dri*",), True),
        ("/a/driver", ("/a/*",), True),
        ("/a/driver", ("/b/*", "/a/driver"), True),
        ("/a/driver", ("/driver",), False),
        ("/a/driver", ("a*",), False),
        ("/a/driver", ("other", "/b/*"), False),
    ],
)
def test_a_tool_is_known_by_its_word_or_by_a_pattern(
    node: str, more: tuple[str, ...], tool: bool
) -> None:
    assert words.is_tool(node, more) is tool


@pytest.mark.parametrize(
    ("node", "viewer", "hidden", "spawner"),
    [
        ("/a/rviz2", True, False, False),
        ("/_ros2cli_12", True, True, False),
        ("/a/_hidden", False, True, False),
        ("/_a/driver", False, False, False),
        ("/a/spawner_arm", True, False, True),
        ("/spawner_a/arm", False, False, False),
    ],
)
def test_what_the_last_word_says(node: str, viewer: bool, hidden: bool, spawner: bool) -> None:
    said = (words.is_viewer(node), words.is_hidden(node), words.is_spawner(node))
    assert said == (viewer, hidden, spawner)


@pytest.mark.parametrize(
    ("node", "name", "above"),
    [
        ("/a/b/driver", "/a/b/scan", ["/a/scan", "/scan"]),
        ("/a/driver", "/a/x/scan", ["/x/scan"]),
        ("/a/driver", "/b/scan", []),
        ("/driver", "/scan", []),
    ],
)
def test_a_name_moved_to_the_namespaces_above(node: str, name: str, above: list[str]) -> None:
    assert list(words.in_namespaces_above(node, name)) == above
