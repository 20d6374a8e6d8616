"""Makes a trajectory of a path within the limits of the joints."""
