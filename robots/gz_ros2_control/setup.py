"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from pathlib import Path

from setuptools import setup

PACKAGE = "gz_ros2_control"
NEIGHBOURS = ["../../arm_gazebo"]

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=[],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
    ],
    install_requires=[
        "setuptools",
        *(f"{Path(path).name} @ {Path(path).resolve().as_uri()}" for path in NEIGHBOURS),
    ],
    zip_safe=True,
    description="Gazebo's plugin: here arm_gazebo reads a robot's ros2_control block itself.",
    license="Apache-2.0",
)
