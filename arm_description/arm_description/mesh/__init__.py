"""Reads mesh files as triangles, and refuses broken or far too large ones early."""
