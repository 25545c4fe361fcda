"""Opens what `toile try-on --export` wrote in Blender, without a window, and compares every vertex in every frame.

    toile try-on --no-pictures --export glb --export usd --export mdd --export pc2 --export ply --out exported
    python compare.py exported
    python compare.py exported walker.glb Walk

The PLY files hold the positions of the engine as they are (f32, metres, y up). Against them are compared, as Blender evaluates
them: the GLB (garments by shape keys, the body by its armature and shape keys), the USD stage, and each OBJ moved by a Mesh Cache modifier with
its MDD and its PC2 file. Blender's z-up axes are turned back first.

With a file and an animation, as `toile try-on --body walker.glb --animation Walk` was given them, the body of the PLY files is
compared with that file as Blender skins it, and the distance is held against what the report says of it.

Needs Python 3.11 with `pip install bpy==4.5.*` (docs/export.md). Exits with 1 where a limit is exceeded.
"""

import json
import pathlib
import re
import sys

import bpy
import numpy as np

# What rounding costs (m): a float of 2 m has steps of 0.24 um, and a shape key is added to its base.
POINT_LIMIT_M = 2e-6
# Of a body that viewers skin: shape keys make up for what linear blending misses from 10 um on, and bones are floats.
SKIN_LIMIT_M = 2e-5


def ply_positions(path):
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    count = int(re.search(rb"element vertex (\d+)", data[:end]).group(1))
    return np.frombuffer(data, "<f4", 3 * count, end).reshape(-1, 3).astype(np.float64)


def truth(folder):
    """Positions of each part in each frame [frames][vertices][3]."""
    parts = {}
    for path in sorted(folder.glob("session-*-??????.ply")):
        part = re.fullmatch(r"session-(.*)-\d{6}\.ply", path.name).group(1)
        parts.setdefault(part, []).append(ply_positions(path))
    return {name: np.stack(frames) for name, frames in parts.items()}


def fresh(rate):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = rate


def evaluated(thing):
    """World positions of an object's vertices as the frame shows them, turned to y up."""
    shown = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = shown.to_mesh()
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", flat)
    local = flat.reshape(-1, 3).astype(np.float64)
    matrix = np.array(shown.matrix_world, np.float64)
    world = local @ matrix[:3, :3].T + matrix[:3, 3]
    shown.to_mesh_clear()
    return np.stack([world[:, 0], world[:, 2], -world[:, 1]], axis=1)


def distance(things, wanted):
    """Mean and largest distance of each part from the truth over all frames (m), and where the largest is."""
    scene = bpy.context.scene
    first, frames = scene.frame_start, len(next(iter(wanted.values())))
    found = {name: [0.0, 0.0, (0, 0)] for name in things}
    for frame in range(frames):
        scene.frame_set(first + frame)
        for name, thing in things.items():
            want = wanted[name][frame]
            have = evaluated(thing)[: len(want)]
            assert have.shape == want.shape, f"{name} has {len(have)} vertices for {len(want)}"
            apart = np.linalg.norm(have - want, axis=1)
            worst = int(apart.argmax())
            found[name][0] += apart.mean() / frames
            if apart[worst] >= found[name][1]:
                found[name][1:] = [float(apart[worst]), (frame, worst)]
    return found


def named(part):
    """The mesh object of a part: names may have been changed to ones that the format allows."""
    plain = re.sub(r"[^A-Za-z0-9]", "_", part)
    meshes = [o for o in bpy.data.objects if o.type == "MESH"]
    hits = [o for o in meshes if re.sub(r"[^A-Za-z0-9]", "_", o.name).startswith(plain)]
    assert len(hits) == 1, f"{part}: {[o.name for o in meshes]}"
    return hits[0]


def start_at(frame):
    bpy.context.scene.frame_start = frame


def check_glb(folder, wanted, rate):
    fresh(rate)
    bpy.ops.import_scene.gltf(filepath=str(folder / "session.glb"))
    start_at(0)
    return distance({part: named(part) for part in wanted}, wanted)


def check_usd(folder, wanted, rate):
    fresh(rate)
    bpy.ops.wm.usd_import(filepath=str(folder / "session.usda"))
    start_at(0)
    return distance({part: named(part) for part in wanted}, wanted)


def check_cache(folder, wanted, rate, ending):
    fresh(rate)
    things = {}
    for part in wanted:
        bpy.ops.wm.obj_import(filepath=str(folder / f"session-{part}.obj"))
        thing = bpy.context.selected_objects[0]
        cache = thing.modifiers.new("cache", "MESH_CACHE")
        cache.cache_format = ending.upper()
        cache.filepath = str(folder / f"session-{part}.{ending}")
        cache.frame_start = 0
        things[part] = thing
    start_at(0)
    return distance(things, wanted)


def play(armature, name):
    """Lets an armature move by one animation alone."""
    data = armature.animation_data
    for track in data.nla_tracks:
        track.mute = True
    action = bpy.data.actions[name]
    data.action = action
    data.action_slot = action.slots[0]


def placed(thing, armature):
    """How far Toile moves a body: the middle of its hips to x = z = 0, its lowest vertex to y = 0, both at rest."""
    matrix = np.array(thing.matrix_world, np.float64)
    lowest = min((matrix @ np.array([*v.co, 1.0]))[2] for v in thing.data.vertices)
    bones = [armature.matrix_world @ armature.data.bones[b].head_local for b in ("LeftUpLeg", "RightUpLeg")]
    middle = sum((np.array(b) for b in bones), np.zeros(3)) / 2
    return np.array([middle[0], lowest, -middle[1]])


def check_animation(folder, wanted, rate, file, name):
    """The body against the file that moved it, as Blender skins it; exits with its own limit: what the report says."""
    fresh(rate)
    bpy.ops.import_scene.gltf(filepath=file)
    thing = next(o for o in bpy.data.objects if o.type == "MESH" and o.find_armature())
    armature = thing.find_armature()
    moved = placed(thing, armature)
    play(armature, name)
    scene = bpy.context.scene
    apart = []
    for frame, want in enumerate(wanted["body"]):
        # The first frame is the state after the first step of 1/120 s.
        at = frame + rate / 120.0
        scene.frame_set(int(at), subframe=at % 1.0)
        apart.append(np.linalg.norm(evaluated(thing) - moved - want, axis=1))
    return np.concatenate(apart)


def main(folder, file=None, name=None):
    folder = pathlib.Path(folder)
    report = json.loads((folder / "report.json").read_text())
    rate = report["export"]["rate_hz"]
    wanted = truth(folder)
    frames = {name: all.shape[0] for name, all in wanted.items()}
    assert wanted and set(frames.values()) == {report["export"]["frames"]}, frames
    checks = {
        "glb": lambda: check_glb(folder, wanted, rate),
        "usd": lambda: check_usd(folder, wanted, rate),
        "mdd": lambda: check_cache(folder, wanted, rate, "mdd"),
        "pc2": lambda: check_cache(folder, wanted, rate, "pc2"),
    }
    failed = False
    print(f"Blender {bpy.app.version_string}, {report['export']['frames']} frames at {rate} Hz")
    for format, check in checks.items():
        if format not in report["export"]["formats"]:
            continue
        for part, (mean, worst, (frame, vertex)) in check().items():
            limit = SKIN_LIMIT_M if (format, part) == ("glb", "body") else POINT_LIMIT_M
            failed |= not worst <= limit
            print(
                f"{format:4} {part:24} {wanted[part].shape[1]:6} vertices  mean {mean * 1e6:10.3f} um  "
                f"max {worst * 1e6:10.3f} um at frame {frame}, vertex {vertex}  limit {limit * 1e6:.0f} um"
            )
    if file:
        apart = check_animation(folder, wanted, rate, file, name) * 1e3
        said = report["animation"]
        print(
            f"{file} {name}: Blender's skin and Toile's are apart by mean {apart.mean():.3f} mm, "
            f"p99 {np.quantile(apart, 0.99):.3f} mm, max {apart.max():.3f} mm; the report says mean "
            f"{said['skin_mean_mm']} mm, p99 {said['skin_p99_mm']} mm, max {said['skin_max_mm']} mm"
        )
        failed |= not abs(apart.mean() - said["skin_mean_mm"]) < 0.1 * said["skin_mean_mm"] + 0.05
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
