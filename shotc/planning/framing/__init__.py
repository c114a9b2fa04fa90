"""Where targets stand on screen: camera angles of keyframes."""
