"""The command line of `arm launch`, and its listings of arguments and plan."""
