"""Opens an EXR with the OpenEXR project's own package, for tests/ecosystem.rs. usage: opens_exr.py FILE

Prints JSON: for each part its name, its attributes and each channel's numbers as the whole numbers of their bits.
"""

import json
import sys

import numpy as np
import OpenEXR

parts = []
with OpenEXR.File(sys.argv[1], separate_channels=True) as file:
    for part in file.parts:
        header = {name: str(value) for name, value in part.header.items() if isinstance(value, str)}
        channels = {
            name: np.ascontiguousarray(channel.pixels, dtype=np.float32).view(np.uint32).ravel().tolist()
            for name, channel in part.channels.items()
        }
        kinds = sorted({str(channel.pixels.dtype) for channel in part.channels.values()})
        shapes = sorted({channel.pixels.shape for channel in part.channels.values()})
        parts.append({"header": header, "channels": channels, "kinds": kinds, "shapes": shapes})
json.dump(parts, sys.stdout)
