"""Files for previsualization: the world and the animated cameras, for Blender, Unreal, Houdini and browsers.

``scene.py`` collects their content in W, metres. ``gltf.py`` and ``usd.py`` write it.
"""
