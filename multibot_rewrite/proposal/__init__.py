# SPDX-License-Identifier: Apache-2.0
"""A first fleet file for descriptions: what is next to them, what they are, what follows from it."""
