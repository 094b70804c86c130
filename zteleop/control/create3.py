"""What an iRobot Create 3 is: its measures and its own bounds, as iRobot gives them."""

SAFE_SPEED, FULL_SPEED = 0.306, 0.46
"""m/s of a wheel, with its safety and with all of it switched off"""
MAX_TURN = 1.9
"""rad/s"""
ACCELERATION = 0.9
"""m/s^2"""
OBEYS_FOR = 0.5
"""s that a command is obeyed; who hears no other by then stands"""
TRACK = 0.233
"""m between the wheels"""
WHEEL_RADIUS = 0.03575
"""m"""
TICKS_PER_TURN = 508.8
"""of a wheel's encoder"""
