"""MuJoCo's XML and its specification: unique names, files referred to, memory, dry friction."""
