"""The arm command."""
