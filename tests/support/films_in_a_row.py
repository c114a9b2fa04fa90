"""A drone that films a skier three times, with no time to stop between the films."""

SKIER = """\
shotc: 1
mission: skier
world: {origin: {lat: 46.948, lon: 7.4474, alt: 540}}
targets:
  skier: {track: {points: [[0, 200, 0.9], [6, 120, 0.9], [0, -100, 0.9]], speed: 5.5 m/s},
          radius: 0.5, height: 1.8}
drones:
  cam: {model: x500, home: [-30, 150, 0]}
shots:
  - {id: follow, kind: chase, drone: cam, target: skier, distance: 11, altitude: 6.5,
     timing: {start: 12, duration: 8}}
  - {id: drop, kind: lateral, drone: cam, target: skier, side: right, distance: 13, altitude: 6.4,
     timing: {start: 27, duration: 5}}
"""
THIRD = """\
  - {id: last, kind: chase, drone: cam, target: skier, distance: 12, altitude: 6,
     timing: {start: 38, duration: 4}}
"""
