# SPDX-License-Identifier: Apache-2.0
"""Reference pages made of what the package knows: the site has them, the repository does not.

``every.py`` has all of them.
"""
