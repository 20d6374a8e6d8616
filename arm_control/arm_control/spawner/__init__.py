"""The programs spawner, unspawner and hardware_spawner, and their client of a manager."""
