"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from setuptools import find_packages, setup

PACKAGE = "arm_node"
REQUIREMENTS = [
    "PyYAML>=6.0",
    "numpy>=2",
    "ros-jazzy-common-interfaces==5.3.6",
    "ros-jazzy-rclpy[fastrtps]==7.1.6",
]

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    package_data={"arm_node": ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
    ],
    install_requires=[
        "setuptools",
        *REQUIREMENTS,
    ],
    zip_safe=True,
    description=(
        "What every node process of the arm suite shares: environment, start and orderly "
        "end of rclpy, logging, parameters."
    ),
    license="Apache-2.0",
    entry_points={
        "console_scripts": [],
        "launch_py.preloads": [
            "lazy_messages = arm_node.workarounds.lazy_messages:import_messages_lazily",
            "plain_programs = arm_node.workarounds.plain_programs:reach_first_node",
        ],
    },
)
