"""Forms for calls: from the type of a message to what is typed, and back to a message."""
