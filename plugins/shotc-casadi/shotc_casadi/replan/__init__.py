"""Receding-horizon planning: one Gauss-Newton step a replan; PIQP solves its quadratic programme.

Order of the modules; each one uses those before it:
solids -> keeping -> layout -> evaluation -> steps -> flight -> pictures -> chase, framing -> replanner.
"""
