# SPDX-License-Identifier: Apache-2.0
"""The second reading: a description as the programs that load it read it, and what they run.

It shares no reader with the rewrite. What plugins mean is in the plugin definitions, the one table
of both."""
