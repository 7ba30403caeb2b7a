"""A .glb in Blender, with the settings of a reference, not of a nice picture: box filter of one pixel, no clamping, no
denoising, no adaptive sampling, no blurred glossy lobes, caustics on, black surroundings. Shared by what runs inside Blender.
"""
import argparse
import time

import bpy
import numpy


def import_scene(file: str) -> float:
    """Replaces what Blender starts with by the file. Seconds."""
    numpy.bool = bool  # Blender 3.4's importer names what Debian 12's numpy no longer has
    start = time.perf_counter()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file)
    scene = bpy.context.scene
    scene.camera = next((o for o in scene.objects if o.type == "CAMERA"), None)
    scene.world = bpy.data.worlds.new("black")
    scene.world.color = (0, 0, 0)
    return time.perf_counter() - start


def configure(args: argparse.Namespace) -> None:
    """`args`: size, threads, bounces and seed."""
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
