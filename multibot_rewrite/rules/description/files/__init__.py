# SPDX-License-Identifier: Apache-2.0
"""MB1: what a file is, how it is encoded, the shape of its XML, and the values in it."""
