"""The programmes of fleets: matching, moves, separation; see ``shotc.solvers`` for what both routes use."""
