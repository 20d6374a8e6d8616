"""The arm's parts as solids; `make_meshes.py` beside this package writes them to files.

Drawings are in millimetres, as drawings are; only what is written to a file is in metres.
"""
