"""The room of the tutorial, made by Blender: `blender --background --python room.py`, or `pip install bpy` and `python room.py`.

Writes room.blend to look at, and room.glb, exported as the tutorial says.
"""

from math import pi

import bpy
from mathutils import Vector

SRGB = {"wall": "d8d4cc", "ceiling": "e8e6e1", "floor": "8a6a4a", "sofa": "3f6f78", "table": "5a3d28", "shade": "f0e6d2", "rug": "a34a3a"}


def material(name, colour, emission=0.0):
    """A diffuse material; `emission` is a luminance in cd/m²."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    surface = made.node_tree.nodes["Principled BSDF"]
    code = [int(SRGB.get(colour, colour)[k : k + 2], 16) / 255 for k in (0, 2, 4)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in code]
    surface.inputs["Base Color"].default_value = (*linear, 1.0)
    surface.inputs["Roughness"].default_value = 1.0
    surface.inputs["Specular IOR Level"].default_value = 0.0
    if emission:
        surface.inputs["Emission Color"].default_value = (*linear, 1.0)
        surface.inputs["Emission Strength"].default_value = emission
    return made


def mesh(name, vertices, faces, look):
    """An object of polygons; fronts are where vertices go round counter-clockwise."""
    data = bpy.data.meshes.new(name)
    data.from_pydata(vertices, [], faces)
    data.materials.append(look)
    made = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(made)
    return made


def box(name, low, high, look, bevel=0.0):
    corners = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    made = mesh(name, corners, faces, look)
    if bevel:
        rounded = made.modifiers.new("Bevel", "BEVEL")
        rounded.width, rounded.segments = bevel, 3
        for polygon in made.data.polygons:
            polygon.use_smooth = True
    return made


def join(name, parts):
    """One object of several."""
    bpy.ops.object.select_all(action="DESELECT")
    for part in parts:
        bpy.context.view_layer.objects.active = part
        part.select_set(True)
        for modifier in list(part.modifiers):
            bpy.ops.object.modifier_apply(modifier=modifier.name)
    bpy.ops.object.join()
    bpy.context.object.name = name
    return bpy.context.object


bpy.ops.wm.read_factory_settings(use_empty=True)
wall, floor = material("Wall", "wall"), material("Floor", "floor")
wide, deep, high = 5.0, 4.0, 2.7

# The room, seen from inside; the south wall has a window from 0.9 to 2.2 m above the floor.
mesh("Floor", [(0, 0, 0), (wide, 0, 0), (wide, deep, 0), (0, deep, 0)], [(0, 1, 2, 3)], floor)
mesh("Ceiling", [(0, 0, high), (0, deep, high), (wide, deep, high), (wide, 0, high)], [(0, 1, 2, 3)], material("Ceiling", "ceiling"))
mesh("Wall west", [(0, 0, 0), (0, deep, 0), (0, deep, high), (0, 0, high)], [(0, 1, 2, 3)], wall)
mesh("Wall east", [(wide, 0, 0), (wide, 0, high), (wide, deep, high), (wide, deep, 0)], [(0, 1, 2, 3)], wall)
mesh("Wall north", [(0, deep, 0), (wide, deep, 0), (wide, deep, high), (0, deep, high)], [(0, 1, 2, 3)], wall)
ring = [(0, 0), (wide, 0), (wide, high), (0, high), (1.2, 0.9), (3.8, 0.9), (3.8, 2.2), (1.2, 2.2)]
mesh("Wall south", [(x, 0, z) for x, z in ring], [(0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)], wall)
sill = [(x, y, z) for y in (0, -0.25) for x, z in ring[4:]]
mesh("Window frame", sill, [(0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)], wall)
sky = [(x, -0.25, z) for x, z in ring[4:]]
mesh("Window", sky, [(0, 3, 2, 1)], material("Sky", "c8d4ec", emission=2500.0))

sofa = material("Sofa", "sofa")
seat = [box("seat", (1.3, 2.9, 0.08), (3.5, 3.7, 0.42), sofa, 0.05), box("back", (1.3, 3.55, 0.3), (3.5, 3.85, 0.85), sofa, 0.06)]
arms = [box("arm", (x, 2.9, 0.05), (x + 0.22, 3.85, 0.62), sofa, 0.05) for x in (1.1, 3.48)]
join("Sofa", seat + arms)
table = material("Table", "table")
legs = [box("leg", (x, y, 0), (x + 0.05, y + 0.05, 0.4), table) for x in (1.75, 3.0) for y in (1.55, 2.1)]
join("Table", [box("top", (1.7, 1.5, 0.4), (3.1, 2.2, 0.44), table), *legs])
box("Rug", (1.2, 1.1, 0.0), (3.7, 2.75, 0.012), material("Rug", "rug"))

# Two lamps: a pendant over the table, and one that stands beside the sofa. What shines is a sphere.
for name, at in {"Pendant": (2.4, 1.85, 1.75), "Floor lamp": (4.3, 3.4, 1.45)}.items():
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=0.12, location=at)
    bpy.context.object.name = name
    bpy.context.object.data.materials.append(material(name, "e0b070", emission=6000.0))
    bpy.ops.object.shade_smooth()
    foot = high if name == "Pendant" else 0.0
    bpy.ops.mesh.primitive_cylinder_add(vertices=12, radius=0.012, depth=abs(at[2] - foot) - 0.12, location=(at[0], at[1], (at[2] + foot) / 2 + (0.06 if foot else -0.06)))
    bpy.context.object.name = f"{name} rod"
    bpy.context.object.data.materials.append(table)

eye, target = Vector((0.35, 0.3, 1.5)), Vector((3.1, 2.9, 0.85))
camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
camera.location, camera.data.angle = eye, 75 * pi / 180
camera.rotation_euler = (target - eye).to_track_quat("-Z", "Y").to_euler()
bpy.context.collection.objects.link(camera)
bpy.context.scene.camera = camera

bpy.ops.wm.save_as_mainfile(filepath="room.blend")
bpy.ops.export_scene.gltf(filepath="room.glb", export_apply=True, export_cameras=True, export_lights=True)
