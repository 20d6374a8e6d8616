"""Fast DDS as seen from the kernel: participants, and shared memory left by dead processes.

Nothing here loads Fast DDS. Everything is read from /dev/shm and /proc.
"""
