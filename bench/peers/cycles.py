"""Renders a .glb with Blender's Cycles and says how long the rendering alone took. Runs inside Blender:

    blender -b --factory-startup -P bench/peers/cycles.py -- SCENE.glb --spp 16 64 -o FOLDER

Writes FOLDER/cycles_SPP.exr (linear Rec. 709, 32 bits a channel) and prints one line of JSON after each picture, with the
seconds of `render.render` (scene synchronised, trees built, all samples; nothing saved) and those of importing the file.
The settings are those of a reference, not of a nice picture: box filter of one pixel, no clamping, no denoising, no adaptive
sampling, no blurred glossy lobes, caustics on, black surroundings.
"""
import argparse
import json
import os
import sys
import time

import bpy
import numpy


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="cycles.py")
    parser.add_argument("scene")
    parser.add_argument("--spp", type=int, nargs="+", required=True)
    parser.add_argument("--size", type=int, nargs=2, default=[512, 512])
    parser.add_argument("--bounces", type=int, default=12)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("-o", "--output", required=True, help="folder of the pictures")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


def import_scene(file: str) -> float:
    """Replaces what Blender starts with by the file, seen from its first camera. Seconds."""
    numpy.bool = bool  # Blender 3.4's importer names what Debian 12's numpy no longer has
    start = time.perf_counter()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file)
    scene = bpy.context.scene
    scene.camera = next(o for o in scene.objects if o.type == "CAMERA")
    scene.world = bpy.data.worlds.new("black")
    scene.world.color = (0, 0, 0)
    return time.perf_counter() - start


def configure(args: argparse.Namespace) -> None:
    scene = bpy.context.scene
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = args.size
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", args.threads
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_mode = "RGB"
    render.image_settings.color_depth = "32"
    cycles.device = "CPU"
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = 0
    cycles.light_sampling_threshold = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.max_bounces = args.bounces
    cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = args.bounces
    cycles.transparent_max_bounces = args.bounces
    cycles.seed = args.seed


def render_picture(samples: int, folder: str) -> dict:
    bpy.context.scene.cycles.samples = samples
    start = time.perf_counter()
    bpy.ops.render.render()
    seconds = time.perf_counter() - start
    file = os.path.join(folder, f"cycles_{samples}.exr")
    bpy.data.images["Render Result"].save_render(file)
    return {"spp": samples, "render_s": seconds, "file": file}


def main() -> None:
    args = arguments()
    os.makedirs(args.output, exist_ok=True)
    import_s = import_scene(os.path.abspath(args.scene))
    configure(args)
    for samples in args.spp:
        picture = {"blender": bpy.app.version_string, "import_s": import_s}
        print("\n" + json.dumps(picture | render_picture(samples, args.output)), flush=True)


main()
