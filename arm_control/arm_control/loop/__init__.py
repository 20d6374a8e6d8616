"""The control loop: one thread at a steady rate, its clock, its priority and its records."""
