"""An iRobot Create 3, part by part."""
