"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "arm_drivers"
NEIGHBOURS = ["../arm_control", "../arm_node"]
REQUIREMENTS = ["numpy>=2", "pyserial>=3.5,<4"]

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    package_data={"arm_drivers": ["py.typed"]},
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
    description="Hardware plugins of real arms: Feetech's STS servos and the myCobot 280.",
    license="Apache-2.0",
    entry_points={
        "arm_control.controllers": [
            "arm_drivers/LeaderFollowerController = "
            "arm_drivers.leader_follower:LeaderFollowerController",
        ],
        "arm_control.hardware": [
            "arm_drivers/Feetech = arm_drivers.feetech.hardware:FeetechHardware",
            "arm_drivers/MyCobot280 = arm_drivers.mycobot.hardware:MyCobotHardware",
        ],
    },
)
