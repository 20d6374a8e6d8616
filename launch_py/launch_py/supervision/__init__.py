"""Carries out a plan: processes, signals, readiness, restarts, the end of everything."""
