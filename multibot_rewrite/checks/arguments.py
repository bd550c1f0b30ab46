"""References that a xacro's own arguments miss: the author's prefix is on a link, and not on them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from multibot_rewrite.checks.problem import Problem, about
from multibot_rewrite.findings.finding import WARNING
from multibot_rewrite.findings.rule import XACRO, declare
from multibot_rewrite.naming import FRAME_KINDS
from multibot_rewrite.steps.collect import Inventory

_HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
_BODY = """\
  <xacro:arg name="prefix" default=""/>
  <link name="$(arg prefix)base_link"/>
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_diff_drive.so">
      <robot_base_frame>{}base_link</robot_base_frame>
    </plugin>
  </gazebo>
</robot>
"""
ARGUMENT_MISSES_REFERENCE = declare(
    "MB143",
    "argument-misses-reference",
    WARNING,
    what="A frame is the name of a link without the prefix that an argument of the xacro gives to the "
    "link.",
    why="The link has the robot's name by the argument, the frame gets it by the rewrite: the two "
    "differ, and every look-up of the frame fails.",
    fix="Write the argument there, too, or do not give it: the rewrite names all links and frames.",
    bad=_HEAD + _BODY.format(""),
    good=_HEAD + _BODY.format("$(arg prefix)"),
    # In the expansion, below the comment that xacro writes.
    line=10,
    formats=("rewrite", XACRO),
    options={"xacro_args": {"prefix": "{robot}_"}},
)


def missed_by_arguments(
    inventory: Inventory, plain: Mapping[tuple[str, str], str]
) -> Iterator[Problem]:
    """``plain`` maps names without the arguments (kind and text) to those with them."""
    links = inventory.declared["link"]
    pairs = zip(inventory.claims, inventory.names, strict=True) if plain else ()
    for claim, names in pairs:
        for name in names:
            own = plain.get(("link", name.text.removeprefix("/")))
            if own and name.kind in FRAME_KINDS and name.text not in links and own in links:
                message = f"frame {name.text!r} is the link {own!r}: the argument is missing here"
                hint = "write the argument of the xacro here, too, or do not give it"
                yield about(claim, ARGUMENT_MISSES_REFERENCE.code, message, hint)
