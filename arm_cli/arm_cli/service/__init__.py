"""`arm service call` and `arm service echo`."""
