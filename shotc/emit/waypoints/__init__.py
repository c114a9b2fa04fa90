"""What files of waypoints have in common: samples of the plan, places, clearances, the picture they add."""
