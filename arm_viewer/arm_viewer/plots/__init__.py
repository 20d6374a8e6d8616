"""Curves of numbers in messages: what is kept of them, and which numbers a message has."""
