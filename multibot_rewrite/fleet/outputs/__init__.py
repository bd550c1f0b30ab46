# SPDX-License-Identifier: Apache-2.0
"""The files of a built fleet, one module a file."""
