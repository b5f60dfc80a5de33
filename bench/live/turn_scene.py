# SPDX-License-Identifier: MIT
"""For Blender: a scene with a material, in the viewport's shading that BLENDER_SHADING names (SOLID, MATERIAL or
WIREFRAME), whose animation plays on and on."""
import math
import os

import bpy

bpy.ops.object.select_all(action="SELECT")
bpy.ops.mesh.primitive_monkey_add(size=2, location=(0, 0, 1))
monkey = bpy.context.object
bpy.ops.object.shade_smooth()
monkey.modifiers.new("finer", "SUBSURF").levels = 2
material = bpy.data.materials.new("painted")
material.use_nodes = True
material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.8, 0.3, 0.1, 1)
monkey.data.materials.append(material)
for frame, angle in ((1, 0.0), (240, 2 * math.pi)):
    monkey.rotation_euler = (0, 0, angle)
    monkey.keyframe_insert("rotation_euler", frame=frame)


def start():
    window = bpy.context.window_manager.windows[0]
    for area in window.screen.areas:
        if area.type == "VIEW_3D":
            area.spaces[0].shading.type = os.environ.get("BLENDER_SHADING", "SOLID")
    with bpy.context.temp_override(window=window):
        bpy.ops.screen.animation_play()


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(start, first_interval=1.0)
