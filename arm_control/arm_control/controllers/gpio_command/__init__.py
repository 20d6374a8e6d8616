"""gpio_controllers/GpioCommandController: commands GPIOs and publishes their states."""
