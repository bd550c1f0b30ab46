"""MB2: names that lead nowhere, or to two things."""

from __future__ import annotations
