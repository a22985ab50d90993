# What Blender makes of meshes, without a window: a line each with triangles, curves and bounds in the file's axes.
#
#     blender -b --factory-startup -P scripts/read_in_blender.py -- FILE...
import sys

import bpy
import numpy

numpy.bool = bool   # Debian's importer of glTF asks for it, and Debian's numpy no longer has it

IMPORTERS = {
    'ply': lambda path: bpy.ops.import_mesh.ply(filepath=path),
    'stl': lambda path: bpy.ops.import_mesh.stl(filepath=path),
    'obj': lambda path: bpy.ops.wm.obj_import(filepath=path),
    'glb': lambda path: bpy.ops.import_scene.gltf(filepath=path),
    'usda': lambda path: bpy.ops.wm.usd_import(filepath=path),
}
TURNED = {'obj', 'glb', 'usda'}     # whose y, up, becomes Blender's z


def points_of(thing):
    if thing.type == 'MESH':
        return [v.co for v in thing.data.vertices]
    return [p.co.to_3d() for s in thing.data.splines for p in list(s.points) + list(s.bezier_points)]


for path in sys.argv[sys.argv.index('--') + 1:]:
    kind = path.rsplit('.', 1)[1]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if kind == 'usda' and not hasattr(bpy.types, 'WM_OT_usd_import'):
        print('read', path, 'cannot')
        continue
    IMPORTERS[kind](path)
    triangles = curves = 0
    low, high = [float('inf')] * 3, [float('-inf')] * 3
    for thing in bpy.context.scene.objects:
        if thing.type not in ('MESH', 'CURVE'):
            continue
        if thing.type == 'MESH':
            triangles += sum(p.loop_total - 2 for p in thing.data.polygons)
        else:
            curves += len(thing.data.splines)
        for p in points_of(thing):
            x, y, z = thing.matrix_world @ p
            at = (x, z, -y) if kind in TURNED else (x, y, z)
            low = [min(a, b) for a, b in zip(low, at)]
            high = [max(a, b) for a, b in zip(high, at)]
    print('read', path, triangles, curves, *('%.5f' % x for x in low + high))
