"""The complete state of a run: saved, restored, compared, reset."""
