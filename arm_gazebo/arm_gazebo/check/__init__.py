"""What `arm check` says of a description, without starting anything."""
