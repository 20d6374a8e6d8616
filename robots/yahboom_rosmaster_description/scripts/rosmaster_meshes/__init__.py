"""The ROSMASTER X3's parts as solids; `make_meshes.py` beside this package writes them to files.

Drawings are in millimetres, each part in its link's frame. Sizes, masses and contact shapes are the
robot's; the solids are drawn with what arm_description's script draws with.
"""
