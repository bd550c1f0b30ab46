# SPDX-License-Identifier: Apache-2.0
"""Pictures of a checked graph: a scene is made of plan, snapshot and findings, then drawn."""
