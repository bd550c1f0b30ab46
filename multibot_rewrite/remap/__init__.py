"""Remap tables: what every node of every robot must be told, as data, in the forms people use."""
