"""The controller manager: it loads, switches and updates controllers over the hardware."""
