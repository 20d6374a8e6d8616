"""The viewer window, which runs in a separate process."""
