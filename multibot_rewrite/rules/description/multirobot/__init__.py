"""MB4: what goes wrong when a second robot uses the same description."""

from multibot_rewrite.rules.description.multirobot import (
    frames,
    meeting,
    model_namespaces,
    named_robots,
    namespaces,
    prefixes,
    resources,
    topics,
)

THEMES = (topics, namespaces, model_namespaces, frames, resources, prefixes, named_robots, meeting)
