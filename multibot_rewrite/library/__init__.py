# SPDX-License-Identifier: Apache-2.0
"""What scripts call, and the commands: a file rewritten, a fleet loaded, a system read and judged."""
