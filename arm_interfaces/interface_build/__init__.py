"""Build ROS 2 interface packages from pip wheels, without CMake and colcon.

The steps from a ``.msg`` file to an importable module:

1. ``generation``: the rosidl generators of the wheels write C, C++ and Python.
2. ``translation_unit``: their many small C files are merged into a few, then compiled.
3. ``library``: three shared libraries per package are linked.
4. ``lazy_imports``: importing a package imports only the classes that are used.
5. ``command``: the definitions and the ament index markers are laid out in ``share``.

``package_build`` orders these steps and runs them for all packages on all cores, ``command`` and
``backend`` connect the build to setuptools and pip.
"""
