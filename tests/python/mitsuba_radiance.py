"""Radiance of the pixels of a scene by Mitsuba 3, for tests/mitsuba.rs: one ray through the middle of each.

    mitsuba_radiance.py SCENE.toml REPEATS SAMPLES OUT

reads the scene that bbrf reads (spheres, rectangles, boxes, meshes; greys and reflectances at three wavelengths; lights of
one irradiance at all of them), renders it so often with so many samples of each pixel, writes the mean over the repeats and
the variance of that mean (float64, row by row, three channels) to OUT, and says on stdout what it took. The three channels
of `scalar_rgb` are three wavelengths: nothing is made of colours. Paths of bbrf have `bounces` surfaces between the one
that is seen and the light; `max_depth` counts every ray of the path, so it is `bounces` + 2.
"""

import json
import math
import pathlib
import sys
import time
import tomllib

import drjit
import mitsuba
import numpy

mitsuba.set_variant("scalar_rgb")
CIE_E = 100.0  # what the CIE tabulates its equal-energy light as


def unit(vector):
    vector = numpy.array(vector, dtype=float)
    return vector / numpy.linalg.norm(vector)


def rgb(values):
    return {"type": "rgb", "value": [float(value) for value in values]}


def material(one, folder):
    if "albedo" in one:
        values = [one["albedo"]] * 3
    else:
        table = numpy.loadtxt(folder / one["reflectance"], delimiter=",", skiprows=1)
        values = table[:, 1]
        assert len(values) == 3
    return {"type": "twosided", "inner": {"type": "diffuse", "reflectance": rgb(values)}}


def columns(axes, middle):
    matrix = numpy.eye(4)
    matrix[:3, :3] = numpy.array(axes).T
    matrix[:3, 3] = middle
    return mitsuba.ScalarTransform4f(matrix)


def turn(axis, degrees):
    sine, cosine = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    matrix = numpy.eye(3)
    a, b = (axis + 1) % 3, (axis + 2) % 3
    matrix[a, a] = matrix[b, b] = cosine
    matrix[a, b], matrix[b, a] = -sine, sine
    return matrix


def body(one, folder):
    if "sphere" in one:
        return {"type": "sphere", "center": one["sphere"]["centre"], "radius": one["sphere"]["radius"]}
    if "plane" in one:
        plane = one["plane"]
        normal = unit(plane["normal"])
        across = unit(numpy.cross(plane.get("up", [0, 1, 0]), normal))
        width, height = plane["size"]
        axes = [across * width / 2, numpy.cross(normal, across) * height / 2, normal]
        return {"type": "rectangle", "to_world": columns(axes, plane["point"])}
    if "box" in one:
        box = one["box"]
        x, y, z = box.get("rotate_deg", [0, 0, 0])
        turned = turn(2, z) @ turn(1, y) @ turn(0, x)
        axes = [turned[:, k] * box["size"][k] / 2 for k in range(3)]
        return {"type": "cube", "to_world": columns(axes, box["centre"])}
    mesh = one["mesh"]
    scale = mesh.get("scale", 1.0)
    place = columns(numpy.eye(3) * scale, mesh.get("move", [0, 0, 0]))
    return {"type": "obj", "filename": str(folder / mesh["file"]), "face_normals": True, "to_world": place}


def light(one):
    assert one["spectrum"] == "E"
    strength = CIE_E * one.get("strength", 1.0)
    if "towards" in one:
        towards = unit(one["towards"])
        return {"type": "directional", "direction": (-towards).tolist(), "irradiance": rgb([strength] * 3)}
    if "at" in one:
        intensity = strength * one.get("reference_distance", 1.0) ** 2
        return {"type": "point", "position": one["at"], "intensity": rgb([intensity] * 3)}
    return {"type": "constant", "radiance": rgb([strength / math.pi] * 3)}


def rays(scene):
    film, camera = scene["film"], scene["camera"]
    width, height = film["width"], film["height"]
    forward = unit(numpy.subtract(camera["at"], camera["from"]))
    right = unit(numpy.cross(forward, camera.get("up", [0, 1, 0])))
    up = numpy.cross(right, forward)
    reach = math.tan(math.radians(camera["width_deg"] / 2))
    for row in range(height):
        for column in range(width):
            x = (2 * (column + 0.5) - width) / width
            y = (height - 2 * (row + 0.5)) / width
            yield camera["from"], unit(forward + reach * (x * right + y * up)).tolist()


def film(width):
    return {"type": "hdrfilm", "width": width, "height": 1, "rfilter": {"type": "box"}, "pixel_format": "rgb",
            "component_format": "float32"}


def load(path):
    folder = path.parent
    scene = tomllib.loads(path.read_text())
    depth = -1 if scene["bounces"] == "all" else scene["bounces"] + 2
    made = {"type": "scene", "integrator": {"type": "path", "max_depth": depth, "hide_emitters": True}}
    made |= {f"light {k}": light(one) for k, one in enumerate(scene["light"])}
    materials = {one["name"]: material(one, folder) for one in scene["material"]}
    for k, one in enumerate(scene["object"]):
        made[f"object {k}"] = body(one, folder) | {"bsdf": materials[one["material"]]}
    every = list(rays(scene))
    made["camera"] = {"type": "batch", "film": film(len(every)), "sampler": {"type": "independent"}} | {
        f"pixel {k:06d}": {"type": "radiancemeter", "origin": origin, "direction": direction, "film": film(1)}
        for k, (origin, direction) in enumerate(every)
    }
    return mitsuba.load_dict(made), len(every)


def main():
    path, repeats, samples, out = pathlib.Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]), sys.argv[4]
    drjit.set_thread_count(1)
    scene, pixels = load(path)
    found, seconds = [], []
    for seed in range(repeats):
        start = time.perf_counter()
        # Seeds beside each other share random numbers, and the pictures would scatter by less than they are off.
        image = mitsuba.render(scene, spp=samples, seed=1_000_003 * seed)
        seconds.append(time.perf_counter() - start)
        found.append(numpy.array(image, dtype=float).reshape(pixels, 3))
    found = numpy.array(found)
    mean, variance = found.mean(axis=0), found.var(axis=0, ddof=1) / repeats
    numpy.concatenate([mean.ravel(), variance.ravel()]).astype("<f8").tofile(out)
    print(json.dumps({"version": mitsuba.__version__, "seconds": sorted(seconds)[len(seconds) // 2]}))


main()
