"""Controllers that pass the latest command on to the hardware."""
