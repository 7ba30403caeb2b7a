"""Bakes the light of a .glb's surfaces with Blender's Cycles and says how long the bake alone took. Runs inside Blender:

    blender -b --factory-startup -P bench/peers/cycles_bake.py -- SCENE.glb --points POINTS.json -o FOLDER

POINTS.json: a list of {"object": NAME, "at": [x, y, z]}, positions in the file's coordinates. The objects it names share one
atlas, unwrapped by Smart UV Project; what is baked is diffuse light, direct and indirect, without the surface's colour, with
the settings of blender_scene.py. Writes FOLDER/cycles_bake.exr (irradiance / pi) and FOLDER/cycles_bake.json (irradiance at each
point, W/m^2: [r, g, b]), and prints one line of JSON with the seconds of `object.bake`, of unwrapping and of the import.
"""
import argparse
import json
import math
import os
import sys
import time

import bpy
import numpy
from mathutils import Vector
from mathutils.geometry import barycentric_transform

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from blender_scene import configure, import_scene  # noqa: E402  (beside this file, where Blender does not look)

_MARGIN = 8  # texels that are filled around islands


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="cycles_bake.py")
    parser.add_argument("scene")
    parser.add_argument("--points", required=True)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--size", type=int, nargs=2, default=[512, 512], help="of the atlas")
    parser.add_argument("--bounces", type=int, default=12)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("-o", "--output", required=True, help="folder of the atlas and the values")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


def select(objects: list) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    for thing in objects:
        thing.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def unwrap(objects: list) -> None:
    """One atlas for all of them."""
    for thing in objects:
        layer = thing.data.uv_layers.new(name="bake")
        thing.data.uv_layers.active = layer
    select(objects)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project(angle_limit=math.radians(66), island_margin=0.02)
    bpy.ops.object.mode_set(mode="OBJECT")


def atlas_of(objects: list, size: list) -> "bpy.types.Image":
    """The image that the objects' materials are baked into."""
    image = bpy.data.images.new("atlas", *size, float_buffer=True)
    image.colorspace_settings.name = "Linear"
    for material in {slot.material for thing in objects for slot in thing.material_slots}:
        material.use_nodes = True
        node = material.node_tree.nodes.new("ShaderNodeTexImage")
        node.image = image
        material.node_tree.nodes.active = node
    return image


def pixels_of(image: "bpy.types.Image") -> numpy.ndarray:
    """Rows upwards, RGB."""
    width, height = image.size
    flat = numpy.empty(width * height * 4, dtype=numpy.float32)
    image.pixels.foreach_get(flat)
    return flat.reshape(height, width, 4)[:, :, :3]


def bilinear(pixels: numpy.ndarray, u: float, v: float) -> numpy.ndarray:
    height, width = pixels.shape[:2]
    x, y = u * width - 0.5, v * height - 0.5
    left, below = math.floor(x), math.floor(y)
    total = numpy.zeros(3)
    for j, wy in ((below, 1 - (y - below)), (below + 1, y - below)):
        for i, wx in ((left, 1 - (x - left)), (left + 1, x - left)):
            total += wx * wy * pixels[min(max(j, 0), height - 1), min(max(i, 0), width - 1)]
    return total


def uv_at(thing: "bpy.types.Object", position: Vector) -> Vector:
    """The atlas coordinate of the surface point nearest to a position of the world."""
    found, place, _, index = thing.closest_point_on_mesh(thing.matrix_world.inverted() @ position)
    if not found:
        raise SystemExit(f"cycles_bake.py: {thing.name} has no surface")
    mesh = thing.data
    polygon = mesh.polygons[index]
    corners = [mesh.vertices[mesh.loops[loop].vertex_index].co for loop in polygon.loop_indices[:3]]
    uvs = [mesh.uv_layers["bake"].data[loop].uv.to_3d() for loop in polygon.loop_indices[:3]]
    return barycentric_transform(place, *corners, *uvs)


def main() -> None:
    args = arguments()
    os.makedirs(args.output, exist_ok=True)
    with open(args.points, encoding="utf-8") as file:
        points = json.load(file)
    import_s = import_scene(os.path.abspath(args.scene))
    configure(args)
    bpy.context.scene.cycles.samples = args.spp
    objects = [bpy.data.objects[name] for name in dict.fromkeys(point["object"] for point in points)]
    start = time.perf_counter()
    unwrap(objects)
    unwrap_s = time.perf_counter() - start
    image = atlas_of(objects, args.size)
    select(objects)
    start = time.perf_counter()
    bpy.ops.object.bake(type="DIFFUSE", pass_filter={"DIRECT", "INDIRECT"}, margin=_MARGIN, use_clear=True)
    bake_s = time.perf_counter() - start
    image.filepath_raw = os.path.join(args.output, "cycles_bake.exr")
    image.file_format = "OPEN_EXR"
    image.save()
    pixels = pixels_of(image)
    values = []
    for point in points:
        x, y, z = point["at"]  # glTF has y upwards, Blender z
        uv = uv_at(bpy.data.objects[point["object"]], Vector((x, -z, y)))
        values.append([math.pi * float(c) for c in bilinear(pixels, uv.x, uv.y)])
    with open(os.path.join(args.output, "cycles_bake.json"), "w", encoding="utf-8") as file:
        json.dump(values, file)
    seconds = {"bake_s": bake_s, "unwrap_s": unwrap_s, "import_s": import_s}
    print("\n" + json.dumps({"blender": bpy.app.version_string, "spp": args.spp} | seconds), flush=True)


main()
