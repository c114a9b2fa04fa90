"""Files for previsualization: the world and the animated cameras, for Blender, Unreal, Houdini and browsers.

``scene.py`` says what is in them, metres of W; ``gltf.py`` and ``usd.py`` write it.
"""
