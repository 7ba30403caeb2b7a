"""Renders a .glb with Blender's Cycles and says how long the rendering alone took. Runs inside Blender:

    blender -b --factory-startup -P bench/peers/cycles.py -- SCENE.glb --spp 16 64 -o FOLDER

Writes FOLDER/cycles_SPP.exr (linear Rec. 709, 32 bits a channel) and prints one line of JSON after each picture, with the
seconds of `render.render` (scene synchronised, trees built, all samples; nothing saved) and those of importing the file,
seen from its first camera. blender_scene.py has the settings.
"""
import argparse
import json
import os
import sys
import time

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from blender_scene import configure, import_scene  # noqa: E402  (beside this file, where Blender does not look)


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
