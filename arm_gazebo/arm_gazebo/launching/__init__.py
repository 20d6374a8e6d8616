"""What launch files read and prepare before a simulation starts."""
