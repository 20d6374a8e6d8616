"""Render a MuJoCo scene: with OpenGL without a display, or by ray casting without OpenGL."""
