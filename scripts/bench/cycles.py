"""
Draws a GLB by Blender's Cycles, lit as libcore/render/light/light_rig.h has it: a warm key light with an extent from
the camera's upper left, a weak one from behind, a sky over a warm ground, and a plane that catches shadow.

    blender -b --factory-startup -P cycles.py -- IN.glb OUT.exr WIDTH HEIGHT SAMPLES SEED EYE TARGET FOV GROUND THREADS

EYE and TARGET are X,Y,Z in the file's coordinates, y up; GROUND is the plane's height; FOV in degrees, vertical.
"""
import math
import sys

import bpy
import numpy
from mathutils import Matrix, Vector

numpy.bool = bool  # the importer of Blender 3.4 asks for it, NumPy 1.24 has it no more

KEY, RIM = ((3.3, 3, 2.58), (-0.55, 0.8, 0.7)), ((0.62, 0.7, 0.8), (0.75, 0.35, -0.55))
SKY, GROUND_COLOR, KEY_EXTENT = (0.4, 0.47, 0.56), (0.23, 0.2, 0.17), 0.07


def turned(p):
    """From y up to Blender's z up."""
    return Vector((p[0], -p[2], p[1]))


def vector(text):
    return turned([float(x) for x in text.split(",")])


def add_camera(eye, target, fov):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle = "VERTICAL", math.radians(fov)
    thing = bpy.data.objects.new("camera", camera)
    back = (eye - target).normalized()
    right = turned((0, 1, 0)).cross(back).normalized()
    up = back.cross(right)
    thing.matrix_world = Matrix((right, up, back)).transposed().to_4x4()
    thing.matrix_world.translation = eye
    bpy.context.collection.objects.link(thing)
    bpy.context.scene.camera = thing
    return right, up, back


def add_sun(name, light, axes, angle, shadow):
    color, place = light
    toward = sum((axis * share for axis, share in zip(axes, place)), Vector())
    sun = bpy.data.lights.new(name, "SUN")
    sun.energy, sun.angle = max(color), angle
    sun.color = [c / max(color) for c in color]
    sun.cycles.cast_shadow = shadow
    thing = bpy.data.objects.new(name, sun)
    thing.rotation_mode = "QUATERNION"
    thing.rotation_quaternion = toward.to_track_quat("Z", "Y")
    bpy.context.collection.objects.link(thing)


def make_sky():
    world = bpy.context.scene.world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    place, parts = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeSeparateXYZ")
    dome, mix = nodes.new("ShaderNodeMapRange"), nodes.new("ShaderNodeMixRGB")
    dome.interpolation_type = "SMOOTHSTEP"
    dome.inputs["From Min"].default_value, dome.inputs["From Max"].default_value = -0.625, 0.625
    mix.inputs["Color1"].default_value = (*GROUND_COLOR, 1)
    mix.inputs["Color2"].default_value = (*SKY, 1)
    links.new(place.outputs["Generated"], parts.inputs[0])
    links.new(parts.outputs["Z"], dome.inputs["Value"])
    links.new(dome.outputs["Result"], mix.inputs["Fac"])
    links.new(mix.outputs["Color"], nodes["Background"].inputs["Color"])


def add_ground(height):
    bpy.ops.mesh.primitive_plane_add(size=100, location=(0, 0, height))
    bpy.context.object.is_shadow_catcher = True


def main():
    source, out, width, height, samples, seed, eye, target, fov, ground, threads = sys.argv[sys.argv.index("--") + 1:]
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    bpy.ops.import_scene.gltf(filepath=source)
    axes = add_camera(vector(eye), vector(target), float(fov))
    add_sun("key", KEY, axes, 2 * math.atan(KEY_EXTENT), True)
    add_sun("rim", RIM, axes, 0, False)
    make_sky()
    add_ground(float(ground))
    scene = bpy.context.scene
    scene.render.engine, scene.render.film_transparent = "CYCLES", True
    scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
    scene.render.resolution_percentage = 100
    scene.render.threads_mode, scene.render.threads = "FIXED", int(threads)
    scene.cycles.samples, scene.cycles.seed = int(samples), int(seed)
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = out
    bpy.ops.render.render(write_still=True)


main()
