"""The things of the world: what there is, what is added, and files that are dropped."""
