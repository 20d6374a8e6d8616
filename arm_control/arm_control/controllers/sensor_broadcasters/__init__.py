"""Broadcasters of IMU and force-torque sensor readings."""
