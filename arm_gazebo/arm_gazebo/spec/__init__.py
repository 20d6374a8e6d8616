"""Shared by all code that writes a MuJoCo specification: names, report, sizes, timing."""
