"""Flies a verified plan: sends setpoints and gimbal angles to autopilots over MAVLink, on one clock.

Only verified plans are sent, and no proof depends on this package. Positions, velocities, accelerations and
headings come from the plan's polynomials. A live target may change only where the camera looks.
"""
