"""Faults on demand: things that go wrong in the simulation because a test requests it."""
