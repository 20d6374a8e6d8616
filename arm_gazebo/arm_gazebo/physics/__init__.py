"""The running simulation: MuJoCo's steps and state."""
