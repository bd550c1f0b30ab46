# SPDX-License-Identifier: Apache-2.0
"""Where a system is read from: one module or folder a source."""
