"""The simulation that runs: MuJoCo's steps and state."""
