"""What the system grants: processes, sockets between them, priorities, signals, files that outlive it."""
