"""The test bench: what the pytest plugin `arm_sim.pytest_plugin` gives to tests."""
