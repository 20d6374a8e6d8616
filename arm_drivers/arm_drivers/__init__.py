"""Hardware plugins of real arms. None of them was ever tried on a real arm."""
