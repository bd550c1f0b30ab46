# SPDX-License-Identifier: Apache-2.0
"""What nodes of packages do by their source: read as text, nothing of it is imported or run."""
