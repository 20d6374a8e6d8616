"""For colcon, which asks ament_python packages for a setup.py; pyproject.toml says everything."""

from setuptools import setup

setup()
