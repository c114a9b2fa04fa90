"""Refiners for shotc: the framing problem of Gebhardt and Hilliges as an optimal-control problem.

conditions -> wishes -> stages -> solving -> program -> camera -> proof -> rounds -> telling -> refiner:
each module uses those before it.
"""
