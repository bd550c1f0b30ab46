# SPDX-License-Identifier: Apache-2.0
"""The JSON schemas of files that people edit, made of the records and keys of their readers."""
