"""mujoco ships no type stubs; this lets pyright pass its names through."""

from typing import Any

def __getattr__(name: str) -> Any: ...
