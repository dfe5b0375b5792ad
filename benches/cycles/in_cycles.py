"""Renders a scene of `trove build` in Blender's Cycles: `in_cycles.py JOB.json`.

The job names the .glb, the sky, the view, the threads, and the pictures to take; each becomes NAME.exr in the job's
folder, and times.json there says how long everything took. With "unbiased" indirect light is not clamped.
"""

import json
import math
import struct
import sys
import time
from pathlib import Path

import bpy
import OpenEXR

THIN_PANE_FACES = 2  # a pane reflects at both of its faces
TINT = "tint"


def glb_json(data):
    """The JSON chunk of a .glb and where the rest begins."""
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), 20 + length


def with_unique_names(glb, path):
    """Copies a .glb with materials and images named by their numbers, and returns its JSON as it was."""
    data = Path(glb).read_bytes()
    root, rest = glb_json(data)
    renamed = json.loads(json.dumps(root))
    for kind in ("materials", "images"):
        for i, row in enumerate(renamed.get(kind, [])):
            row["name"] = f"{kind} {i}"
    text = json.dumps(renamed).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(data) - rest, len(text), 0x4E4F534A)
    Path(path).write_bytes(head + text + data[rest:])
    return root


class Surface:
    """A material's nodes, written anew: Blender's glTF importer knows no thin panes and no translucent leaves."""

    def __init__(self, material, row, root):
        self.nodes, self.links = material.node_tree.nodes, material.node_tree.links
        self.row, self.root = row, root
        self.images = {node.image.name: node.image for node in self.nodes if node.type == "TEX_IMAGE" and node.image}
        self.nodes.clear()
        self.extensions = row.get("extensions", {})

    def node(self, kind, **inputs):
        """A node with its inputs set to values or linked to outputs; `_0` stands for the first input and so on."""
        made = self.nodes.new(kind)
        for name, value in inputs.items():
            key = int(name[1:]) if name.startswith("_") else name.replace("_", " ")
            if isinstance(value, bpy.types.NodeSocket):
                self.links.new(value, made.inputs[key])
            else:
                made.inputs[key].default_value = value
        return made

    def math(self, operation, a, b):
        made = self.node("ShaderNodeMath", _0=a, _1=b)
        made.operation = operation
        return made.outputs[0]

    def scaled(self, color, factor):
        """A colour (value or output) times a colour or a number."""
        made = self.nodes.new("ShaderNodeVectorMath")
        made.operation = "MULTIPLY"
        for i, value in enumerate((color, factor)):
            if isinstance(value, bpy.types.NodeSocket):
                self.links.new(value, made.inputs[i])
            else:
                made.inputs[i].default_value = value[:3] if isinstance(value, (list, tuple)) else [value] * 3
        return made.outputs[0]

    def texture(self, info, is_color):
        """The node of a texture; the importer turned v round, so that only its scale is left to do."""
        if info is None:
            return None
        index = self.root["textures"][info["index"]]["source"]
        image = self.images[f"images {index}"]
        made = self.nodes.new("ShaderNodeTexImage")
        made.image = image
        image.colorspace_settings.name = "sRGB" if is_color else "Non-Color"
        image.alpha_mode = "CHANNEL_PACKED"
        scale = info.get("extensions", {}).get("KHR_texture_transform", {}).get("scale", [1.0, 1.0])
        uv = self.nodes.new("ShaderNodeTexCoord").outputs["UV"]
        self.links.new(self.scaled(uv, [*scale, 1.0]), made.inputs["Vector"])
        return made

    def fresnel(self, f0, normal):
        """Schlick's reflectance, which is the same from both sides."""
        geometry = self.node("ShaderNodeNewGeometry")
        dot = self.nodes.new("ShaderNodeVectorMath")
        dot.operation = "DOT_PRODUCT"
        self.links.new(normal or geometry.outputs["Normal"], dot.inputs[0])
        self.links.new(geometry.outputs["Incoming"], dot.inputs[1])
        away = self.math("SUBTRACT", 1.0, self.math("ABSOLUTE", dot.outputs["Value"], 0.0))
        return self.math("ADD", f0, self.math("MULTIPLY", 1.0 - f0, self.math("POWER", away, 5.0)))

    def build(self):
        pbr = self.row.get("pbrMetallicRoughness", {})
        factor = pbr.get("baseColorFactor", [1.0] * 4)[:3]
        base = self.texture(pbr.get("baseColorTexture"), True)
        orm = self.texture(pbr.get("metallicRoughnessTexture"), False)
        bumps = self.texture(self.row.get("normalTexture"), False)
        transmission = self.extensions.get("KHR_materials_transmission", {}).get("transmissionFactor", 0.0)
        passing = self.extensions.get("KHR_materials_diffuse_transmission", {}).get("diffuseTransmissionFactor", 0.0)
        ior = self.extensions.get("KHR_materials_ior", {}).get("ior", 1.5)
        sheen = self.extensions.get("KHR_materials_sheen", {})
        sheen_color = sheen.get("sheenColorFactor", [0.0] * 3)
        coat = self.extensions.get("KHR_materials_clearcoat", {})
        strength = self.extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
        f0 = ((ior - 1.0) / (ior + 1.0)) ** 2
        f0 += transmission * (THIN_PANE_FACES * f0 / (1.0 + f0) - f0)

        color = self.scaled(base.outputs["Color"] if base else [1.0] * 3, factor)
        tint = self.nodes.new("ShaderNodeAttribute")
        tint.attribute_name = TINT
        color = self.scaled(color, tint.outputs["Color"])
        roughness, metalness = pbr.get("roughnessFactor", 1.0), pbr.get("metallicFactor", 1.0)
        if orm:
            channels = self.node("ShaderNodeSeparateColor", _0=orm.outputs["Color"]).outputs
            roughness = self.math("MULTIPLY", channels["Green"], roughness)
            metalness = self.math("MULTIPLY", channels["Blue"], metalness)
        inputs = {
            "Base_Color": self.scaled(color, (1.0 - passing) * (1.0 - transmission)),
            "Roughness": roughness,
            "Metallic": metalness,
            "IOR": (1.0 + math.sqrt(f0)) / (1.0 - math.sqrt(f0)),
            "Coat_Weight": coat.get("clearcoatFactor", 0.0),
            "Coat_Roughness": coat.get("clearcoatRoughnessFactor", 0.0),
            "Sheen_Weight": max(sheen_color),
            "Sheen_Roughness": sheen.get("sheenRoughnessFactor", 0.0),
            "Sheen_Tint": [*(c / max(*sheen_color, 1e-6) for c in sheen_color), 1.0],
            "Emission_Color": [*self.row.get("emissiveFactor", [0.0] * 3), 1.0],
            "Emission_Strength": strength,
        }
        normal = None
        if bumps:
            normal = self.node("ShaderNodeNormalMap", Color=bumps.outputs["Color"]).outputs["Normal"]
            inputs["Normal"] = normal
        principled = self.node("ShaderNodeBsdfPrincipled", **inputs)
        principled.distribution = "MULTI_GGX"
        shader = principled.outputs[0]
        if passing > 0.0:
            through = self.node("ShaderNodeBsdfTranslucent", Color=self.scaled(color, passing * (1.0 - f0)))
            if normal:
                self.links.new(normal, through.inputs["Normal"])
            shader = self.node("ShaderNodeAddShader", _0=shader, _1=through.outputs[0]).outputs[0]
        if transmission > 0.0:
            kept = self.math("SUBTRACT", 1.0, self.fresnel(f0, normal))
            tint = [c * transmission for c in factor]
            combined = self.node("ShaderNodeCombineColor", _0=kept, _1=kept, _2=kept).outputs[0]
            through = self.node("ShaderNodeBsdfTransparent", Color=self.scaled(combined, tint))
            shader = self.node("ShaderNodeAddShader", _0=shader, _1=through.outputs[0]).outputs[0]
        if self.row.get("alphaMode") == "MASK" and base:
            there = self.math("GREATER_THAN", base.outputs["Alpha"], self.row.get("alphaCutoff", 0.5))
            hole = self.node("ShaderNodeBsdfTransparent").outputs[0]
            shader = self.node("ShaderNodeMixShader", Fac=there, _1=hole, _2=shader).outputs[0]
        self.node("ShaderNodeOutputMaterial", Surface=shader)


def import_scene(job):
    """The scene with its materials; returns the file's JSON."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    copy = Path(job["folder"]) / "named.glb"
    root = with_unique_names(job["glb"], copy)
    bpy.ops.import_scene.gltf(filepath=str(copy), import_shading="NORMALS", merge_vertices=False)
    copy.unlink()
    for mesh in bpy.data.meshes:
        tint_vertices(mesh)
    for i, row in enumerate(root["materials"]):
        material = bpy.data.materials.get(f"materials {i}")
        if material is not None:  # a material that no triangle has is not imported
            Surface(material, row, root).build()
    return root


def tint_vertices(mesh):
    """Gives a mesh the attribute that base colours are multiplied by: the file's colours of vertices, or white."""
    if mesh.color_attributes:
        mesh.color_attributes[0].name = TINT
    else:
        white = mesh.color_attributes.new(TINT, "FLOAT_COLOR", "POINT")
        white.data.foreach_set("color", [1.0] * 4 * len(white.data))


def place_camera(job, root):
    """The camera of the view, with its principal point, blind for the vehicle that carries it."""
    row = next(node for node in root["nodes"] if node.get("name") == job["view"] and "camera" in node)["extras"]
    scene, camera = bpy.context.scene, bpy.data.objects[job["view"]]
    width, height = row["width_px"], row["height_px"]
    assert abs(row["fx_px"] / row["fy_px"] - 1.0) < 0.01, "expected square pixels"
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    lens = camera.data
    lens.sensor_fit, lens.sensor_width, lens.lens = "HORIZONTAL", 36.0, 36.0 * row["fx_px"] / width
    lens.shift_x = -(row["cx_px"] - width / 2) / width
    lens.shift_y = (row["cy_px"] - height / 2) / width
    lens.clip_start, lens.clip_end = 0.01, 1e5
    for thing in bpy.data.objects:
        if row["carrier"] and thing.get("id") == row["carrier"]:
            thing.visible_camera = False


def light(job, root):
    """Sky and sun."""
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    texture = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(job["environment"])
    texture.image.colorspace_settings.name = "Linear Rec.709"
    world.node_tree.links.new(texture.outputs["Color"], world.node_tree.nodes["Background"].inputs["Color"])
    for row in root["nodes"]:
        if "KHR_lights_punctual" in row.get("extensions", {}):
            lamp = root["extensions"]["KHR_lights_punctual"]["lights"][0]
            sun = bpy.data.objects[row["name"]].data
            sun.color, sun.energy = lamp["color"], lamp["intensity"] / 683.0
            sun.angle = 2.0 * row["extras"]["radius_rad"]


def set_up(job):
    """Cycles as the original toolkit has it: CPU, three bounces (the job may say another number); the rest is Blender's
    default."""
    render, cycles = bpy.context.scene.render, bpy.context.scene.cycles
    render.engine, cycles.device = "CYCLES", "CPU"
    render.threads_mode, render.threads = "FIXED", job["threads"]
    render.use_persistent_data = True
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.use_compositing = render.use_sequencer = False
    bounces = job.get("bounces", 3)
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = bounces
    if job.get("unbiased"):
        cycles.sample_clamp_indirect = 0.0
    cycles.transparent_max_bounces = 16
    cycles.adaptive_threshold = 0.01
    cycles.denoiser = "OPENIMAGEDENOISE"
    cycles.denoising_input_passes, cycles.denoising_prefilter = "RGB_ALBEDO_NORMAL", "ACCURATE"


def take(job, picture):
    """Renders one picture; seconds in all, and of sampling and denoising alone as Cycles itself counts them."""
    cycles, render = bpy.context.scene.cycles, bpy.context.scene.render
    cycles.samples, cycles.seed = picture["spp"], picture.get("seed", 0)
    cycles.use_adaptive_sampling, cycles.use_denoising = picture["adaptive"], picture["denoise"]
    path = Path(job["folder"]) / f"{picture['name']}.exr"
    render.filepath = str(path)
    started = time.monotonic()
    bpy.ops.render.render(write_still=True)
    total_s = time.monotonic() - started
    with OpenEXR.File(str(path)) as file:
        (stamp,) = (value for key, value in file.header().items() if key.endswith(".render_time"))
    render_s = 0.0
    for part in stamp.split(":"):  # hours, if any, minutes, seconds with hundredths
        render_s = 60.0 * render_s + float(part)
    return {"total_s": total_s, "render_s": render_s}


def main():
    job = json.loads(Path(sys.argv[1]).read_text())
    started = time.monotonic()
    root = import_scene(job)
    place_camera(job, root)
    light(job, root)
    set_up(job)
    times = {"import_s": time.monotonic() - started, "pictures": {}}
    for picture in job["pictures"]:
        times["pictures"][picture["name"]] = take(job, picture)
        (Path(job["folder"]) / "times.json").write_text(json.dumps(times))


if __name__ == "__main__":
    main()
