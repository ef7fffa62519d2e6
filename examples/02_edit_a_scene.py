"""What does a darker floor cost? Materials and emitters are edited by name."""

import isolux

scene = isolux.load("cornell-box")
before = isolux.solve(scene, elements=3000, rays=2e6)

floor = scene.add_material("dark floor", reflectivity=0.1)
scene.objects["floor"].material = floor
scene.materials["light"].emission = tuple(1.5 * channel for channel in scene.materials["light"].emission)
after = isolux.solve(scene, elements=3000, rays=2e6)

print(f"ceiling before {before.objects['ceiling'].mean} lx")
print(f"ceiling after  {after.objects['ceiling'].mean} lx")
