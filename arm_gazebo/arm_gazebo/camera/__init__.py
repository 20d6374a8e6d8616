"""The cameras' pictures, made in a process of their own, and what feeds it."""
