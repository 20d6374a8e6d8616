"""Process supervisor and launch files in Python: starts when ready, restarts with back-off, stops everything."""
