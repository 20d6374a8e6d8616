"""Build ROS 2 interface packages from pip wheels, without CMake and colcon.

The way from a ``.msg`` file to something that ``import`` finds:

1. ``generation``: the rosidl generators of the wheels write C, C++ and Python.
2. ``translation_unit``: their many small C files are gathered into few, then compiled.
3. ``library``: three shared libraries per package are linked.
4. ``share_folder``: the definitions and the ament index markers are laid out.

``package_build`` puts these in order for one package, ``parallel_build`` runs all packages on
all cores, ``command`` and ``backend`` tie the whole to setuptools and pip.
"""
