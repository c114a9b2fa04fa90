"""Realistic missions drawn by seed, all of which a good planner can fly, and a judge of what becomes of them.

A mission is a YAML text with its track files, made of one integer by ``random.Random`` alone, so that a seed
means the same mission everywhere. Why each is feasible, by construction:

- **What is seen.** Every place that a shot asks for (keyframes, or the ideal sampled in time) shows the
  whole subject at its place on screen, with room to spare (``optics.ROOM``), through the lens that the shot
  has there, and with the camera within the gimbal's pitch range.
- **How fast.** A place that moves does so at ``moving.SPEED`` of the drone's speed (less the wind) and
  ``moving.BEND`` of its acceleration at most, and the line of sight turns at ``moving.TURN`` of what gimbal
  and body turn. A given duration is ``standing.AMPLE`` times what the way takes at normal pace.
- **When.** Before every shot of what moves there is twice the time of the straight way to it, and a run-up.
- **Room.** Places keep the clearances of ground and targets, and those of two drones at one time are the
  separation and ``surroundings.APART`` metres apart; of shots without a start, at all times. Pads keep off
  each other, all places and the ways of all subjects. Zones keep off places, pads and the ways of subjects;
  one that stands between two keyframes, or on the way to a shot, is small and can be passed on every side. A
  fence leaves room for run-ups about all places.
- **How long.** All films together take less than a third of the endurance.

Where geometry itself does not let every frame be whole, the shot says why (``Take.why_cropped``).
"""
