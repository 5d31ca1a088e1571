"""Renders a light map in Blender, to look at it: no light but the map's own.

    blender --background --factory-startup --python bench/render_light_map.py -- out/room/lightmap.glb picture.png EYE LOOK_AT FOV [WIDTHxHEIGHT]

EYE and LOOK_AT as X,Y,Z [m] with z up (of scenes whose y is up: X,-Z,Y), FOV along the longer side [degrees].
"""

import math
import sys

import numpy

numpy.bool = bool  # Blender 3.4 reads glTF by a name that NumPy has dropped

import bpy
from mathutils import Vector

glb, picture, eye, look_at, fov, *size = sys.argv[sys.argv.index("--") + 1:]
eye, look_at = (Vector(float(number) for number in text.split(",")) for text in (eye, look_at))

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=glb)
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
bpy.context.scene.collection.objects.link(camera)
camera.location = eye
camera.rotation_euler = (look_at - eye).to_track_quat("-Z", "Y").to_euler()
camera.data.angle, camera.data.clip_start = math.radians(float(fov)), 0.01

scene = bpy.context.scene
scene.camera = camera
scene.render.engine, scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", "CPU", 16, False
scene.view_settings.view_transform = "Standard"
scene.render.resolution_x, scene.render.resolution_y = (int(number) for number in (size or ["800x600"])[0].split("x"))
scene.render.filepath = picture
bpy.ops.render.render(write_still=True)
