"""The optimisation problems of fleets: matching, moves, separation; ``shotc.solvers`` has what both routes
use.
"""
