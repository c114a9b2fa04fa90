"""A proved plan sent to autopilots as it is to be flown: setpoints and gimbal angles on one clock.

Nothing that is proved depends on it, and nothing is sent that is not proved: positions, velocities,
accelerations and headings are the plan's own polynomials, and all that a live target may change is where the
camera looks.
"""
