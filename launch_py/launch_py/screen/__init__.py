"""The launcher's output: the screen and the log files."""

from launch_py.screen.screen import PlainScreen, ReadySummary, Screen, TerminalScreen

__all__ = ["PlainScreen", "ReadySummary", "Screen", "TerminalScreen"]
