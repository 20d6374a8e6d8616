"""ros2_control in Python: hardware interface, controller manager, controllers and spawner."""
