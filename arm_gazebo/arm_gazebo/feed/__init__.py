"""Send states of the simulation to the child processes that draw them."""
