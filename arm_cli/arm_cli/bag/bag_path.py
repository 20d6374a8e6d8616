"""The argument that names a bag."""

import argparse
from pathlib import Path


def existing_path(text: str) -> Path:
    """Convert an argument to a path, for argparse."""
    path = Path(text)
    if not path.exists():
        raise argparse.ArgumentTypeError(f"Bag path '{text}' does not exist!")
    return path
