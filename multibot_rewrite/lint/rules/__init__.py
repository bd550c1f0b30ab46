"""The rules: one module a group, one function a rule, its words and examples above it."""
