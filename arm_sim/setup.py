"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "arm_sim"
NEIGHBOURS = [
    "../arm_control",
    "../arm_controller",
    "../arm_description",
    "../arm_gazebo",
    "../arm_node",
    "../arm_planning",
]
REQUIREMENTS = [
    "numpy>=2",
    "opencv-python-headless>=4.9",
    "ros-jazzy-common-interfaces==5.3.6",
    "ros-jazzy-rclpy[fastrtps]==7.1.6",
]

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    package_data={"arm_sim": ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
    ],
    install_requires=[
        "setuptools",
        *REQUIREMENTS,
        *(f"{Path(path).name} @ {Path(path).resolve().as_uri()}" for path in NEIGHBOURS),
    ],
    zip_safe=True,
    description="The simulation as a Python library, without ROS.",
    license="Apache-2.0",
    entry_points={"pytest11": ["arm_sim = arm_sim.pytest_plugin"]},
)
