"""Recordings of runs: inputs and states, written while a run goes on, and run again later."""
