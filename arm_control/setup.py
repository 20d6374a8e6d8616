"""Installs this folder as an ament_python package, for colcon; pip uses the root pyproject.toml."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "arm_control"
DATA_FOLDERS = ["config", "launch"]
DATA_FILES = [path for folder in DATA_FOLDERS for path in Path(folder).rglob("*") if path.is_file()]

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        *((f"share/{PACKAGE}/{path.parent}", [str(path)]) for path in DATA_FILES),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    description=(
        "ros2_control in Python: hardware interface, controller manager, controllers and spawner."
    ),
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "ros2_control_node = arm_control.ros2_control_node:main",
            "spawner = arm_control.spawner_node:main",
            "unspawner = arm_control.unspawner_node:main",
            "hardware_spawner = arm_control.hardware_spawner_node:main",
        ],
        "launch_py.packages": [
            "controller_manager = arm_control",
        ],
    },
)
