"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from pathlib import Path

from setuptools import setup

PACKAGE = "mycobot_ros2"
NEIGHBOURS = [
    "../mycobot_bringup",
    "../mycobot_description",
    "../mycobot_gazebo",
    "../mycobot_moveit_config",
    "../mycobot_moveit_demos",
    "../mycobot_mtc_demos",
    "../mycobot_mtc_pick_place_demo",
    "../mycobot_system_tests",
]

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
    description="Everything about the myCobot 280: the packages that this one depends on.",
    license="Apache-2.0",
)
