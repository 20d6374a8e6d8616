"""Hardware components: the driver interface, their description, limits and resources."""
