"""Refiners for shotc: the framing problem of Gebhardt and Hilliges as an optimal-control problem.

Order of the modules for a shot on a path; each one uses those before it:
conditions -> references -> stages -> solving -> program -> camera -> proof -> rounds -> messages -> refiner.
"""
