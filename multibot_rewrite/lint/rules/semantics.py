"""MB8: an SRDF against its URDF."""

from __future__ import annotations
