"""Receding-horizon planning: one Gauss-Newton step a replan, with PIQP for its quadratic programme.

solids -> keeping -> layout -> evaluation -> steps -> flight -> pictures -> chase, framing -> replanner: each
module uses those before it.
"""
