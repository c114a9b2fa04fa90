"""The camera angles of keyframes, from the places of targets on screen."""
