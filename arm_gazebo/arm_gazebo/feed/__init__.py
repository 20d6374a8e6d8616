"""States of the simulation, on their way to child processes that draw them."""
