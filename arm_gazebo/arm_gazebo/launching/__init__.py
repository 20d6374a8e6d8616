"""What launch files need to know before a simulation starts."""
