"""The cockpit: one page in a browser drives a robot, and shows what happens.

tickets  who is let in
files    what a browser loads
words    what page and server say to each other
slots    what waits for a page that is slow
"""
