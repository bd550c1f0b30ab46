# SPDX-License-Identifier: Apache-2.0
"""A fleet and all that is built of it, asked what is wrong."""
