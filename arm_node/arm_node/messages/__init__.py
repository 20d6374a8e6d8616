"""Converts messages to text and text to messages."""
