"""The `arm` command."""
