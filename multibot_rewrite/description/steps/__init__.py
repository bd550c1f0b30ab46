"""The steps of a rewrite, one module each: document, collect, plan, apply, verify."""
