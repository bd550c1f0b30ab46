# SPDX-License-Identifier: Apache-2.0
"""MB4: what goes wrong when a second robot uses the same description."""

# The files of its rules, loaded where they are asked.
THEMES = (
    ".topics",
    ".namespaces",
    ".frames",
    ".resources",
    ".prefixes",
    ".named_robots",
)
# The same, of rules that find nothing where no robots are named.
OF_ROBOTS = (".meeting",)
