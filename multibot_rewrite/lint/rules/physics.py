"""MB6: mass and inertia."""

from __future__ import annotations
