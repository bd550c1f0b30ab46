"""MB1: what a file is, how it is encoded, the shape of its XML, and the values in it."""

from multibot_rewrite.rules.description import gazebo
from multibot_rewrite.rules.description.files import (
    given_arguments,
    materials,
    reading,
    shape,
    text,
    values,
    versions,
)

THEMES = (reading, shape, values, versions, materials, text, given_arguments, *gazebo.THEMES)
