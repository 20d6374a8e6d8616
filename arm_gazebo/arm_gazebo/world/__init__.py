"""The world while it runs: what is in it, and how it is changed."""
