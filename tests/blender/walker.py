"""Makes a body that walks, as other programs write one: an armature of Mixamo's names, animated and exported by Blender.

    toile body hm08 --out made        # any body; it becomes the mesh
    python walker.py made/body.glb walker.glb

The mesh and its weights are the body's. Blender turns the bones to axes of its own, hangs them below an armature object, and
samples the animations `Walk` (one and a half second of stepping, swinging, turning and leaning, with a spine of three
vertebrae that bend) and `Bend` (arms and knees, far).
"""

import math
import sys

import bpy
from mathutils import Euler, Quaternion, Vector

NAMES = {
    "sacroiliac": "Hips",
    "vl5": "Spine",
    "vl1": "Spine1",
    "vc4": "Neck",
    "skullbase": "Head",
}
SIDES = {
    "sternoclavicular": "Shoulder",
    "shoulder": "Arm",
    "elbow": "ForeArm",
    "radiocarpal": "Hand",
    "metacarpophalangeal_3": "HandMiddle1",
    "hip": "UpLeg",
    "knee": "Leg",
    "talocrural": "Foot",
    "metatarsophalangeal": "ToeBase",
}
FPS = 30
FRAMES = 46


def mixamo(name):
    if name in NAMES:
        return NAMES[name]
    for mark, side in (("l_", "Left"), ("r_", "Right")):
        if name.startswith(mark) and name[2:] in SIDES:
            return side + SIDES[name[2:]]
    return None


def merge_twists(thing, armature):
    """Bones that split a limb hand their weights to the joint that they belong to, as no other program has them."""
    for bone in armature.data.bones:
        if mixamo(bone.name):
            continue
        keeper = bone.parent
        own, kept = thing.vertex_groups.get(bone.name), thing.vertex_groups.get(keeper.name)
        if own is None:
            continue
        kept = kept or thing.vertex_groups.new(name=keeper.name)
        for vertex in thing.data.vertices:
            weight = sum(g.weight for g in vertex.groups if g.group == own.index)
            if weight > 0.0:
                kept.add([vertex.index], weight, "ADD")
        thing.vertex_groups.remove(own)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for bone in list(armature.data.edit_bones):
        if mixamo(bone.name) is None:
            armature.data.edit_bones.remove(bone)
    # A vertebra that Toile does not know, between chest and neck.
    bones = armature.data.edit_bones
    chest, neck = bones["vl1"], bones["vc4"]
    extra = bones.new("Spine2")
    extra.head = chest.head.lerp(neck.head, 0.5)
    extra.tail = neck.head
    extra.parent = chest
    above = [bone for bone in bones if bone.parent == chest and bone != extra]
    for bone in above:
        bone.parent = extra
    bpy.ops.object.mode_set(mode="OBJECT")
    group, added = thing.vertex_groups["vl1"], thing.vertex_groups.new(name="Spine2")
    start, end = armature.data.bones["Spine2"].head_local.z, armature.data.bones["vc4"].head_local.z
    for vertex in thing.data.vertices:
        weight = sum(g.weight for g in vertex.groups if g.group == group.index)
        share = min(max((vertex.co.z - start) / (end - start) + 0.5, 0.0), 1.0)
        if weight > 0.0 and share > 0.0:
            group.add([vertex.index], weight * (1.0 - share), "REPLACE")
            added.add([vertex.index], weight * share, "REPLACE")
    for bone in armature.data.bones:
        bone.name = mixamo(bone.name) or bone.name


def turned(pose_bone, about_world):
    """The bone's own rotation that turns it by this rotation of the armature's axes at rest."""
    rest = pose_bone.bone.matrix_local.to_quaternion()
    return rest.inverted() @ about_world @ rest


def key(armature, frame, turns, root):
    for name, angles in turns.items():
        bone = armature.pose.bones[name]
        bone.rotation_mode = "QUATERNION"
        bone.rotation_quaternion = turned(bone, Euler([math.radians(a) for a in angles]).to_quaternion())
        bone.keyframe_insert("rotation_quaternion", frame=frame)
    hips = armature.pose.bones["Hips"]
    hips.location = hips.bone.matrix_local.to_quaternion().inverted() @ Vector(root)
    hips.keyframe_insert("location", frame=frame)


def walk(t):
    """Angles about x, y, z of Blender's axes (degrees; the body faces -y), and the hips' way (m)."""
    s = math.sin(2.0 * math.pi * t)
    c = math.cos(2.0 * math.pi * t)
    turns = {
        "Hips": (0, 3 * s, 8 * s + 40 * t),
        "Spine": (6, 0, -4 * s),
        "Spine1": (4, 2 * s, -5 * s),
        "Spine2": (5, 3 * s, -8 * s),
        "Neck": (-4, 0, 5 * s),
        "Head": (-6, 0, 6 * s),
        "LeftUpLeg": (-28 * s, 0, 0),
        "RightUpLeg": (28 * s, 0, 0),
        "LeftLeg": (25 + 25 * c, 0, 0),
        "RightLeg": (25 - 25 * c, 0, 0),
        "LeftFoot": (-8 * c, 0, 0),
        "RightFoot": (8 * c, 0, 0),
        "LeftArm": (20 * s, 35, 0),
        "RightArm": (-20 * s, -35, 0),
        "LeftForeArm": (-20 - 12 * s, 0, 0),
        "RightForeArm": (-20 + 12 * s, 0, 0),
        "LeftHand": (0, 15 * s, 0),
        "RightHand": (0, 15 * s, 0),
    }
    return turns, (0.15 * s * s, -0.5 * t, -0.03 + 0.02 * math.cos(4.0 * math.pi * t))


def bend(t):
    s = 0.5 - 0.5 * math.cos(2.0 * math.pi * t)
    turns = {
        "LeftArm": (-60 * s, 30 * s, 0),
        "RightArm": (-60 * s, -30 * s, 0),
        "LeftForeArm": (-100 * s, 0, 0),
        "RightForeArm": (-100 * s, 0, 0),
        "LeftHand": (0, 0, 60 * s),
        "RightHand": (0, 0, -60 * s),
        "LeftUpLeg": (-50 * s, 0, 0),
        "LeftLeg": (80 * s, 0, 0),
        "Spine": (20 * s, 0, 0),
    }
    return turns, (0.0, 0.0, 0.0)


def action(armature, name, motion):
    armature.animation_data_create()
    armature.animation_data.action = bpy.data.actions.new(name)
    for bone in armature.pose.bones:
        bone.rotation_mode = "QUATERNION"
        bone.rotation_quaternion = Quaternion()
        bone.location = (0, 0, 0)
    for frame in range(0, FRAMES, 3):
        key(armature, frame, *motion(frame / (FRAMES - 1)))
    track = armature.animation_data.nla_tracks.new()
    track.name = name
    track.strips.new(name, 0, armature.animation_data.action)
    armature.animation_data.action = None


def main(source, target):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = FPS
    bpy.ops.import_scene.gltf(filepath=source, disable_bone_shape=True)
    armature = next(o for o in bpy.data.objects if o.type == "ARMATURE")
    thing = next(o for o in bpy.data.objects if o.type == "MESH")
    merge_twists(thing, armature)
    action(armature, "Walk", walk)
    action(armature, "Bend", bend)
    bpy.ops.export_scene.gltf(
        filepath=target, export_animation_mode="NLA_TRACKS", export_force_sampling=True, export_def_bones=False
    )


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
