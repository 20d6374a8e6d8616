"""Controllers: their base classes, and one folder for each type.

A folder holds a controller without ROS, its parameters, and its topics in `ros.py` or `ros_*.py`.
"""
