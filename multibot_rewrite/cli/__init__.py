# SPDX-License-Identifier: Apache-2.0
"""The commands: one file each. They read, call the library, print and write; they decide nothing."""
