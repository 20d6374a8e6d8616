"""Executes a plan: starts processes, checks readiness, restarts, handles signals, shuts down."""
