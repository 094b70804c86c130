"""The door: strangers meet zenoh in a process that may break; the robot's own speak and hear through it.

frames   what is said between them
wire     how it gets there: a socket of the machine
remote   the session of a process behind the door
host     the door's end of it
hub      one subscription for all of them
backlog  what waits there for a process that is slow
"""
