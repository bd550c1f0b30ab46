"""MB4: what the second robot of a system will stumble over."""

from __future__ import annotations
