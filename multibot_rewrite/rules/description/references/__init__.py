"""MB2: names that nothing declares, or that are declared twice."""

from multibot_rewrite.rules.description.references import (
    control,
    controllers,
    duplicates,
    frames,
    gazebo,
    interfaces,
    simulated,
    transforms,
    undeclared,
)

THEMES = (
    undeclared,
    frames,
    duplicates,
    gazebo,
    control,
    controllers,
    interfaces,
    simulated,
    transforms,
)
