"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "arm_viewer"
NEIGHBOURS = ["../arm_description", "../arm_node", "../arm_planning"]
REQUIREMENTS = [
    "PyYAML>=6.0",
    "mcap>=1.6,<2",
    "networkx>=3",
    "numpy>=2",
    "opencv-python-headless>=4.9",
    "pycollada>=0.8",
    "rich>=13",
    "ros-jazzy-common-interfaces==5.3.6",
    "ros-jazzy-rclpy[fastrtps]==7.1.6",
    "segno>=1.6,<2",
    "trimesh>=4.4",
    "viser>=1.1,<2",
    "websockets>=14",
    "zstandard>=0.22",
]
FRONT = ["*.js", "*.css", "*.html", "*.svg"]
DATA_FOLDERS = ["launch"]
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
    package_data={f"{PACKAGE}.front": FRONT},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        *((f"share/{PACKAGE}/{path.parent}", [str(path)]) for path in DATA_FILES),
    ],
    install_requires=[
        "setuptools",
        *REQUIREMENTS,
        *(f"{Path(path).name} @ {Path(path).resolve().as_uri()}" for path in NEIGHBOURS),
    ],
    zip_safe=True,
    description="A page in the browser that shows robots and drives them.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": ["arm_viewer_node = arm_viewer.arm_viewer_node:main"],
        "launch_py.nodes": [
            "arm_viewer_node = arm_viewer",
        ],
    },
)
