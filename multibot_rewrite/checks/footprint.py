"""How far a robot reaches from its root, to the side: of its collisions, else its visuals."""

from __future__ import annotations

from lxml import etree


def reach_of(root: etree._Element) -> float:
    """The radius in metres of the circle around the root link that holds the robot; 0 if unknown."""
    return 0.0
