"""The state of controllers and drivers as plain values, and its bytes."""
