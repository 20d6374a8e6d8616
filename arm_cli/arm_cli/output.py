"""What several verbs print alike."""

import argparse
import json
import math
import sys
from typing import Any


def add_json_argument(parser: argparse.ArgumentParser) -> None:
    """Add `--json`."""
    parser.add_argument("--json", action="store_true", help="print JSON, for scripts")


def print_json(value: Any) -> None:
    """Print a value as one line of JSON; numbers that JSON lacks (nan, inf) become null."""
    print(json.dumps(_finite(value), ensure_ascii=False))


def colour(code: int, text: str) -> str:
    """Return the text in a terminal colour (an SGR number), plain off a terminal."""
    return f"\033[{code}m{text}\033[0m" if sys.stdout.isatty() else text


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return value
