"""The packages and programs on this machine, and the environment of launched processes."""
