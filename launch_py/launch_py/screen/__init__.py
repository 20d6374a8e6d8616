"""What the user sees: plain lines, or a terminal's colours, panel and status line."""

from launch_py.screen.plain_screen import PlainScreen
from launch_py.screen.screen import ReadySummary, Screen
from launch_py.screen.terminal_screen import TerminalScreen

__all__ = ["PlainScreen", "ReadySummary", "Screen", "TerminalScreen"]
