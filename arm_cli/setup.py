"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "arm_cli"
NEIGHBOURS = [
    "../arm_control",
    "../arm_description",
    "../arm_drivers",
    "../arm_gazebo",
    "../arm_node",
    "../arm_planning",
    "../arm_sim",
    "../arm_viewer",
    "../launch_py",
]
REQUIREMENTS = [
    "PyYAML>=6.0",
    "argcomplete>=3.5",
    "mcap>=1.6,<2",
    "numpy>=2",
    "opencv-python-headless>=4.9",
    "rich>=13",
    "ros-jazzy-common-interfaces==5.3.6",
    "ros-jazzy-rclpy[fastrtps]==7.1.6",
    "zstandard>=0.22",
]
DATA_FOLDERS = ["config"]
DATA_FILES = [
    path
    for folder in DATA_FOLDERS
    for path in Path(folder).rglob("*")
    if path.is_file() and path.suffix != ".pyc"
]

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        (
            "share/ament_index/resource_index/executable_stand_ins",
            [f"resource/executable_stand_ins/{PACKAGE}"],
        ),
        *((f"share/{PACKAGE}/{path.parent}", [str(path)]) for path in DATA_FILES),
    ],
    install_requires=[
        "setuptools",
        *REQUIREMENTS,
        *(f"{Path(path).name} @ {Path(path).resolve().as_uri()}" for path in NEIGHBOURS),
    ],
    zip_safe=True,
    description="The arm command.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": ["arm = arm_cli.main:run"],
        "launch_py.programs": ["gz = arm_cli.main:gz", "ign = arm_cli.main:gz"],
    },
)
