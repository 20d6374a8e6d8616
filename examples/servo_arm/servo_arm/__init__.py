"""An example of your own controller and hardware component."""
