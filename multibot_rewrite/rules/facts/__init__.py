# SPDX-License-Identifier: Apache-2.0
"""What rules read of a document: links and joints, elements by tag, numbers, values before xacro."""
