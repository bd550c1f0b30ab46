"""MB1: what a file is, how it is encoded, and the shape of its XML."""

from multibot_rewrite.lint.rules.files import (
    given_arguments,
    materials,
    reading,
    shape,
    text,
    values,
    versions,
)

THEMES = (reading, shape, values, versions, materials, text, given_arguments)
