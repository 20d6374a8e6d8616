"""The installed message, service and action types, and their definitions."""
