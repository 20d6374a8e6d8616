"""Pictures of a MuJoCo scene: by OpenGL without a display, or by casting rays without OpenGL."""
