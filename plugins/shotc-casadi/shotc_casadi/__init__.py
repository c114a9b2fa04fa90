"""Refiners for shotc: the framing problem of Gebhardt and Hilliges as an optimal-control problem.

conditions -> references -> stages -> solving -> program -> camera -> proof -> rounds -> messages -> refiner:
each module uses those before it.
"""
