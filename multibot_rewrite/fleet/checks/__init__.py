# SPDX-License-Identifier: Apache-2.0
"""What was made is asked whether it fits together."""
