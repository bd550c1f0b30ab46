# SPDX-License-Identifier: Apache-2.0
"""What a robot's own files say of the nodes that it runs: facts with file and line."""
