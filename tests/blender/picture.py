"""Draws an exported session in Blender, by Cycles on the processor: three moments side by side.

    python picture.py exported picture.png [glb|usd]
"""

import math
import pathlib
import sys

import bpy
import numpy as np

HEIGHT, WIDTH, SAMPLES = 560, 360, 48


def light(kind, energy, turn, size=None):
    lamp = bpy.data.lights.new(kind, kind)
    lamp.energy = energy
    if size:
        lamp.angle = size
    thing = bpy.data.objects.new(kind, lamp)
    thing.rotation_euler = [math.radians(a) for a in turn]
    bpy.context.collection.objects.link(thing)


def main(folder, target, format="glb"):
    folder = pathlib.Path(folder)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = 30
    if format == "glb":
        bpy.ops.import_scene.gltf(filepath=str(folder / "session.glb"), disable_bone_shape=True)
    else:
        bpy.ops.wm.usd_import(filepath=str(folder / "session.usda"))
    for thing in bpy.data.objects:
        if thing.type == "MESH":
            for face in thing.data.polygons:
                face.use_smooth = True
    bpy.ops.mesh.primitive_plane_add(size=40)
    floor = bpy.data.materials.new("floor")
    floor.use_nodes = True
    floor.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.6, 0.6, 0.6, 1)
    bpy.context.object.data.materials.append(floor)
    world = bpy.data.worlds.new("world")
    scene.world = world
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.55, 0.58, 0.62, 1)
    light("SUN", 2.5, (45, 0, 30), 0.2)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.lens = 60
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.samples = SAMPLES
    scene.cycles.use_denoising = True
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    last = max(int(scene.frame_end), 1)
    if format == "glb":
        ends = [a.frame_range[1] for a in bpy.data.actions]
        last = int(max(ends))
    body = next(o for o in bpy.data.objects if o.type == "MESH" and o.name.startswith("body"))
    columns = []
    for share in (0.25, 0.55, 0.95):
        scene.frame_set(int(share * last))
        shown = body.evaluated_get(bpy.context.evaluated_depsgraph_get())
        points = np.array([shown.matrix_world @ v.co for v in shown.to_mesh().vertices])
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        camera.location = (middle[0] + 0.9, middle[1] - 3.9, 1.1)
        camera.rotation_euler = (math.radians(87.0), 0, math.atan2(0.9, 3.9))
        scene.render.filepath = f"/tmp/{pathlib.Path(target).stem}-part.png"
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath, check_existing=False)
        flat = np.empty(4 * WIDTH * HEIGHT, np.float32)
        image.pixels.foreach_get(flat)
        columns.append(flat.reshape(HEIGHT, WIDTH, 4))
        pathlib.Path(scene.render.filepath).unlink()
    whole = np.concatenate(columns, axis=1)
    out = bpy.data.images.new("whole", whole.shape[1], whole.shape[0])
    out.pixels.foreach_set(np.ascontiguousarray(whole).ravel())
    out.filepath_raw, out.file_format = str(target), "PNG"
    out.save()


if __name__ == "__main__":
    main(*sys.argv[1:])
