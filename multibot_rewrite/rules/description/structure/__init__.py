# SPDX-License-Identifier: Apache-2.0
"""MB5: the kinematic tree and its joints."""
