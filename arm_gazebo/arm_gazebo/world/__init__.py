"""The running world: its entities, and changes to it."""
