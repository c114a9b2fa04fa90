"""What the waypoint formats share: samples of the plan, positions, clearances, and the added screen error."""
