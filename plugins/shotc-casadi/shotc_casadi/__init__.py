"""Refiners for shotc: the framing problem of Gebhardt and Hilliges as an optimal-control problem.

conditions -> wishes -> stages -> program -> camera -> proof -> rounds -> refiner:
each module uses those before it.
"""
