"""Warp is an extra that checks do not install; this lets pyright pass its names through."""

from typing import Any

def __getattr__(name: str) -> Any: ...
